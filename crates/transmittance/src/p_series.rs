//! The power series of transmittance about a pivot, truncated at a random order.

use crate::next_flight::of_variance;
use crate::{ClosedForm, ProductLaw, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, ln, ln_1p};
use fairflight_media::{Extinction, Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Law of the order, and score of an order. X is S σ_t at a point uniform on the profile, Y = t_c − X.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PSeriesVersion {
    /// All orders up to the one at which the cumulative mass function of a Poisson law of mean t_c reaches 0.99, and one
    /// more; from there to order k with probability min(1, t_c/k). Few or no negative terms, steady cost.
    Cmf,
    /// To order k with probability min(1, |w|), w the term of that order relative to the first: no parameter, and terms
    /// that are never smaller than 1.
    Cumulative,
    /// K from a Poisson law of mean t_c, and nothing but the product of 1 − X/t_c over K points.
    Ratio,
    /// K from the same law, and every term up to it over the probability P(K ≥ k) that it is reached.
    NextFlight,
}

/// Single points of the profile, multiplied into the terms of an exponential series (georgiev-2019; bhanot-1985 for the
/// roulette).
///
/// With the pivot t_c, any number, T = exp(−t_c) exp(t_c − τ). (1) Y_1, Y_2, … are independent with E\[Y\] = t_c − τ =: y, so that
/// Y_1 … Y_k/k! has the expectation y^k/k!. (2) Term k is drawn with a probability P_k > 0 that does not depend on *its* points, and
/// divided by it:
///
/// > T̂ = exp(−t_c) Σ_{k ≤ K} Y_1 … Y_k / (k! P_k),   P_k = P(K ≥ k).
///
/// **Law.** Unbiased for every pivot and every such P_k, for σ_t of any sign: the pivot need be no bound. Where t_c < X terms have
/// either sign, and estimates may be negative. (3) `Cumulative` goes on to order k with a probability that its own points
/// decide. Given them, term k is kept with probability q and divided by q, for an expectation of the term itself: unbiased
/// by induction over k, but P_k are no numbers known beforehand. (4) `Ratio` is no sum: E over K of Π (1 − X/t_c) is
/// exp(−t_c E\[X\]/t_c). Its points are those of ratio tracking with the rate t_c/S, unsorted: the same law.
///
/// With t_c = 0 the first three P_k vanish (not for `Cumulative`): admitted for X = 0 only.
///
/// **Moments.** `Ratio`: all, by [`ProductLaw`]. `Cumulative`: a bound of the variance. For the others the second moment is usually written as a
/// double sum; here the variance, all of it positive terms. (5) Follow the expectation of the estimate given what is known.
/// With A_k = Y_1 … Y_k/k! and r_k = Σ_j y^j k!/(k + j)!, so that r_k = 1 + y/(k + 1) r_{k+1}, and all orders from k on are expected to
/// give A_k/P_k r_k once k is reached. (6) Whether k is reached from k − 1 is a coin of probability P_k/P_{k−1} that decides
/// about A_{k−1}/P_k (y/k) r_k; then Y_k, of variance v, decides about A_{k−1}/(k P_k) r_k. Squared, with E\[A_k²\] = q^k/k!² and q = y² + v,
///
/// > Var/T² = exp(−2y) Σ_{k ≥ 1} q^{k−1}/k!² r_k² (v + y² (1 − P_k/P_{k−1}))/P_k,   v = S ∫ (σ_t − τ/S)² ds.
///
/// It is finite always, as k! P_k falls no faster than a power. (7) For `Cumulative` only a bound: with w_k the weight of term k, of
/// magnitude at least 1 while it lives, the point k decides about w_{k−1} (Y_k − y)/k · r_k, and the coin, given a = w_{k−1} Y_k/k
/// and tossed for |a| < 1, about r_k times a variance of |a| − a², at most 1/4. As E|w_k| = E|a| = p^k/k!, p = E|Y|,
///
/// > Var/T² ≤ exp(−2y) Σ_{k ≥ 1} r_k² (m_{k−1} v/k² + c_k),   c_k = min(p^k/k!, min(1, p^{k−1}/(k−1)!)/4),   m_k = m_{k−1} q/k² + c_k, m_0 = 1.
///
/// **Cost.** Σ_{k ≥ 1} P_k look-ups; t_c, a Poisson number, for `Ratio` and `NextFlight`; for `Cumulative` it has no closed form.
///
/// **Orders** have no cap, and no term over- or underflows before the estimate does. **Digits** are another matter: with a pivot far below
/// τ the terms grow to exp(τ) and cancel, so that a sum has lost its digits for τ − t_c above some 36, in any arithmetic of 53 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PSeries {
    version: PSeriesVersion,
    pivot: f64,
    /// exp(−t_c), the term of order 0.
    first: SignedProduct,
    /// The last order that is drawn for sure (`Cmf`).
    sure: u32,
}

/// A pivot that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PivotError {
    /// A value below 0.
    #[error("pivot must be at least 0, found {0}")]
    Negative(f64),
    /// NaN or infinite.
    #[error("pivot must be finite, found {0}")]
    NotFinite(f64),
}

/// The cumulative mass up to which `Cmf` draws orders for sure.
const GOAL: f64 = 0.99;

impl PSeries {
    /// The estimator about the optical thickness `pivot` = t_c \[1\], the nearer to τ the better.
    ///
    /// # Errors
    /// If the pivot is negative or not finite.
    pub fn new(version: PSeriesVersion, pivot: f64) -> Result<Self, PivotError> {
        if !pivot.is_finite() {
            return Err(PivotError::NotFinite(pivot));
        }
        if pivot < 0.0 {
            return Err(PivotError::Negative(pivot));
        }
        let sure = if version == PSeriesVersion::Cmf { surely_drawn(pivot) } else { 0 };
        Ok(Self { version, pivot, first: SignedProduct::exp(-pivot), sure })
    }

    /// The estimator about the optical thickness of the majorant, as published: no term is negative.
    ///
    /// # Errors
    /// If the majorant is negative or not finite.
    pub fn with_majorant<F: Majorant>(version: PSeriesVersion, field: &F) -> Result<Self, PivotError> {
        Self::new(version, field.majorant() * field.length())
    }

    /// The version of the estimator.
    #[must_use]
    pub fn version(&self) -> PSeriesVersion {
        self.version
    }

    /// The pivot t_c.
    #[must_use]
    pub fn pivot(&self) -> f64 {
        self.pivot
    }
}

/// Number of orders that are drawn for sure: one more than the least k with P(N ≤ k) ≥ [`GOAL`], N of a Poisson law: the mass is
/// built up in the order of georgiev-2019's code, which draws one point more than the goal needs.
fn surely_drawn(mean: f64) -> u32 {
    let mut mass = SignedProduct::exp(-mean);
    let mut sum = 0.0;
    let mut k = 0;
    loop {
        sum += mass.value();
        k += 1;
        // Rounding may leave the sum of a very large mean below the goal: the mass is then past its mode and gone.
        if sum >= GOAL || (f64::from(k) > mean && mass.value() < 1e-18) {
            return k;
        }
        mass.multiply(mean / f64::from(k));
    }
}

/// Draws whether an event of this probability happens. One that is sure costs no variate.
#[inline]
fn happens(probability: f64, source: &mut impl UniformSource) -> bool {
    probability >= 1.0 || source.next_uniform() < probability
}

/// A number of the Poisson law of this mean: that of exponential steps that fit into it.
#[inline]
pub(crate) fn poisson(mean: f64, source: &mut impl UniformSource) -> u32 {
    let (mut count, mut sum) = (0, source.next_exponential());
    while sum < mean {
        count += 1;
        sum += source.next_exponential();
    }
    count
}

impl PSeries {
    /// X, the optical thickness that one point stands for.
    #[inline]
    fn point<F: Extinction>(field: &F, source: &mut impl UniformSource) -> f64 {
        let length = field.length();
        length * field.sigma_t(length * source.next_uniform())
    }

    fn cmf<F: Extinction>(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut term = self.first;
        let mut sum = term;
        for k in 1_u32.. {
            let mut scale = 1.0 / f64::from(k);
            if k > self.sure {
                let go_on = (self.pivot * scale).min(1.0);
                if !happens(go_on, source) {
                    break;
                }
                scale /= go_on;
            }
            term.multiply((self.pivot - Self::point(field, source)) * scale);
            sum.add(&term);
        }
        sum.value()
    }

    fn cumulative<F: Extinction>(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut term = self.first;
        let mut sum = term;
        for k in 1_u32.. {
            let point = Self::point(field, source);
            if !point.is_finite() {
                return f64::NAN; // its order would have no end
            }
            term.multiply((self.pivot - point) / f64::from(k));
            let go_on = term.over(&self.first).abs();
            if go_on < 1.0 {
                if !happens(go_on, source) {
                    break;
                }
                term.multiply(1.0 / go_on);
            }
            sum.add(&term);
        }
        sum.value()
    }

    fn ratio<F: Extinction>(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut product = SignedProduct::ONE;
        for _ in 0..poisson(self.pivot, source) {
            product.multiply(1.0 - Self::point(field, source) / self.pivot);
        }
        product.value()
    }

    /// With p_k the Poisson probabilities and h_k = p_k/P_k, term k is h_k Π_{i ≤ k} (1 − X_i/t_c): the sum is nested, and
    /// evaluated from its end, as the points may come in any order. 1/h_k = Σ_j t_c^j k!/(k + j)! = 1 + t_c/(k + 1)/h_{k+1}:
    /// downwards stable, of positive terms only; 1/h_0 = exp(t_c) may overflow, to an h_0 of 0.
    fn next_flight<F: Extinction>(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let last = poisson(self.pivot, source);
        let mut reciprocal = remainder(self.pivot, f64::from(last));
        let mut sum = SignedProduct::of(1.0 / reciprocal);
        for k in (1..=last).rev() {
            reciprocal = 1.0 + self.pivot / f64::from(k) * reciprocal;
            sum.multiply(1.0 - Self::point(field, source) / self.pivot);
            sum.add(&SignedProduct::of(1.0 / reciprocal));
        }
        sum.value()
    }
}

/// r_k = Σ_j y^j k!/(k + j)! for y ≥ 0, or a k above |y|.
fn remainder(y: f64, k: f64) -> f64 {
    let (mut sum, mut term, mut next) = (1.0, 1.0, k);
    while f64::abs(term) > 1e-17 * sum {
        next += 1.0;
        term *= y / next;
        sum += term;
    }
    sum
}

/// ln r_0 … ln r_n, for an n above 2|y|. r_k = 1 + y/(k + 1) r_{k+1} downwards where that damps an error: always for y ≥ 0,
/// from k ≥ |y| for y < 0, with the same rule upwards from r_0 = exp(y) below.
fn log_remainders(y: f64, n: usize) -> Vec<f64> {
    let mut logs = vec![0.0; n + 1];
    logs[n] = ln(remainder(y, n as f64));
    let turn = if y < 0.0 { (-y).ceil() as usize } else { 0 };
    for k in (turn..n).rev() {
        let factor = y / (k + 1) as f64;
        logs[k] = if y < 0.0 {
            ln_1p(factor * exp(logs[k + 1]))
        } else {
            // ln(1 + exp(x)): exp(x) may overflow.
            let x = ln(factor) + logs[k + 1];
            x.max(0.0) + ln_1p(exp(-x.abs()))
        };
    }
    let mut r = exp(y);
    for (k, log) in logs.iter_mut().enumerate().take(turn) {
        *log = ln(r);
        r = (1.0 - r) * (k + 1) as f64 / -y;
    }
    logs
}

/// Orders beyond which the closed forms are not summed: only a pivot that is very wrong needs as many.
const MOST_ORDERS: f64 = 1e6;

impl PSeries {
    /// Variance and look-ups by (6); `spread` is v with its error.
    fn fixed_orders(&self, y: f64, spread: f64, error: f64) -> Theory {
        let (pivot, q) = (self.pivot, y * y + spread);
        // Beyond 4q/t_c, t_c and |y| a term is at most half of the one before; 100 more are below rounding.
        let orders = f64::from(self.sure) + 4.0 * (q / pivot).max(pivot).max(y.abs()) + 100.0;
        if pivot == 0.0 && q == 0.0 {
            return of_variance(0.0, 0.0, 0.0, f64::from(self.sure)); // a vacuum
        }
        if pivot == 0.0 || orders > MOST_ORDERS {
            return Theory::mean_only(f64::NAN);
        }
        let n = orders as usize;
        let (tails, remainders) = (log_remainders(pivot, n), log_remainders(y, n));
        let (mut log_reached, mut log_factorial, mut lookups) = (0.0, 0.0, 0.0);
        let terms: Vec<(f64, f64)> = (1..=n)
            .map(|k| {
                let order = k as f64;
                // ln P_k/P_{k−1}, and 1 less it.
                let (log_go_on, stop) = match self.version {
                    PSeriesVersion::Cmf if k <= self.sure as usize => (0.0, 0.0),
                    PSeriesVersion::Cmf => {
                        let go_on = (pivot / order).min(1.0);
                        (ln(go_on), 1.0 - go_on)
                    }
                    // h_{k−1} of a Poisson law, and P_k/P_{k−1} = (t_c/k) h_{k−1}/h_k
                    _ => (ln(pivot / order) + tails[k] - tails[k - 1], exp(-tails[k - 1])),
                };
                log_reached += log_go_on;
                lookups += exp(log_reached);
                log_factorial += ln(order);
                let decided = spread + y * y * stop;
                let power = if k == 1 { 0.0 } else { (order - 1.0) * ln(q) };
                let log =
                    -2.0 * y + power - 2.0 * log_factorial + 2.0 * remainders[k] - log_reached + ln(decided);
                (log, (order - 1.0) / q + 1.0 / decided)
            })
            .collect();
        let scale = terms.iter().map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
        if scale == f64::NEG_INFINITY {
            return of_variance(0.0, 0.0, 0.0, lookups);
        }
        let sum: f64 = terms.iter().map(|(log, _)| exp(log - scale)).sum();
        // d Var/dv
        let slope: f64 =
            terms.iter().filter(|(log, _)| *log > scale - 700.0).map(|(log, d)| exp(log - scale) * d).sum();
        of_variance(scale, sum, slope * error, lookups)
    }
}

impl PSeries {
    /// The bound (7) for the variance `spread` = v and p = `magnitude`; infinite where it overflows, or would take too many orders.
    fn cumulative_bound(&self, y: f64, spread: f64, magnitude: f64) -> f64 {
        let q = y * y + spread;
        // Beyond these a term is a small part of the one before.
        let orders = 8.0 * q.sqrt().max(y.abs()) + 100.0;
        if orders.is_nan() || orders > MOST_ORDERS {
            return f64::INFINITY;
        }
        let remainders = log_remainders(y, orders as usize);
        let (mut sum, mut square, mut lives) = (0.0, 1.0, 1.0);
        for (k, remainder) in remainders.iter().enumerate().skip(1) {
            let order = k as f64;
            let arrives = lives * magnitude / order;
            let coin = f64::min(arrives, 0.25 * f64::min(1.0, lives));
            sum += exp(2.0 * (remainder - y)) * (square * spread / (order * order) + coin);
            square = square * q / (order * order) + coin;
            lives = arrives;
        }
        if sum.is_nan() { f64::INFINITY } else { sum }
    }
}

impl<F: Extinction> ClosedForm<F> for PSeries {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let (pivot, length) = (self.pivot, quadrature.field().length());
        match self.version {
            PSeriesVersion::Cumulative => {
                let mean = if length > 0.0 { tau / length } else { 0.0 };
                let spread =
                    quadrature.integrate(tolerance, |_, sigma_t| [length * (sigma_t - mean).powi(2)]);
                let (v, y) = (spread.value[0] + spread.error[0], pivot - tau);
                // |Y| has kinks where Y vanishes: split there, a rough integral and its error are enough.
                quadrature.split_at_zeros(tolerance, &|_, sigma_t| pivot - length * sigma_t);
                let of_magnitude = |_: f64, sigma_t: f64| [(pivot - length * sigma_t).abs() / length];
                let magnitude = quadrature.integrate(Tolerance::to(1e-3), of_magnitude);
                let most = (y * y + v).sqrt();
                let magnitude =
                    if length > 0.0 { f64::min(most, magnitude.value[0] + magnitude.error[0]) } else { most };
                Theory {
                    relative_variance_bound: self.cumulative_bound(y, v, magnitude),
                    ..Theory::mean_only(f64::NAN)
                }
            }
            PSeriesVersion::Ratio if pivot == 0.0 => of_variance(0.0, 0.0, 0.0, 0.0),
            PSeriesVersion::Ratio => {
                let collisions = quadrature.integrate(tolerance, |_, sigma_t| {
                    std::array::from_fn(|i| pivot / length * (-length * sigma_t / pivot).powi(i as i32 + 2))
                });
                ProductLaw::new(collisions.value).theory(collisions.error[0], pivot)
            }
            PSeriesVersion::Cmf | PSeriesVersion::NextFlight => {
                let mean = if length > 0.0 { tau / length } else { 0.0 };
                let spread =
                    quadrature.integrate(tolerance, |_, sigma_t| [length * (sigma_t - mean).powi(2)]);
                self.fixed_orders(pivot - tau, spread.value[0], spread.error[0])
            }
        }
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for PSeries {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        match self.version {
            PSeriesVersion::Cmf => self.cmf(field, source),
            PSeriesVersion::Cumulative => self.cumulative(field, source),
            PSeriesVersion::Ratio => self.ratio(field, source),
            PSeriesVersion::NextFlight => self.next_flight(field, source),
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        self.version == PSeriesVersion::Cumulative || self.pivot > 0.0 || field.length() * sigma_t == 0.0
    }
}

#[cfg(test)]
#[path = "p_series_tests.rs"]
mod tests;
