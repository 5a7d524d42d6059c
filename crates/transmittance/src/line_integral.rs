//! Raab, Seibert & Keller's line integral (raab-2008 algorithm 2), for transmittance and for any other integral along a ray.

use crate::allowance::Allowance;
use crate::woodcock::{collides, expected_lookups};
use crate::{ClosedForm, HIGHEST_MOMENT, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, exp_m1, ln, ln_1p};
use fairflight_media::{Breakpoints, Cumulative, Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// n Woodcock flights whose first collisions are stratified by one random shift and conditioned to lie on the profile.
///
/// With p_V = 1 − exp(−majorant · S), the probability that a flight through the majorant collides at all,
///
/// > T̂ = (1 − p_V) + p_V · (number of flights that escape nevertheless) / n.
///
/// The first variates (k + ξ) p_V / n lie in \[0, p_V): only −ln(1 − u) puts the first collision on the profile. (The
/// printed algorithm 1 takes −ln(u): a bias, 0.420 for 0.331 in one case.) They are off the 2^-53 lattice, so that
/// `ln_1p` and `exp_m1` keep thin media exact.
///
/// **Law.** Unbiased for 0 ≤ σ_t ≤ majorant. Only the first step is stratified; later steps are independent.
///
/// **Moments.** The flights share ξ, so that this is no product over a Poisson process. Given ξ they are independent coins
/// with escape probabilities g((k + ξ)/n), g(u) = (1 − σ_t(t)/majorant) T(t, S) at t = −ln(1 − u p_V)/majorant; the
/// moments up to the 8th are integrals over ξ of those of the sum of coins.
///
/// **Cost.** One estimate is one set of n flights: n · majorant ∫T(0, s) ds / p_V look-ups (a Woodcock flight without
/// collision costs nothing, and p_V is the probability that there is one).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineIntegral {
    splits: u32,
}

/// Choice of the first steps of the flights of a [`LineIntegral`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Starts {
    /// Equidistant variates with one random shift, as algorithm 2 does.
    #[default]
    Equidistant,
    /// Independent variates: what raab-2008 fig. 1 and 2 compare with.
    Independent,
}

/// A line integral needs at least one flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("splits must be at least 1, found 0")]
pub struct NoSplits;

impl LineIntegral {
    /// The estimator with `splits` flights per estimate.
    ///
    /// # Errors
    /// If `splits` is 0.
    pub fn new(splits: u32) -> Result<Self, NoSplits> {
        if splits == 0 { Err(NoSplits) } else { Ok(Self { splits }) }
    }
}

/// p_V = 1 − exp(−majorant · S): the probability of a collision with the majorant's medium.
fn collision_probability<F: Majorant>(field: &F) -> f64 {
    -exp_m1(-field.majorant() * field.length())
}

impl LineIntegral {
    /// Estimates any transmittance-weighted integral along the profile (raab-2008 eq. 13),
    ///
    /// > C = c_∂V(length) T(length) + ∫ c_V(s) T(s) ds,
    ///
    /// by the same flights: one that collides at s scores p_V c_V(s)/(n σ_t(s)), one that escapes p_V c_∂V/n (step 6). `end`
    /// is c_∂V. `collision(s, σ_t(s), source)` is c_V(s)/σ_t(s), the score of a collision; for in-scattering it is albedo ·
    /// in-scattered radiance, finite where σ_t vanishes since no flight collides there.
    ///
    /// Independent `starts` have the same expectation, and no stratification.
    ///
    /// T is a number or a colour: whatever can be added, and multiplied by a number.
    #[inline]
    pub fn integrate<
        F: Majorant,
        S: UniformSource,
        T: Copy + std::ops::AddAssign + std::ops::Mul<f64, Output = T>,
    >(
        &self,
        field: &F,
        starts: Starts,
        source: &mut S,
        end: T,
        mut collision: impl FnMut(f64, f64, &mut S) -> T,
    ) -> T {
        let p_volume = collision_probability(field);
        if p_volume == 0.0 {
            return end;
        }
        let mut scores = end * 0.0;
        let n = f64::from(self.splits);
        let shift = source.next_uniform();
        for k in 0..self.splits {
            let fraction = match starts {
                Starts::Equidistant => (f64::from(k) + shift) / n,
                Starts::Independent if k == 0 => shift,
                Starts::Independent => source.next_uniform(),
            };
            let u = fraction * p_volume;
            // Rounding may put u on p_V itself: such a flight counts as escaped, at a probability below 2^-50.
            scores += match collides(field, -ln_1p(-u), source) {
                Some((s, sigma_t)) => collision(s, sigma_t, source),
                None => end,
            };
        }
        let mut sum = end * exp(-field.majorant() * field.length());
        sum += scores * (p_volume / n);
        sum
    }
}

/// Transmittance is the integral with c_∂V = 1 and c_V = 0.
impl<F: Majorant> TransmittanceEstimator<F> for LineIntegral {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.integrate(field, Starts::Equidistant, source, 1.0, |_, _, _| 0.0)
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        (0.0..=field.majorant()).contains(&sigma_t)
    }
}

/// The escape probability of a flight as a function of its first variate.
struct Escape<'a, F> {
    field: &'a F,
    optical_thickness: Cumulative<1>,
    total: f64,
    p_volume: f64,
}

impl<F: Majorant> Escape<'_, F> {
    fn probability(&self, u: f64) -> f64 {
        let majorant = self.field.majorant();
        let t = (-ln_1p(-u * self.p_volume) / majorant).min(self.field.length());
        let behind = self.total - self.optical_thickness.at(t)[0];
        ((1.0 - self.field.sigma_t(t) / majorant) * exp(-behind)).clamp(0.0, 1.0)
    }

    /// The variate whose first collision is at `t`.
    fn variate(&self, t: f64) -> f64 {
        -exp_m1(-self.field.majorant() * t) / self.p_volume
    }
}

impl<F: Majorant + Breakpoints> ClosedForm<F> for LineIntegral {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let p_volume = collision_probability(quadrature.field());
        let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
        if p_volume == 0.0 {
            return Theory::exact();
        }
        let n = f64::from(self.splits);
        let lookups = n * expected_lookups(quadrature, tolerance) / p_volume;
        if tau - 3.0 * ln(n) > RARE {
            let depth = quadrature.field().majorant() * quadrature.field().length();
            return of_rare_escapes((tau, depth), p_volume / n, lookups);
        }
        let cumulative = quadrature.cumulative(tolerance, |_, sigma_t| [sigma_t]);
        let field = quadrature.field();
        let total = cumulative.at(field.length())[0];
        let escape = Escape { field, optical_thickness: cumulative, total, p_volume };
        let transmittance = exp(-tau);
        // E[number of escapes] = n (T − p_S) / p_V
        let mean = n * (transmittance - (1.0 - p_volume)) / p_volume;
        let breaks: Vec<f64> = field.breakpoints().iter().map(|&t| (n * escape.variate(t)).fract()).collect();
        let allowance = Allowance::usual();
        let moments = allowance.integral(&breaks, tolerance, n, |shift| {
            let probabilities = (0..self.splits).map(|k| escape.probability((f64::from(k) + shift) / n));
            moments_about(mean, &coin_cumulants(probabilities))
        });
        let Some(moments) = moments else {
            return Theory::without(allowance.unreached(2), lookups);
        };
        let unit = p_volume / n / transmittance;
        for (k, moment) in moments.value.into_iter().enumerate() {
            relative_central[k] = moment * unit.powi(k as i32 + 2);
        }
        Theory {
            relative_central,
            log_relative_variance: ln(relative_central[0]),
            relative_variance_error: moments.error[0] / moments.value[0],
            ..Theory::mean_only(lookups)
        }
    }
}

/// −ln 2^-53: escapes that are rarer are never two of one estimate, to rounding, and the quadrature over variates misses them.
const RARE: f64 = 36.8;

/// The law where an estimate has one escape at most, of `weight` = p_V/n, and hardly ever that: τ well above 3 ln n.
///
/// With ĝ_k = g_k/T the probabilities of escape, E\[Σ ĝ_k\] = m̂ = n (1 − exp(τ − μS))/p_V. All flights but the last start at u ≤ (n − 1)/n,
/// where ĝ_k ≤ exp(μt) ≤ n, so that two escapes have the probability T² Σ_{k≠l} E\[ĝ_k ĝ_l\] ≤ 2n² m̂ T²: beside the m̂ T of one it is
/// 2n² T, below rounding for τ − 3 ln n > 36.8, and so is the mean in (N − E\[N\])^k. Hence E\[(N − E)^k\]/T^k = m̂ exp((k − 1) τ).
fn of_rare_escapes((tau, depth): (f64, f64), weight: f64, lookups: f64) -> Theory {
    // m̂ weight = 1 − exp(τ − μS).
    let log_escapes = ln((-exp_m1(tau - depth)).max(0.0)) - ln(weight);
    let log = |k: f64| k * ln(weight) + log_escapes + (k - 1.0) * tau;
    Theory {
        relative_mean: 1.0,
        relative_central: std::array::from_fn(|i| exp(log(i as f64 + 2.0))),
        log_relative_variance: log(2.0),
        relative_variance_error: 0.0,
        ..Theory::mean_only(lookups)
    }
}

/// The cumulants κ_1 … κ_8 of the number of heads of independent coins: those of one coin, added.
///
/// With v = p (1 − p) and κ_{n+1} = v dκ_n/dp from κ_1 = p.
fn coin_cumulants(probabilities: impl Iterator<Item = f64>) -> [f64; HIGHEST_MOMENT] {
    let mut cumulants = [0.0; HIGHEST_MOMENT];
    for p in probabilities {
        let (v, odd) = (p * (1.0 - p), 1.0 - 2.0 * p);
        let of_one = [
            p,
            v,
            v * odd,
            v * (1.0 - 6.0 * v),
            v * odd * (1.0 - 12.0 * v),
            v * (1.0 - 30.0 * v + 120.0 * v * v),
            v * odd * (1.0 - 60.0 * v + 360.0 * v * v),
            v * (1.0 - 126.0 * v + 1680.0 * v * v - 5040.0 * v * v * v),
        ];
        for (sum, cumulant) in cumulants.iter_mut().zip(of_one) {
            *sum += cumulant;
        }
    }
    cumulants
}

/// E\[(X − centre)^n\], n = 2 … 8, of a variate X with these cumulants: the cumulants of X − centre differ in the first only,
/// and m_n = Σ_{j=1..n} C(n − 1, j − 1) κ_j m_{n−j}.
fn moments_about(centre: f64, cumulants: &[f64; HIGHEST_MOMENT]) -> [f64; HIGHEST_MOMENT - 1] {
    let mut moments = [0.0; HIGHEST_MOMENT + 1];
    moments[0] = 1.0;
    for n in 1..=HIGHEST_MOMENT {
        let mut binomial = 1.0;
        for j in 1..=n {
            let cumulant = if j == 1 { cumulants[0] - centre } else { cumulants[j - 1] };
            moments[n] += binomial * cumulant * moments[n - j];
            binomial *= (n - j) as f64 / j as f64;
        }
    }
    std::array::from_fn(|i| moments[i + 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn rare_escapes_are_the_coins_that_they_are() {
        // Both laws near the border between them, for a constant profile below a loose majorant.
        for (splits, tau) in [(1, 37.5), (2, 39.0)] {
            let field =
                fairflight_media::Bounded::new(fairflight_media::Constant::new(tau, 1.0).unwrap(), 1.1 * tau);
            let field = field.unwrap();
            let estimator = LineIntegral::new(splits).unwrap();
            let at =
                |quadrature: &mut RayQuadrature<_>, tau| estimator.theory(quadrature, tau, Tolerance::TIGHT);
            let rare = at(&mut RayQuadrature::new(field, &[]), tau);
            // One flight is a coin: p_V (1 − exp(τ − μS)) exp(τ).
            let coin = -(-0.1 * tau).exp_m1() * tau.exp() / f64::from(splits);
            assert_relative_eq!(rare.relative_central[0], coin, max_relative = 1e-12);
            assert_relative_eq!(rare.log_relative_variance, coin.ln(), max_relative = 1e-12);
        }
        let dense =
            fairflight_media::Bounded::new(fairflight_media::Constant::new(4e4, 1.0).unwrap(), 5e4).unwrap();
        let estimator = LineIntegral::new(4).unwrap();
        let theory = estimator.theory(&mut RayQuadrature::new(dense, &[]), 4e4, Tolerance::TIGHT);
        assert_relative_eq!(theory.log_relative_variance, 4e4 - 4.0_f64.ln(), max_relative = 1e-12);
    }

    #[test]
    fn moments_of_coins_are_those_of_their_distribution() {
        // Three coins, all eight outcomes by hand, about an arbitrary centre.
        let coins = [0.2, 0.55, 0.9];
        let centre = 1.3;
        let moments = moments_about(centre, &coin_cumulants(coins.into_iter()));
        for (i, moment) in moments.into_iter().enumerate() {
            let exact: f64 = (0..8_u32)
                .map(|outcome| {
                    let up = |k: usize| outcome >> k & 1 == 1;
                    let probability: f64 =
                        (0..3).map(|k| if up(k) { coins[k] } else { 1.0 - coins[k] }).product();
                    probability * (f64::from(outcome.count_ones()) - centre).powi(i as i32 + 2)
                })
                .sum();
            assert_relative_eq!(moment, exact, max_relative = 1e-12);
        }
    }
}
