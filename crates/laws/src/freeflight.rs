//! The law of free flight as a function of any sampler: weighted flights integrate any test function against σ_t T.
//!
//! One run tests at once: the integral of four test functions, the escaped weight, the variance of each against its closed
//! form, the number of look-ups, for a sampler without weights the distribution of its distances; and that every look-up was
//! lawful.

mod evidence;

use crate::{NotFinite, Run, batch_count, batch_moments, batch_size, lookups};
use evidence::Part;
use fairflight_freeflight::{ClosedForm, Flight, FreeFlight};
use fairflight_media::{
    Counted, Cumulative, Domain, Extinction, Integral, RayQuadrature, Tolerance, Violation, Watched,
};
use fairflight_sources::Seeded;
use fairflight_stats::{ClosedMoments, Moments, Reference, Scores, judge, kolmogorov_smirnov};

pub use evidence::FlightEvidence;

/// A function of distance over length.
pub type TestFunction = fn(f64) -> f64;

/// Test functions of distance over length, all within \[0, 1\]: whether, where on average, which half, and a wave.
pub const TEST_FUNCTIONS: [(&str, TestFunction); 4] = [
    ("collided", |_| 1.0),
    ("distance", |x| x),
    ("second half", |x| if x >= 0.5 { 1.0 } else { 0.0 }),
    ("wave", |x| 0.5 + 0.5 * (7.0 * x).cos()),
];

/// Test functions that are 0 or 1.
const INDICATORS: [&str; 2] = ["collided", "second half"];

/// Distances that are compared with their distribution: more say little more, and each is kept.
const MOST_DISTANCES: usize = 1 << 18;

/// Known facts about the weights of a sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// All are 1: distances have the density σ_t T.
    One,
    /// All lie between 0 and this number.
    UpTo(u32),
    /// Nothing is known: they vary.
    Any,
}

/// Expectations about the flights of one sampler on one profile.
#[derive(Clone, Debug)]
pub struct FlightExpectation {
    length: f64,
    weights: Weights,
    /// Reference for each of [`TEST_FUNCTIONS`].
    collided: [Reference; TEST_FUNCTIONS.len()],
    escaped: Reference,
    lookups: Option<Reference>,
    thickness: Cumulative<1>,
}

impl FlightExpectation {
    /// Computes the expectations by quadrature: the means from the law itself, the other moments from the closed form of `sampler`.
    ///
    /// The `quadrature` has a border wherever σ_t or anything that the sampler knows is not smooth.
    pub fn new<F: Extinction + Clone, E: ClosedForm<F>>(
        quadrature: &mut RayQuadrature<F>,
        sampler: &E,
        weights: Weights,
        tolerance: Tolerance,
    ) -> Self {
        let length = quadrature.field().length();
        // Where the indicator jumps.
        quadrature.split_at(&[0.5 * length]);
        let (means, weight_law) = (law(quadrature, tolerance), sampler.weights());
        let collided = std::array::from_fn(|i| {
            let (name, function) = TEST_FUNCTIONS[i];
            let moments = weight_law.collided(quadrature, tolerance, &|s| function(s / length)).value;
            Reference {
                error: means.error[i],
                moments: Some(ClosedMoments::from_raw(&moments)),
                scores: scores(weights, INDICATORS.contains(&name)),
                ..Reference::exact(means.value[i])
            }
        });
        let tau = quadrature.integrate(tolerance, |_, sigma_t| [sigma_t]);
        let transmittance = (-tau.value[0]).exp();
        let escaped = Reference {
            error: transmittance * tau.error[0].exp_m1(),
            moments: Some(ClosedMoments::from_raw(&weight_law.escaped(quadrature, tolerance))),
            scores: scores(weights, true),
            ..Reference::exact(transmittance)
        };
        Self {
            length,
            weights,
            collided,
            escaped,
            lookups: sampler.lookups(quadrature, tolerance).map(|raw| lookups::with_moments(&raw)),
            thickness: quadrature.cumulative(tolerance, |_, sigma_t| [sigma_t]),
        }
    }

    /// The look-ups, where their number is judged. An expected number of 0 is a fact about each flight, not about their mean.
    fn counts(&self) -> Option<Reference> {
        self.lookups.filter(|reference| reference.mean > 0.0)
    }

    /// Number of tests that share the false alarm.
    fn tests(&self) -> usize {
        TEST_FUNCTIONS.len() + 1 + usize::from(self.counts().is_some()) + usize::from(self.tests_distances())
    }

    fn tests_distances(&self) -> bool {
        self.weights == Weights::One
    }

    /// The same run with as many flights as the closed moments of scores and look-ups ask for, where they are known.
    #[must_use]
    pub fn sufficient(&self, run: Run) -> Run {
        let references = self.collided.into_iter().chain([self.escaped]).chain(self.counts());
        run.sufficient_for(references, run.alpha / self.tests() as f64)
    }

    /// The same expectations without those of look-ups.
    #[must_use]
    pub fn uncounted(&self) -> Self {
        Self { lookups: None, ..self.clone() }
    }

    /// P(distance ≤ s | collided), for an unweighted sampler.
    fn distribution(&self, s: f64) -> f64 {
        let up_to = |s: f64| -(-self.thickness.at(s)[0]).exp_m1();
        (up_to(s) / up_to(self.length)).clamp(0.0, 1.0)
    }
}

/// ∫ σ_t T g ds for each test function g: the law itself, whatever the sampler.
fn law<F: Extinction>(
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
) -> Integral<{ TEST_FUNCTIONS.len() }> {
    let length = quadrature.field().length();
    quadrature.integrate_nested(
        tolerance,
        |_, sigma_t| [sigma_t],
        |s, sigma_t, [tau]| TEST_FUNCTIONS.map(|(_, function)| sigma_t * (-tau).exp() * function(s / length)),
    )
}

/// The values that a score can have; `is_indicator`: of a test function that is 0 or 1.
fn scores(weights: Weights, is_indicator: bool) -> Scores {
    match (weights, is_indicator) {
        (Weights::One, true) => Scores::TwoValued { high: 1.0 },
        (Weights::One, false) => Scores::Bounded { minimum: 0.0, maximum: 1.0 },
        (Weights::UpTo(most), _) => Scores::Bounded { minimum: 0.0, maximum: f64::from(most) },
        (Weights::Any, _) => Scores::Unbounded,
    }
}

/// Reason why there is no evidence.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FlightRefusal {
    /// A look-up found what the sampler is not defined for.
    #[error("sigma_t = {} at s = {} is outside what the sampler admits", .0.sigma_t, .0.s)]
    Unlawful(Violation),
    /// A weight is no number.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
    /// A collision beyond the ends of the profile, or nowhere.
    #[error("a flight collided at {0}, outside its profile")]
    Outside(f64),
}

/// The values of σ_t that a sampler admits on a field: what a law check watches for.
#[derive(Clone, Copy, Debug)]
pub struct AdmittedFlight<G, E> {
    field: G,
    sampler: E,
}

impl<G: Extinction, E: FreeFlight<G>> Domain for AdmittedFlight<G, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        self.sampler.admits(&self.field, s, sigma_t)
    }
}

/// A field whose look-ups are counted and watched.
pub type ObservedFlight<G, E> = Counted<Watched<G, AdmittedFlight<G, E>>>;

/// Runs `sampler` on `field` (both cheap to copy: pass references) and judges its flights. The false alarm is shared equally.
///
/// # Errors
/// If a look-up or a flight is not lawful: a law says nothing then.
pub fn check<G: Extinction + Copy, E: FreeFlight<G> + FreeFlight<ObservedFlight<G, E>> + Copy>(
    field: G,
    sampler: E,
    expected: &FlightExpectation,
    run: Run,
) -> Result<FlightEvidence, FlightRefusal> {
    let observed = Counted::new(Watched::new(field, AdmittedFlight { field, sampler }));
    let lookups = || observed.lookups();
    let measured = measure(|source| sampler.sample(&observed, source), expected, run, lookups);
    // Before what came of it: a weight that is no number has its reason there.
    match observed.field().violation() {
        Some(violation) => Err(FlightRefusal::Unlawful(violation)),
        None => Ok(measured?.judged(expected, run)),
    }
}

/// Judges as [`check`], unwatched and uncounted: what a wrong twin is tried with.
///
/// # Errors
/// If a flight is not lawful.
pub fn check_flights<G: Extinction, E: FreeFlight<G>>(
    field: G,
    sampler: E,
    expected: &FlightExpectation,
    run: Run,
) -> Result<FlightEvidence, FlightRefusal> {
    let uncounted = expected.uncounted();
    Ok(measure(|source| sampler.sample(&field, source), &uncounted, run, || 0)?.judged(&uncounted, run))
}

/// Measurements of a run of flights.
pub(crate) struct Measured {
    collided: [Moments; TEST_FUNCTIONS.len()],
    escaped: Moments,
    lookups: Moments,
    distances: Vec<f64>,
}

/// Flights of one sampler, whatever it looks up; `lookups` counts from any start.
pub(crate) fn measure(
    mut sample: impl FnMut(&mut Seeded) -> Flight,
    expected: &FlightExpectation,
    run: Run,
    lookups: impl Fn() -> u64,
) -> Result<Measured, FlightRefusal> {
    let mut measured = Measured {
        collided: std::array::from_fn(|_| Moments::new()),
        escaped: Moments::new(),
        lookups: Moments::new(),
        distances: Vec::new(),
    };
    let mut columns: [Vec<f64>; TEST_FUNCTIONS.len() + 2] = Default::default();
    for batch in 0..batch_count(run.samples) {
        columns.iter_mut().for_each(Vec::clear);
        let mut source = Seeded::for_batch(run.seed, batch);
        for _ in 0..batch_size(run.samples, batch) {
            let before = lookups();
            let flight = sample(&mut source);
            let (distance, escaped) = match flight {
                Flight::Collided { distance, .. } => (distance, 0.0),
                Flight::Escaped { weight } => (f64::NAN, weight),
            };
            if flight.distance().is_some() {
                if !(0.0..=expected.length).contains(&distance) {
                    return Err(FlightRefusal::Outside(distance));
                }
                if expected.weights == Weights::One && measured.distances.len() < MOST_DISTANCES {
                    measured.distances.push(distance);
                }
            }
            for (column, (_, function)) in columns.iter_mut().zip(TEST_FUNCTIONS) {
                let score = |distance: f64| flight.weight() * function(distance / expected.length);
                column.push(flight.distance().map_or(0.0, score));
            }
            columns[TEST_FUNCTIONS.len()].push(escaped);
            columns[TEST_FUNCTIONS.len() + 1].push((lookups() - before) as f64);
        }
        let sums = measured.collided.iter_mut().chain([&mut measured.escaped, &mut measured.lookups]);
        for (sum, column) in sums.zip(&columns) {
            sum.merge(&batch_moments(run.seed, batch, column)?);
        }
    }
    Ok(measured)
}

impl Measured {
    pub(crate) fn judged(mut self, expected: &FlightExpectation, run: Run) -> FlightEvidence {
        let none = expected.lookups.is_some_and(|reference| reference.mean == 0.0);
        let (counts, tests_distances) = (expected.counts(), expected.tests_distances());
        let share = run.alpha / expected.tests() as f64;

        let names = TEST_FUNCTIONS.iter().map(|(name, _)| *name).chain(["escaped"]);
        let measured = self.collided.iter().chain([&self.escaped]);
        let references = expected.collided.iter().chain([&expected.escaped]);
        let flights = names
            .zip(measured.zip(references))
            .map(|(name, (moments, reference))| Part { name, verdict: judge(moments, reference, share) })
            .collect();
        let lookups = counts.map(|reference| judge(&self.lookups, &reference, share));
        let distances = tests_distances
            .then(|| kolmogorov_smirnov(&mut self.distances, |s| expected.distribution(s), share));
        FlightEvidence {
            flights,
            lookups,
            distances,
            unexpected_lookups: none && self.lookups.maximum() > Some(0.0),
            samples: run.samples,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DenseLattice;
    use fairflight_freeflight::{Inversion, Newton, Regular};
    use fairflight_media::{Bounds, Constant, Ray, Voxels};
    use fairflight_sources::{Scripted, UniformSource};
    use glam::{DAffine3, DVec3, dvec3};

    const RUN: Run = Run { samples: 20_000, seed: 3, alpha: 1e-6 };

    fn expectation(field: &Constant, weights: Weights) -> FlightExpectation {
        let mut quadrature = RayQuadrature::new(*field, &[]);
        FlightExpectation::new(&mut quadrature, &Inversion, weights, Tolerance::TIGHT)
    }

    #[test]
    fn a_right_sampler_passes_and_another_field_does_not() {
        let (field, other) = (Constant::new(0.8, 2.0).unwrap(), Constant::new(1.0, 2.0).unwrap());
        for weights in [Weights::One, Weights::Any] {
            let expected = expectation(&field, weights);
            assert_eq!(check(field, Inversion, &expected, RUN).unwrap().holds(), Some(true));
            let evidence = check(other, Inversion, &expected, RUN).unwrap();
            assert_eq!(evidence.holds(), Some(false));
        }
    }

    #[test]
    fn distances_outside_and_values_not_admitted_are_refused() {
        let expected = expectation(&Constant::new(0.8, 2.0).unwrap(), Weights::Any);
        let longer = Constant::new(0.8, 9.0).unwrap();
        assert!(matches!(check(longer, Inversion, &expected, RUN), Err(FlightRefusal::Outside(_))));
        #[derive(Clone, Copy)]
        struct Broken(f64);
        impl Extinction for Broken {
            fn sigma_t(&self, _s: f64) -> f64 {
                self.0
            }
            fn length(&self) -> f64 {
                2.0
            }
        }
        #[derive(Clone, Copy)]
        struct Looks;
        impl<F: Extinction> FreeFlight<F> for Looks {
            fn sample(&self, field: &F, _source: &mut impl UniformSource) -> Flight {
                Flight::Escaped { weight: field.sigma_t(0.5) }
            }
            fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
                sigma_t < 0.5
            }
        }
        for sigma_t in [0.8, f64::NAN] {
            let field = Broken(sigma_t);
            assert!(matches!(check(field, Looks, &expected, RUN), Err(FlightRefusal::Unlawful(_))));
        }
    }

    #[test]
    fn regular_tracking_and_newton_find_the_same_distance_in_voxels() {
        let lattice = DenseLattice::of([6, 6, 6], |[x, y, z]| ((7 * x + 5 * y + 11 * z) % 6) as f64);
        let voxels = Voxels::new(lattice, DAffine3::IDENTITY, 0.3).unwrap();
        let bounds = Bounds::aligned_box(DVec3::ZERO, DVec3::splat(5.0)).unwrap();
        let directions = [dvec3(1.0, 0.35, 0.45), DVec3::ONE, DVec3::X, dvec3(1.0, -0.2, 0.0)];
        for direction in directions {
            let clip = bounds.clip(dvec3(-1.0, 2.0, 2.0), direction, None).unwrap().unwrap();
            let ray = Ray::new(&voxels, &clip);
            for i in 0..500 {
                let u = f64::from(i) / 500.0;
                let ours = Regular.sample(&ray, &mut Scripted::new([u])).distance();
                let other = Newton.sample(&ray, &mut Scripted::new([u])).distance();
                match (ours, other) {
                    (Some(ours), Some(other)) => assert!((ours - other).abs() < 1e-7, "{ours} {other}"),
                    (ours, other) => assert_eq!(ours, other),
                }
            }
        }
    }
}
