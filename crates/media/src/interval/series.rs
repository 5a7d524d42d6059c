//! Taylor series with coefficients that are known to lie in intervals: automatic differentiation that proves.
//!
//! A series stands for f(c + h t) = Σ_k f_k t^k, the variable in units of half a panel, so that no power of a width over- or
//! underflows. Evaluated for the single point c it holds the Taylor coefficients there; evaluated for all c of a panel, every coefficient holds
//! h^k f^(k)(s)/k! for each s of the panel, which is Lagrange's remainder (moore-1966). Both by the same recurrences in k; for a product
//! f g it is Leibniz' rule, for u = f(v) with a differential equation u' = F(u, v) v' its comparison of powers:
//!
//! | | |
//! |---|---|
//! | u = exp v | k u_k = Σ_{j=1..k} j v_j u_{k−j} |
//! | u = ln v | k v_0 u_k = k v_k − Σ_{j=1..k−1} j u_j v_{k−j} |
//! | u = v^a | k v_0 u_k = Σ_{j=1..k} (a j − (k − j)) v_j u_{k−j} |
//! | s = sin v, c = cos v | k s_k = Σ j v_j c_{k−j}, k c_k = −Σ j v_j s_{k−j} |
//! | q = f/g | g_0 q_k = f_k − Σ_{j=1..k} g_j q_{k−j} |
//!
//! The coefficient of order 0 is an interval with tight ends, since it decides on which side of a kink the panel lies. The others are a
//! middle and a radius: a product is then three multiplications, and its rounding is bounded once for a whole sum (below 2⁻⁵² of the sum of
//! the sizes for each of its at most 30 roundings).

use super::Interval;

/// The highest order: even, so that its power is nowhere negative in the remainder. About here the arithmetic per length is least for
/// errors of 1e-15: it grows as the square of the order, and panels as 10^(−15/order).
pub(crate) const ORDER: usize = 20;

/// 30 roundings of 2⁻⁵³ and some more.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// The radii are sums of at most 60 positive terms, each rounded.
const RADIUS: f64 = 1.0 + 128.0 * f64::EPSILON;

/// Sizes below this are radii only: far above the numbers whose products lose digits, far below any extinction.
const NOTHING: f64 = 1e-140;

/// A number known to a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball {
    mid: f64,
    radius: f64,
}

/// A series, or only the range of a function that is not smooth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series {
    value: Interval,
    /// Middle and radius of the coefficients; of order 0 those of `value`.
    mid: [f64; ORDER + 1],
    radius: [f64; ORDER + 1],
    /// Coefficients from here on vanish. 0 for a function that is not smooth, of which the value alone is known.
    length: usize,
}

/// A sum of products of balls, divided in the end.
#[derive(Default)]
struct Products {
    mid: f64,
    radius: f64,
    size: f64,
}

impl Products {
    #[inline]
    fn add(&mut self, a: Ball, b: Ball) {
        let product = a.mid * b.mid;
        self.mid += product;
        self.size += product.abs();
        self.radius += a.mid.abs() * b.radius + a.radius * (b.mid.abs() + b.radius);
    }

    fn add_one(&mut self, a: Ball) {
        self.mid += a.mid;
        self.size += a.mid.abs();
        self.radius += a.radius;
    }

    fn finish(self, divisor: f64) -> Ball {
        let mid = self.mid / divisor;
        let radius = (self.radius + ROUNDINGS * self.size) / divisor.abs() * RADIUS + NOTHING;
        // A middle of no size would make every further product slow, and none different.
        if mid.abs() < NOTHING { Ball { mid: 0.0, radius: radius + NOTHING } } else { Ball { mid, radius } }
    }

    /// Divided by what is known to a radius, and not to be zero: |(m + δ)/(M + Δ) − m/M| = |δ − (m/M) Δ|/|M + Δ|.
    fn finish_by(self, divisor: Ball) -> Ball {
        let Ball { mid, radius } = self.finish(divisor.mid);
        let shrink = divisor.mid.abs() / (divisor.mid.abs() - divisor.radius);
        Ball {
            mid,
            radius: (radius + (mid.abs() + radius) * divisor.radius / divisor.mid.abs()) * shrink * RADIUS,
        }
    }
}

impl Series {
    /// A constant.
    pub(crate) fn constant(value: Interval) -> Self {
        let mut series = Self { value, mid: [0.0; ORDER + 1], radius: [0.0; ORDER + 1], length: 1 };
        series.settle();
        series
    }

    /// c + h t for every c in `value`.
    pub(crate) fn variable(value: Interval, half: f64) -> Self {
        let mut series = Self::constant(value);
        if series.length == 1 && half != 0.0 {
            series.set(1, Ball { mid: half, radius: 0.0 });
            series.length = 2;
        }
        series
    }

    /// A function with this range that has no derivatives, or none that are known.
    pub(crate) fn rough(value: Interval) -> Self {
        Self { length: 0, ..Self::constant(value) }
    }

    /// Brings order 0 in line with the value, and gives up the rest where something is not finite.
    fn settle(&mut self) {
        (self.mid[0], self.radius[0]) = (self.value.mid(), self.value.radius());
        let known = (0..self.length).all(|k| self.mid[k].is_finite() && self.radius[k].is_finite());
        if !known {
            self.length = 0;
        }
    }

    fn set(&mut self, k: usize, ball: Ball) {
        (self.mid[k], self.radius[k]) = (ball.mid, ball.radius);
    }

    fn at(&self, k: usize) -> Ball {
        Ball { mid: self.mid[k], radius: self.radius[k] }
    }

    /// The range of the function.
    pub(crate) fn value(&self) -> Interval {
        self.value
    }

    /// True if the derivatives are known.
    pub(crate) fn is_smooth(&self) -> bool {
        self.length > 0
    }

    /// Orders up to the last that does not vanish, and one more: what an operation on it costs, or the root of it.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Middle and radius of a coefficient.
    pub(crate) fn coefficient(&self, k: usize) -> (f64, f64) {
        if k < self.length { (self.mid[k], self.radius[k]) } else { (0.0, 0.0) }
    }

    /// Value and slope at t, from the middles of the coefficients; not proved.
    fn at_middle(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for k in (0..self.length).rev() {
            slope = slope * t + value;
            value = value * t + self.mid[k];
        }
        (value, slope)
    }

    /// About where in the panel, −1 ≤ t ≤ 1, the function has the value `level`; not proved.
    pub(crate) fn crossing(&self, level: f64) -> Option<f64> {
        /// Newton's method doubles its digits with each step.
        const STEPS: usize = 8;
        let mut t = 0.0;
        for _ in 0..STEPS {
            let (value, slope) = self.at_middle(t);
            let step = (value - level) / slope;
            if !step.is_finite() {
                return None;
            }
            // From beyond the panel a series says little.
            t = (t - step).clamp(-1.5, 1.5);
            if step.abs() <= 1e-15 {
                break;
            }
        }
        (t.abs() <= 1.0).then_some(t)
    }

    /// A series of this value, its other coefficients one after another by `coefficient` from those before.
    fn recurrence(value: Interval, length: usize, coefficient: impl Fn(&Self, usize) -> Ball) -> Self {
        let mut series = Self::constant(value);
        if series.length > 0 {
            for k in 1..length {
                let ball = coefficient(&series, k);
                series.set(k, ball);
            }
            series.length = length;
            series.settle();
        }
        series
    }

    /// Σ_{j=1..k} `weight(j)` · `a`_j `b`_{k−j}
    fn weighted(a: &Self, b: &Self, k: usize, weight: impl Fn(usize) -> f64) -> Products {
        let mut sum = Products::default();
        for j in 1..=k.min(a.length.saturating_sub(1)) {
            let w = weight(j);
            sum.add(Ball { mid: w * a.mid[j], radius: w.abs() * a.radius[j] }, b.at(k - j));
        }
        sum
    }

    pub(crate) fn negate(&self) -> Self {
        let mut series = *self;
        series.value = -self.value;
        series.mid[..self.length].iter_mut().for_each(|mid| *mid = -*mid);
        series.settle();
        series
    }

    pub(crate) fn add(&self, other: &Self) -> Self {
        let value = self.value + other.value;
        if !(self.is_smooth() && other.is_smooth()) {
            return Self::rough(value);
        }
        Self::recurrence(value, self.length.max(other.length), |_, k| {
            let mut sum = Products::default();
            sum.add_one(self.at(k));
            sum.add_one(other.at(k));
            sum.finish(1.0)
        })
    }

    pub(crate) fn subtract(&self, other: &Self) -> Self {
        self.add(&other.negate())
    }

    pub(crate) fn multiply(&self, other: &Self) -> Self {
        self.product(other, self.value * other.value)
    }

    fn product(&self, other: &Self, value: Interval) -> Self {
        if !(self.is_smooth() && other.is_smooth()) {
            return Self::rough(value);
        }
        let length = (self.length + other.length - 1).min(ORDER + 1);
        Self::recurrence(value, length, |_, k| {
            let mut sum = Products::default();
            for j in k.saturating_sub(other.length - 1)..=k.min(self.length - 1) {
                sum.add(self.at(j), other.at(k - j));
            }
            sum.finish(1.0)
        })
    }

    pub(crate) fn divide(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        if !(self.is_smooth() && other.is_smooth() && other.value.is_finite() && value.is_finite()) {
            return Self::rough(value);
        }
        let length = if other.length == 1 { self.length } else { ORDER + 1 };
        let divisor = other.at(0);
        if divisor.mid.abs() <= divisor.radius {
            return Self::rough(value);
        }
        Self::recurrence(value, length, |quotient, k| {
            let mut sum = Self::weighted(other, quotient, k, |_| -1.0);
            sum.add_one(self.at(k));
            sum.finish_by(divisor)
        })
    }

    /// A function whose coefficients all follow from those of `self`, or only its value where that is all that is known.
    fn composed(&self, value: Interval, coefficient: impl Fn(&Self, usize) -> Ball) -> Self {
        match self.length {
            0 => Self::rough(value),
            1 => Self::constant(value),
            _ => Self::recurrence(value, ORDER + 1, coefficient),
        }
    }

    pub(crate) fn exp(&self) -> Self {
        self.composed(self.value.exp(), |exp, k| Self::weighted(self, exp, k, |j| j as f64).finish(k as f64))
    }

    pub(crate) fn ln(&self) -> Self {
        let value = self.value.ln();
        let divisor = self.at(0);
        if !(self.value.low() > 0.0 && divisor.mid > divisor.radius) {
            return Self::rough(value);
        }
        self.composed(value, |ln, k| {
            // Σ_{j=1..k−1} j u_j v_{k−j}, by the index of v: its coefficients end early.
            let mut sum = Products::default();
            for i in 1..k.min(self.length) {
                let j = k - i;
                let weighted = Ball { mid: -(j as f64) * ln.mid[j], radius: j as f64 * ln.radius[j] };
                sum.add(weighted, self.at(i));
            }
            sum.add_one(Ball { mid: k as f64 * self.mid[k], radius: k as f64 * self.radius[k] });
            let Ball { mid, radius } = sum.finish_by(divisor);
            let mut quotient = Products::default();
            quotient.add_one(Ball { mid, radius });
            quotient.finish(k as f64)
        })
    }

    /// Both at once, since each needs the other.
    pub(crate) fn sin_cos(&self) -> (Self, Self) {
        let (mut sin, mut cos) = match self.length {
            0 => return (Self::rough(self.value.sin()), Self::rough(self.value.cos())),
            _ => (Self::constant(self.value.sin()), Self::constant(self.value.cos())),
        };
        if self.length > 1 && sin.is_smooth() && cos.is_smooth() {
            for k in 1..=ORDER {
                let next_sin = Self::weighted(self, &cos, k, |j| j as f64).finish(k as f64);
                let next_cos = Self::weighted(self, &sin, k, |j| -(j as f64)).finish(k as f64);
                sin.set(k, next_sin);
                cos.set(k, next_cos);
            }
            sin.length = ORDER + 1;
            cos.length = ORDER + 1;
            sin.settle();
            cos.settle();
        }
        (sin, cos)
    }

    pub(crate) fn tan(&self) -> Self {
        let value = self.value.tan();
        let (sin, cos) = self.sin_cos();
        let mut tan = sin.divide(&cos);
        tan.value = value;
        tan.settle();
        tan
    }

    /// The power with a fixed exponent.
    pub(crate) fn power(&self, exponent: f64) -> Self {
        let value = self.value.power(exponent);
        if !self.is_smooth() || !value.is_finite() || self.length == 1 {
            return if self.length == 1 { Self::constant(value) } else { Self::rough(value) };
        }
        /// Up to here repeated squares cost no more than the recurrence, and need not divide by what may be zero.
        const LARGEST_PRODUCT: f64 = 64.0;
        if exponent.fract() == 0.0 && (0.0..=LARGEST_PRODUCT).contains(&exponent) {
            return self.whole_power(exponent as u32, value);
        }
        let divisor = self.at(0);
        if divisor.mid.abs() <= divisor.radius || (exponent.fract() != 0.0 && self.value.low() <= 0.0) {
            return Self::rough(value);
        }
        self.composed(value, |power, k| {
            let weight = |j: usize| (exponent * j as f64 - (k - j) as f64) / k as f64;
            Self::weighted(self, power, k, weight).finish_by(divisor)
        })
    }

    fn whole_power(&self, exponent: u32, value: Interval) -> Self {
        let mut result = Self::constant(Interval::point(1.0));
        let (mut square, mut left) = (*self, exponent);
        let mut so_far = 1.0;
        while left > 0 {
            if left & 1 == 1 {
                result = result.multiply(&square);
            }
            left >>= 1;
            if left > 0 {
                so_far *= 2.0;
                square = square.product(&square, self.value.power(so_far));
            }
        }
        result.value = result.value.meet(value);
        result.settle();
        result
    }
}

#[cfg(test)]
#[path = "series_tests.rs"]
mod tests;
