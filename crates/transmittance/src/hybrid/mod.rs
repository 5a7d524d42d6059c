//! An estimator chosen per ray by predicted variance times cost.

mod experience;
mod pilot;

pub use experience::Experience;
pub use pilot::Pilot;

use crate::{
    ClosedForm, Comb, CombShape, JitteredRatio, Roulette, Theory, TransmittanceEstimator,
    UnbiasedRayMarching, predicted_relative_variance, teeth_for,
};
use fairflight_elementary::{exp, exp_m1, ln};
use fairflight_media::{Breakpoints, Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use pilot::{EPSILONS, FINENESSES};

/// Unbiased ray marching as a whole or in segments, or jittered ratio tracking: what earlier rays through the medium make expect the least
/// variance times look-ups.
///
/// **Law.** Each of the three is unbiased, and the choice depends on [`Experience`] alone, which is independent of the variates of the
/// estimate: so is the whole.
///
/// **Why these.** A comb over a whole ray has errors that cancel where the field is smooth, down to rounding, but a second-order term
/// k2²/(2P) that ruins it where k2 > 0.2 (kettunen-2021 as measured in `UnbiasedRayMarching`); in segments that term is divided by their
/// number; jittered ratio tracking has none, stays in \[0, 1\], and costs more look-ups. Neither of them needs what the others do best.
///
/// **Variance and cost** are those of what was chosen.
///
/// **Source.** Ours; no publication of it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hybrid {
    choice: Choice,
    /// Expected Var/T² and look-ups.
    forecast: Forecast,
}

/// Choice of a hybrid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Choice {
    /// Unbiased ray marching.
    Marching(UnbiasedRayMarching),
    /// Jittered ratio tracking.
    Jittered(JitteredRatio),
}

/// Variance and cost that are expected of an estimator before it is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Var/T² \[1\].
    pub relative_variance: f64,
    /// Look-ups of one estimate.
    pub lookups: f64,
}

impl Forecast {
    fn price(&self) -> f64 {
        self.relative_variance * self.lookups
    }
}

/// Greatest variance at which the second-order law of a comb holds: on the seed ray with P = 0.1 it is 4 % too high at k2 = 0.27, and
/// 27 % too low at 0.9.
const MOST_VARIANCE: f64 = 0.3;
/// Greatest cost of a comb on one remembered ray relative to jittered ratio tracking: a forecast is uncertain by about so much.
const MOST_LOSS: f64 = 1.25;
/// A variance of a comb is known from one pilot to a factor of two: fewer than so many do not tell whether it fails.
const LEAST_PILOTS: usize = 4;
/// Variances below this are rounding, and not worth more look-ups.
const ROUNDING: f64 = 1e-26;

/// Candidates of the choice.
#[derive(Clone, Copy)]
enum Candidate {
    /// One comb of 2^fineness times the rule's teeth over the whole ray.
    Whole { fineness: usize, shape: CombShape },
    /// 2^fineness times as many segments as the rule has teeth, of one tooth each.
    Apart { fineness: usize },
    /// Jittered ratio tracking.
    Jittered { index: usize },
}

impl Candidate {
    fn combs() -> impl Iterator<Item = Self> {
        (0..FINENESSES).flat_map(|fineness| {
            let whole = |shape| Self::Whole { fineness, shape };
            [whole(CombShape::EndpointMatched), whole(CombShape::Uniform), Self::Apart { fineness }]
        })
    }

    /// True if its combs are of the rule's size.
    fn is_least(self) -> bool {
        matches!(self, Self::Whole { fineness: 0, .. } | Self::Apart { fineness: 0 })
    }

    /// Var(optical thickness) that a pilot found for its combs; for jittered ratio tracking the relative variance itself.
    fn variance(self, pilot: &Pilot) -> f64 {
        match self {
            Self::Whole { fineness, shape: CombShape::EndpointMatched } => pilot.matched[fineness],
            Self::Whole { fineness, .. } => pilot.whole[fineness],
            Self::Apart { fineness } => pilot.apart[fineness],
            Self::Jittered { index } => pilot.jittered[index],
        }
    }
}

impl Hybrid {
    /// Look-ups per unit of the majorant's optical thickness that an estimate may cost: with six, combs of up to four times the rule's
    /// teeth, and strata down to a quarter.
    pub const USUAL_BUDGET: f64 = 6.0;

    /// The choice for a ray of this length, whose optical thickness in the majorant is `depth`, that costs at most `budget` look-ups per
    /// unit of that (the least comb and the coarsest strata are allowed whatever they cost).
    ///
    /// It is jittered ratio tracking with the finest strata that the budget allows, unless a comb is forecast to cost less variance times
    /// look-ups in the geometric mean over the rays remembered, and not much more on any of them: a mean hides the ray on
    /// which a comb fails, and it fails by much. Then the best such comb. Without experience nobody knows of one.
    #[must_use]
    pub fn choose(experience: &Experience, length: f64, depth: f64, budget: f64) -> Self {
        let ray = (length, depth, teeth_for(depth));
        let most = budget * depth;
        let finest = (0..EPSILONS.len()).rev().find(|&index| jittered_cost(depth, index).lookups <= most);
        let jittered = Candidate::Jittered { index: finest.unwrap_or(0) };
        let mut best = Self::of(jittered, experience, ray).unwrap_or(Self {
            choice: Choice::Jittered(strata(finest.unwrap_or(0))),
            forecast: jittered_cost(depth, finest.unwrap_or(0)),
        });
        let safe = best.forecast;
        for candidate in Candidate::combs() {
            if let Some(comb) = Self::of(candidate, experience, ray)
                && (comb.forecast.lookups <= most || candidate.is_least())
                && comb.forecast.price() < best.forecast.price()
                && comb.is_safe((candidate, jittered), experience, length, safe.lookups)
            {
                best = comb;
            }
        }
        best
    }

    /// True if a comb is forecast to cost hardly more than jittered ratio tracking on every ray remembered.
    fn is_safe(
        &self,
        (candidate, jittered): (Candidate, Candidate),
        experience: &Experience,
        length: f64,
        jittered_lookups: f64,
    ) -> bool {
        let Choice::Marching(estimator) = &self.choice else { return true };
        experience.pilots().iter().all(|pilot| {
            let on_this_ray = |candidate: Candidate| candidate.variance(pilot) * length / pilot.length;
            let (roulette, segments) = (estimator.roulette(), estimator.segments());
            let variance = predicted_relative_variance(on_this_ray(candidate), roulette, segments);
            let allowed = MOST_LOSS * on_this_ray(jittered).max(ROUNDING) * jittered_lookups;
            variance.max(ROUNDING) * self.forecast.lookups <= allowed
        })
    }

    /// A candidate with its forecast; `None` where there is no experience, or the law ends by which it could be forecast.
    fn of(
        candidate: Candidate,
        experience: &Experience,
        (length, depth, teeth): (f64, f64, u32),
    ) -> Option<Self> {
        let pilots = experience.pilots();
        let on_this_ray = |pilot: &Pilot| candidate.variance(pilot) * length / pilot.length;
        let count = pilots.len() as f64;
        let is_comb = !matches!(candidate, Candidate::Jittered { .. });
        if pilots.is_empty() || (is_comb && pilots.len() < LEAST_PILOTS) {
            return None;
        }
        let geometric_mean = |variance: &dyn Fn(&Pilot) -> f64| {
            exp(pilots.iter().map(|pilot| ln(variance(pilot).max(ROUNDING))).sum::<f64>() / count)
        };
        if let Candidate::Jittered { index } = candidate {
            let relative_variance = geometric_mean(&on_this_ray);
            let forecast = Forecast { relative_variance, ..jittered_cost(depth, index) };
            return Some(Self { choice: Choice::Jittered(strata(index)), forecast });
        }
        let (comb, segments) = match candidate {
            Candidate::Whole { fineness, shape } => (Comb::new(teeth << fineness, shape).ok()?, 1),
            Candidate::Apart { fineness } => (Comb::new(1, CombShape::Uniform).ok()?, teeth << fineness),
            Candidate::Jittered { .. } => return None,
        };
        // The roulette fits their mean, to which the worst contributes most: that is where a wrong one costs most.
        let mean = pilots.iter().map(on_this_ray).sum::<f64>() / count / f64::from(segments);
        if mean > MOST_VARIANCE {
            return None;
        }
        let roulette = Roulette::tuned(mean);
        let estimator = UnbiasedRayMarching::new(comb, roulette).in_segments(segments).ok()?;
        let predicted = |pilot: &Pilot| predicted_relative_variance(on_this_ray(pilot), roulette, segments);
        let forecast =
            Forecast { relative_variance: geometric_mean(&predicted), lookups: estimator.expected_lookups() };
        Some(Self { choice: Choice::Marching(estimator), forecast })
    }

    /// The choice for this ray.
    #[must_use]
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// Expected variance and cost; infinite without experience.
    #[must_use]
    pub fn forecast(&self) -> Forecast {
        self.forecast
    }
}

fn strata(index: usize) -> JitteredRatio {
    JitteredRatio::new(EPSILONS[index]).expect("the list holds numbers above 0 and at most 1")
}

/// (exp(e) − 1)/e look-ups for each stratum of the optical thickness e.
fn jittered_cost(depth: f64, index: usize) -> Forecast {
    let strata = (depth / EPSILONS[index]).ceil().max(1.0);
    let thickness = depth / strata;
    let lookups = if thickness > 0.0 { strata * exp_m1(thickness) / thickness } else { 0.0 };
    Forecast { relative_variance: f64::INFINITY, lookups }
}

impl<F: Majorant> TransmittanceEstimator<F> for Hybrid {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        match &self.choice {
            Choice::Marching(estimator) => estimator.estimate(field, source),
            Choice::Jittered(estimator) => estimator.estimate(field, source),
        }
    }

    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        match &self.choice {
            Choice::Marching(estimator) => estimator.admits(field, s, sigma_t),
            Choice::Jittered(estimator) => estimator.admits(field, s, sigma_t),
        }
    }
}

impl<F: Majorant + Breakpoints> ClosedForm<F> for Hybrid {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        match &self.choice {
            Choice::Marching(estimator) => estimator.theory(quadrature, tau, tolerance),
            Choice::Jittered(estimator) => estimator.theory(quadrature, tau, tolerance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Bounded, PiecewiseLinear};
    use fairflight_sources::Seeded;

    /// Pilots of a ramp, whose matched combs have no variance.
    fn of_a_ramp(pilots: usize) -> Experience {
        let ramp = PiecewiseLinear::new(vec![0.0, 20.0], vec![0.0, 1.0]).unwrap();
        let mut experience = Experience::default();
        let mut source = Seeded::new(1);
        (0..pilots)
            .for_each(|_| experience.observe(&Pilot::of(&Bounded::new(&ramp, 1.0).unwrap(), &mut source)));
        experience
    }

    fn chosen(experience: &Experience, budget: f64) -> Choice {
        *Hybrid::choose(experience, 20.0, 20.0, budget).choice()
    }

    fn jittered(epsilon: f64) -> Choice {
        Choice::Jittered(JitteredRatio::new(epsilon).unwrap())
    }

    #[test]
    fn without_enough_experience_it_takes_the_finest_strata_of_the_budget() {
        for pilots in 0..LEAST_PILOTS {
            let experience = of_a_ramp(pilots);
            assert_eq!(chosen(&experience, Hybrid::USUAL_BUDGET), jittered(0.25));
            assert_eq!(chosen(&experience, 2.0), jittered(1.0));
            assert_eq!(chosen(&experience, 10.0), jittered(0.125));
        }
    }

    #[test]
    fn a_comb_without_variance_is_taken_at_its_cheapest() {
        let Choice::Marching(comb) = chosen(&of_a_ramp(LEAST_PILOTS), Hybrid::USUAL_BUDGET) else {
            panic!("a matched comb is exact on a ramp");
        };
        assert_eq!((comb.comb().shape(), comb.segments()), (CombShape::EndpointMatched, 1));
        assert_eq!(comb.comb().teeth(), teeth_for(20.0));
    }

    #[test]
    fn one_ray_on_which_combs_fail_is_enough_to_leave_them() {
        let mut experience = of_a_ramp(8);
        let good = experience.pilots()[0];
        let bad = [1.0; FINENESSES];
        experience.observe(&Pilot { whole: bad, matched: bad, apart: bad, ..good });
        assert_eq!(chosen(&experience, Hybrid::USUAL_BUDGET), jittered(0.25));
    }

    #[test]
    fn the_memory_is_as_long_as_it_says() {
        let mut experience = of_a_ramp(1);
        let good = experience.pilots()[0];
        experience.observe(&Pilot { matched: [1.0; FINENESSES], ..good });
        (0..16).for_each(|_| experience.observe(&good));
        assert!(matches!(chosen(&experience, Hybrid::USUAL_BUDGET), Choice::Marching(_)));
        assert_eq!((experience.rays(), experience.pilots().len()), (18, 16));
    }

    /// One candidate on a ray of length 20 like those remembered, which are a ramp's but for what the test says.
    fn candidate(candidate: Candidate, change: impl Fn(usize, &mut Pilot)) -> (Option<Hybrid>, Experience) {
        let good = of_a_ramp(1).pilots()[0];
        let mut experience = Experience::default();
        for i in 0..8 {
            let mut pilot = good;
            change(i, &mut pilot);
            experience.observe(&pilot);
        }
        (Hybrid::of(candidate, &experience, (20.0, 20.0, teeth_for(20.0))), experience)
    }

    #[test]
    fn a_comb_is_forecast_as_far_as_its_law_goes_and_has_the_roulette_of_its_segments() {
        let matched = Candidate::Whole { fineness: 0, shape: CombShape::EndpointMatched };
        let known = |variance: f64| candidate(matched, |_, pilot| pilot.matched[0] = variance).0.is_some();
        assert_eq!([0.29, 0.31, 3.0].map(known), [true, false, false]);
        let segments = teeth_for(20.0);
        let variance = 0.05;
        let (apart, _) = candidate(Candidate::Apart { fineness: 0 }, |_, pilot| pilot.apart[0] = variance);
        let Some(Hybrid { choice: Choice::Marching(comb), .. }) = apart else {
            panic!("a comb has a forecast")
        };
        assert_eq!(
            (comb.segments(), comb.roulette()),
            (segments, Roulette::tuned(variance / f64::from(segments)))
        );
    }

    /// A comb is left when on one ray it would cost more than a quarter above jittered ratio tracking, and not before.
    #[test]
    fn a_comb_may_cost_a_quarter_more_on_one_ray() {
        let matched = Candidate::Whole { fineness: 0, shape: CombShape::EndpointMatched };
        let worst = |i: usize, pilot: &mut Pilot| pilot.matched[0] = if i == 3 { 0.01 } else { 1e-9 };
        let (comb, _) = candidate(matched, worst);
        let comb = comb.expect("a comb has a forecast");
        let Choice::Marching(estimator) = comb.choice else { panic!("it is one") };
        let price = predicted_relative_variance(0.01, estimator.roulette(), 1) * comb.forecast.lookups;
        for (times, safe) in [(1.2, true), (1.3, false)] {
            // What jittered ratio tracking costs on that ray, if one of its estimates takes seven look-ups.
            let (_, experience) = candidate(matched, |i, pilot| {
                worst(i, pilot);
                pilot.jittered[0] = price / times / 7.0;
            });
            let jittered = Candidate::Jittered { index: 0 };
            assert_eq!(comb.is_safe((matched, jittered), &experience, 20.0, 7.0), safe, "{times}");
        }
    }
}
