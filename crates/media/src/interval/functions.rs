//! Elementary functions of intervals.
//!
//! The functions of the standard library are those of the platform, which promise less than one unit in the last place (glibc, macOS,
//! musl; two where it is Windows). [`WIDENING`] grants four. Where a function is monotone the values at both ends enclose it; the sine and the
//! cosine are looked at for their extrema, in intervals too.

use super::{Interval, down, up};

/// Units in the last place by which an elementary function may be off.
const WIDENING: f64 = 4.0;

/// Argument of a trigonometric function beyond which the phase is known too badly to tell a quarter of a turn.
const LARGEST_PHASE: f64 = 1e15;

/// π lies between these two doubles.
const PI: Interval = Interval { low: std::f64::consts::PI, high: 3.141_592_653_589_793_6 };

impl Interval {
    /// The values of a function that never falls, at both ends.
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(down(function(self.low), WIDENING), up(function(self.high), WIDENING))
    }

    pub(crate) fn exp(self) -> Self {
        self.rising(f64::exp).meet(Self::new(0.0, f64::INFINITY))
    }

    /// Logarithm of the numbers that are positive; undefined where none is.
    pub(crate) fn ln(self) -> Self {
        if self.high < 0.0 || self.is_undefined() {
            return Self::UNDEFINED;
        }
        // A logarithm near 0 is off by units of its own last place too: those of a number near 1 are known.
        Self { low: self.low.max(0.0), high: self.high }.rising(f64::ln)
    }

    /// Square root of the numbers that are not negative; undefined where all are.
    pub(crate) fn sqrt(self) -> Self {
        if self.high < 0.0 || self.is_undefined() {
            return Self::UNDEFINED;
        }
        let root = Self { low: self.low.max(0.0), high: self.high }.rising(f64::sqrt);
        Self::new(root.low.max(0.0), root.high)
    }

    pub(crate) fn sin(self) -> Self {
        self.wave(f64::sin, Self::ball(0.5, 0.0), Self::ball(1.5, 0.0))
    }

    pub(crate) fn cos(self) -> Self {
        self.wave(f64::cos, Self::ZERO, Self::ball(1.0, 0.0))
    }

    /// A sine or cosine with its greatest value at π · `crest` and its least at π · `trough`, modulo 2π.
    fn wave(self, function: impl Fn(f64) -> f64, crest: Self, trough: Self) -> Self {
        let whole = Self { low: -1.0, high: 1.0 };
        if self.is_undefined() {
            return self;
        }
        if self.magnitude() > LARGEST_PHASE {
            return whole;
        }
        let turns = Self::point(2.0) * PI;
        let passes = |at: Self| (self / turns - at * Self::point(0.5)).holds_an_integer();
        let (at_low, at_high) = (function(self.low), function(self.high));
        Self::new(
            if passes(trough) { -1.0 } else { down(at_low.min(at_high), WIDENING) },
            if passes(crest) { 1.0 } else { up(at_low.max(at_high), WIDENING) },
        )
        .meet(whole)
    }

    fn holds_an_integer(self) -> bool {
        self.low.ceil() <= self.high.floor()
    }

    /// Unbounded where a pole lies inside.
    pub(crate) fn tan(self) -> Self {
        if self.is_undefined() {
            return self;
        }
        if self.magnitude() > LARGEST_PHASE || (self / PI - Self::point(0.5)).holds_an_integer() {
            return Self::ENTIRE;
        }
        self.rising(f64::tan)
    }

    pub(crate) fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Self::new(0.0, self.magnitude())
        }
    }

    pub(crate) fn floor(self) -> Self {
        Self::new(self.low.floor(), self.high.floor())
    }

    pub(crate) fn ceil(self) -> Self {
        Self::new(self.low.ceil(), self.high.ceil())
    }

    pub(crate) fn min(self, other: Self) -> Self {
        if self.is_undefined() || other.is_undefined() {
            return Self::UNDEFINED;
        }
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    pub(crate) fn max(self, other: Self) -> Self {
        -(-self).min(-other)
    }

    /// The power with a fixed exponent: of all numbers for an integer, else of those that are not negative.
    pub(crate) fn power(self, exponent: f64) -> Self {
        if self.is_undefined() || !exponent.is_finite() {
            return Self::UNDEFINED;
        }
        if exponent == 0.0 {
            return Self::point(1.0);
        }
        if exponent < 0.0 {
            return Self::point(1.0) / self.power(-exponent);
        }
        if exponent == 1.0 {
            return self;
        }
        if exponent.fract() == 0.0 {
            if exponent % 2.0 != 0.0 {
                return self.rising(|x| x.powf(exponent)).with_sign_of(self);
            }
            return self.abs().rising(|x| x.powf(exponent)).with_sign_of(self.abs());
        }
        if self.high < 0.0 {
            return Self::UNDEFINED;
        }
        let base = Self { low: self.low.max(0.0), high: self.high };
        base.rising(|x| x.powf(exponent)).with_sign_of(base)
    }

    /// Rounding does not change the sign of a power.
    fn with_sign_of(self, base: Self) -> Self {
        let low = if base.low >= 0.0 { self.low.max(0.0) } else { self.low };
        let high = if base.high <= 0.0 { self.high.min(0.0) } else { self.high };
        Self::new(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every function, with the domain in which it has values.
    type Case = (&'static str, fn(Interval) -> Interval, fn(f64) -> f64);
    const CASES: [Case; 14] = [
        ("exp", Interval::exp, f64::exp),
        ("ln", Interval::ln, f64::ln),
        ("sqrt", Interval::sqrt, f64::sqrt),
        ("sin", Interval::sin, f64::sin),
        ("cos", Interval::cos, f64::cos),
        ("tan", Interval::tan, f64::tan),
        ("abs", Interval::abs, f64::abs),
        ("floor", Interval::floor, f64::floor),
        ("ceil", Interval::ceil, f64::ceil),
        ("^2", |x| x.power(2.0), |x| x.powf(2.0)),
        ("^3", |x| x.power(3.0), |x| x.powf(3.0)),
        ("^-2", |x| x.power(-2.0), |x| x.powf(-2.0)),
        ("^0.5", |x| x.power(0.5), |x| x.powf(0.5)),
        ("^-1.7", |x| x.power(-1.7), |x| x.powf(-1.7)),
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn every_value_inside_is_enclosed(
            low in prop_oneof![-20.0..20.0_f64, -1.0..1.0_f64, -1e6..1e6_f64, Just(0.0)],
            width in prop_oneof![Just(0.0), 0.0..1e-6_f64, 0.0..7.0_f64],
        ) {
            let x = Interval::new(low, low + width);
            for (name, enclose, function) in CASES {
                let found = enclose(x);
                for i in 0..=60 {
                    let value = function((low + width * f64::from(i) / 60.0).clamp(x.low, x.high));
                    // Undefined says nothing, and where there is no value none is enclosed.
                    prop_assert!(
                        found.is_undefined() || value.is_nan() || found.contains(value),
                        "{name} of {x:?} is {found:?}, not {value}"
                    );
                }
            }
        }

        #[test]
        fn enclosures_of_narrow_arguments_are_narrow(low in 0.1..1.4_f64) {
            let x = Interval::new(low, low + 1e-9);
            for (name, enclose, _) in CASES {
                let found = enclose(x);
                prop_assert!(found.radius() < 1e-6 * found.magnitude().max(1.0) || ["floor", "ceil"].contains(&name), "{name} {found:?}");
            }
        }
    }

    #[test]
    fn known_values() {
        use std::f64::consts::{FRAC_PI_2, PI};
        let tight = |found: Interval, exact: f64| {
            found.contains(exact) && found.radius() < 4e-15 * exact.abs().max(1.0)
        };
        assert!(tight(Interval::point(1.0).exp(), std::f64::consts::E));
        assert!(tight(Interval::point(2.0).ln(), std::f64::consts::LN_2));
        assert!(tight(Interval::point(2.0).sqrt(), std::f64::consts::SQRT_2));
        assert!(tight(Interval::point(1.0).tan(), 1.557_407_724_654_902_3));
        assert_eq!(Interval::new(0.0, PI).sin().high, 1.0);
        assert!(Interval::new(0.0, PI).sin().low.abs() < 1e-15);
        assert_eq!(Interval::new(3.0, 3.2).cos().low, -1.0);
        assert_eq!(Interval::new(0.0, 7.0).sin(), Interval::new(-1.0, 1.0));
        assert!(Interval::new(0.1, 1.4).sin().high < 0.99);
        assert_eq!(Interval::new(1e17, 1e17).sin(), Interval::new(-1.0, 1.0));
        assert_eq!(Interval::new(1.0, FRAC_PI_2 + 0.1).tan(), Interval::ENTIRE);
        assert_eq!(Interval::new(-1.0, 2.0).abs(), Interval::new(0.0, 2.0));
        assert_eq!(Interval::new(-1.5, 0.5).floor(), Interval::new(-2.0, 0.0));
        assert_eq!(Interval::new(-2.0, 1.0).power(2.0).low, 0.0);
        assert_eq!(Interval::new(0.0, 1.0).power(0.5).low, 0.0);
        assert!(
            Interval::new(-2.0, -1.0).ln().is_undefined() && Interval::new(-2.0, -1.0).sqrt().is_undefined()
        );
        assert_eq!(Interval::new(0.0, 1.0).ln().low, f64::NEG_INFINITY);
        assert!(Interval::new(-1.0, 1.0).power(-1.0).is_undefined());
        assert_eq!(Interval::new(-1e3, -900.0).exp().low, 0.0);
    }
}
