//! Intervals of doubles, rounded outwards: what is proved of a value when all that is known of its argument is a range.
//!
//! **Law.** If a lies in A and b in B, then a ∘ b lies in A ∘ B, computed over the real numbers or in doubles. An operation that has no
//! value for a part of its argument encloses the values of the rest; whoever asks has to look at the domain first. One that has no value
//! at all is *undefined*, and so is whatever is computed from it.
//!
//! Sums are rounded in the one direction that their error has (Knuth's two-sum); products and elementary functions are widened by more
//! than they can be off. Written here since no crate rounds elementary functions outwards on a plain target without a C library.

mod functions;
mod series;

pub(crate) use series::{ORDER, Series};

/// All numbers between two ends, which may be infinite; both ends are NaN where there is no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    low: f64,
    high: f64,
}

/// 2⁻⁵²: an operation in doubles is off by half of this relative to its result.
const EPSILON: f64 = f64::EPSILON;

/// Bound of the error of an operation that underflows.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// A double not below any number whose double is `x`, up to `roundings` of 2⁻⁵² each.
fn up(x: f64, roundings: f64) -> f64 {
    x + (x.abs() * (roundings * EPSILON) + UNDERFLOW)
}

fn down(x: f64, roundings: f64) -> f64 {
    x - (x.abs() * (roundings * EPSILON) + UNDERFLOW)
}

/// The sum with what its rounding lost (Knuth's two-sum): exact unless it overflows.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

pub(crate) fn sum_down(a: f64, b: f64) -> f64 {
    let (sum, lost) = two_sum(a, b);
    if lost < 0.0 { sum.next_down() } else { sum }
}

pub(crate) fn sum_up(a: f64, b: f64) -> f64 {
    let (sum, lost) = two_sum(a, b);
    if lost > 0.0 { sum.next_up() } else { sum }
}

/// Numbers on both sides of a product, or the product itself where it is exact (Veltkamp's splitting, Dekker's product).
fn product(a: f64, b: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0;
    /// Size of a product below which that of the lower halves may underflow.
    const EXACT_FROM: f64 = 1e-200;
    let split = |x: f64| {
        let scaled = SPLITTER * x;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let result = a * b;
    if a == 0.0 || b == 0.0 {
        return (result, result);
    }
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let lost = ((a_high * b_high - result) + a_high * b_low + a_low * b_high) + a_low * b_low;
    if !lost.is_finite() || result.abs() < EXACT_FROM {
        return (down(result, 1.0), up(result, 1.0));
    }
    (if lost < 0.0 { result.next_down() } else { result }, if lost > 0.0 { result.next_up() } else { result })
}

impl Interval {
    pub(crate) const ZERO: Self = Self { low: 0.0, high: 0.0 };
    pub(crate) const ENTIRE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    pub(crate) const UNDEFINED: Self = Self { low: f64::NAN, high: f64::NAN };

    /// The numbers from `low` to `high`; undefined where these are none, or out of order.
    pub(crate) fn new(low: f64, high: f64) -> Self {
        if low <= high { Self { low, high } } else { Self::UNDEFINED }
    }

    pub(crate) fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// All numbers that are off from `mid` by no more than `radius`.
    pub(crate) fn ball(mid: f64, radius: f64) -> Self {
        Self::new(sum_down(mid, -radius), sum_up(mid, radius))
    }

    pub(crate) fn low(self) -> f64 {
        self.low
    }

    pub(crate) fn high(self) -> f64 {
        self.high
    }

    pub(crate) fn is_undefined(self) -> bool {
        self.low.is_nan()
    }

    pub(crate) fn is_finite(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    #[cfg(test)]
    pub(crate) fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// A number inside, about the middle; NaN for an interval that has none.
    pub(crate) fn mid(self) -> f64 {
        (0.5 * self.low + 0.5 * self.high).max(self.low).min(self.high)
    }

    /// Distance of [`mid`](Self::mid) from the farther end, rounded upwards.
    pub(crate) fn radius(self) -> f64 {
        let mid = self.mid();
        sum_up(mid, -self.low).max(sum_up(self.high, -mid))
    }

    /// The greatest size of a number inside.
    pub(crate) fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Intersection of two intervals; undefined where it is empty.
    pub(crate) fn meet(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }
}

impl std::ops::Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl std::ops::Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(sum_down(self.low, other.low), sum_up(self.high, other.high))
    }
}

impl std::ops::Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl std::ops::Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ends = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        // 0 · ∞, or undefined: in doubles there may be no value.
        if ends.iter().any(|end| end.0.is_nan() || end.1.is_nan()) {
            return Self::UNDEFINED;
        }
        let mut low = ends[0].0.min(ends[1].0).min(ends[2].0.min(ends[3].0));
        let mut high = ends[0].1.max(ends[1].1).max(ends[2].1.max(ends[3].1));
        // What the signs say stays true, so that a product of what is not negative is not negative.
        if self.low >= 0.0 && other.low >= 0.0 || self.high <= 0.0 && other.high <= 0.0 {
            low = low.max(0.0);
        }
        if self.low >= 0.0 && other.high <= 0.0 || self.high <= 0.0 && other.low >= 0.0 {
            high = high.min(0.0);
        }
        Self::new(low, high)
    }
}

impl std::ops::Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.low > 0.0 || other.high < 0.0 {
            let ends =
                [self.low / other.low, self.low / other.high, self.high / other.low, self.high / other.high];
            if ends.iter().any(|end| end.is_nan()) {
                return Self::UNDEFINED;
            }
            let low = down(ends.iter().copied().fold(f64::INFINITY, f64::min), 1.0);
            let high = up(ends.iter().copied().fold(f64::NEG_INFINITY, f64::max), 1.0);
            let same = (self.low >= 0.0 && other.low > 0.0) || (self.high <= 0.0 && other.high < 0.0);
            let opposite = (self.low >= 0.0 && other.high < 0.0) || (self.high <= 0.0 && other.low > 0.0);
            return Self::new(
                if same { low.max(0.0) } else { low },
                if opposite { high.min(0.0) } else { high },
            );
        }
        match (other.low < 0.0, other.high > 0.0) {
            // Towards zero from one side, the sign is known.
            (false, true) if self.low > 0.0 => {
                Self::new(down(self.low / other.high, 1.0).max(0.0), f64::INFINITY)
            }
            (false, true) if self.high < 0.0 => {
                Self::new(f64::NEG_INFINITY, up(self.high / other.high, 1.0).min(0.0))
            }
            (true, false) if self.low > 0.0 => {
                Self::new(f64::NEG_INFINITY, up(self.low / other.low, 1.0).min(0.0))
            }
            (true, false) if self.high < 0.0 => {
                Self::new(down(self.high / other.low, 1.0).max(0.0), f64::INFINITY)
            }
            // 0/0 among them, or zero everywhere: there may be no value.
            _ => Self::UNDEFINED,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn interval() -> impl Strategy<Value = Interval> {
        let number = prop_oneof![-3.0..3.0_f64, Just(0.0), -1e9..1e9_f64, -1e-9..1e-9_f64];
        (number, prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..1e6_f64])
            .prop_map(|(low, width)| Interval::new(low, low + width))
    }

    proptest! {
        #[test]
        fn every_result_of_numbers_inside_is_inside(a in interval(), b in interval(), t in 0.0..1.0_f64, u in 0.0..1.0_f64) {
            let inside = |i: Interval, t: f64| (i.low + t * (i.high - i.low)).clamp(i.low, i.high);
            for (x, y) in [(inside(a, t), inside(b, u)), (a.low, b.high), (a.high, b.low), (a.low, b.low)] {
                prop_assert!((a + b).contains(x + y));
                prop_assert!((a - b).contains(x - y));
                prop_assert!((a * b).contains(x * y));
                let quotient = a / b;
                prop_assert!(quotient.is_undefined() || quotient.contains(x / y) || y == 0.0);
            }
        }

        #[test]
        fn a_ball_around_the_middle_holds_the_interval(a in interval()) {
            let ball = Interval::ball(a.mid(), a.radius());
            prop_assert!(ball.low <= a.low && a.high <= ball.high);
            prop_assert!(a.contains(a.mid()) && a.radius() <= 0.75 * (a.high - a.low) + 1e-300);
        }
    }

    #[test]
    fn exact_sums_are_not_widened_and_rounded_ones_hold_both_neighbours() {
        let one = Interval::point(1.0);
        assert_eq!(one + one, Interval::point(2.0));
        assert_eq!(Interval::new(0.0, 1.0) - one, Interval::new(-1.0, 0.0));
        assert_eq!(Interval::new(0.5, 0.75) * Interval::point(6.0), Interval::new(3.0, 4.5));
        let tenth = Interval::point(0.1) * Interval::point(10.0);
        assert!(tenth.contains(1.0) && tenth.high > tenth.low);
        let third = one / Interval::point(3.0);
        assert!(third.low < third.high && (third * Interval::point(3.0)).contains(1.0));
        let sum = Interval::point(1.0) + Interval::point(1e-30);
        assert_eq!((sum.low, sum.high), (1.0, 1.0_f64.next_up()));
    }

    #[test]
    fn signs_survive_and_zero_has_no_reciprocal() {
        let unit = Interval::new(0.0, 1.0);
        assert_eq!((unit * unit).low, 0.0);
        assert_eq!((unit * -unit).high, 0.0);
        assert_eq!(Interval::point(1.0) / unit, Interval::new((1.0 / unit).low, f64::INFINITY));
        assert!((unit / unit).is_undefined() && (unit / Interval::new(-1.0, 1.0)).is_undefined());
        assert!((Interval::ZERO * Interval::ENTIRE).is_undefined());
        assert!((Interval::UNDEFINED + unit).is_undefined() && (Interval::UNDEFINED * unit).is_undefined());
    }

    impl std::ops::Div<Interval> for f64 {
        type Output = Interval;
        fn div(self, other: Interval) -> Interval {
            Interval::point(self) / other
        }
    }
}
