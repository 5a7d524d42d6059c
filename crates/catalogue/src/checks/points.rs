//! Ratio tracking driven by point sets: each replica is one sample, and only replicas are judged.

use super::media::LAWFUL;
use super::{Check, Law};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::{CheckResult, Run, measure};
use fairflight_media::{Constant, OpticalThickness, PiecewiseLinear, Vacuum};
use fairflight_sources::{
    Halton, Hammersley, LatinHypercube, PointSet, PointSetError, Seeded, Sobol, UniformSource, derive_seed,
};
use fairflight_stats::{Reference, Scores, judge};
use fairflight_transmittance::{Tracking, TransmittanceEstimator};

/// Estimates of one replica: a power of two, for nets.
const POINTS: u64 = 32;

/// Coordinates that a set orders; a walk draws about two.
const DIMENSIONS: usize = 6;

/// Replicas of a quick run.
const REPLICAS: u64 = 20_000;

/// All checks of point sets.
pub(super) fn checks() -> Vec<Check> {
    vec![
        check("sobol", |seed| Sobol::new(DIMENSIONS, seed)),
        check("halton", |seed| Halton::new(DIMENSIONS, seed)),
        check("hammersley", |seed| Hammersley::new(POINTS, DIMENSIONS, seed)),
        check("latin_hypercube", |seed| LatinHypercube::new(POINTS, DIMENSIONS, seed)),
    ]
}

fn check<P: PointSet>(
    name: &'static str,
    set: impl Fn(u64) -> Result<P, PointSetError> + Send + Sync + 'static,
) -> Check {
    let words = format!("ratio_tracking by {} points", name.replace('_', " "));
    Check::new(
        format!("points/{name}"),
        Law::Transmittance,
        words,
        "piecewise linear",
        REPLICAS,
        move |run| {
            let field = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.1, 0.5, 0.2]).expect(LAWFUL);
            let (control, sampling) = (Vacuum::new(2.0), Constant::new(0.5, 2.0).expect(LAWFUL));
            let tracking = Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling);
            let exact = Reference {
                // Weights of ratio tracking with a majorant, and so their means, lie in [0, 1].
                scores: Scores::Bounded { minimum: 0.0, maximum: 1.0 },
                ..Reference::exact((-field.optical_thickness(0.0, 2.0)).exp())
            };
            let estimate = |mut source: &mut dyn UniformSource| tracking.estimate(&field, &mut source);
            match measure(run.seed, run.samples, |source| {
                let seed = replica_seed(run, source);
                replica(&set(seed).expect(LAWFUL), POINTS, estimate)
            }) {
                Ok(moments) => CheckResult::of_verdict(&judge(&moments, &exact, run.alpha), run.samples),
                Err(error) => CheckResult::exact(false, error.to_string()),
            }
        },
    )
    .about(["double_particle"])
}

/// A seed for the next replica of a run.
fn replica_seed(run: Run, source: &mut Seeded) -> u64 {
    derive_seed(run.seed, (source.next_uniform() * (1_u64 << 53) as f64) as u64)
}

/// The mean over the points of one replica.
fn replica(set: &impl PointSet, points: u64, estimate: impl Fn(&mut dyn UniformSource) -> f64) -> f64 {
    (0..points).map(|index| estimate(&mut set.source(index))).sum::<f64>() / points as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Extinction, RayQuadrature, Tolerance};
    use fairflight_transmittance::ClosedForm;

    const REPLICAS: u64 = 400;

    fn variance(points: u64, mut estimate: impl FnMut(u64) -> f64) -> f64 {
        let run = Run { samples: REPLICAS, seed: 11, alpha: 1e-6 };
        let moments = measure(run.seed, REPLICAS, |source| estimate(replica_seed(run, source))).unwrap();
        moments.sample_variance().unwrap() * points as f64
    }

    /// A comb of 4 teeth draws one variate and is smooth in it: n = 64 points of any set take its variance down by the rate n of a
    /// shared offset at least. (By 1/64 for the ideal of a function that is linear; a factor of four is granted.)
    #[test]
    fn a_comb_gains_the_rate() {
        let field = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.1, 0.5, 0.2]).unwrap();
        let comb = |source: &mut dyn UniformSource| {
            let shift = source.next_uniform();
            let sum: f64 = (0..4).map(|tooth| field.sigma_t(0.5 * (f64::from(tooth) + shift))).sum();
            (-0.5 * sum).exp()
        };
        let independent = variance(64, |seed| {
            let mut source = Seeded::new(seed);
            (0..64).map(|_| comb(&mut source)).sum::<f64>() / 64.0
        });
        for (name, measured) in [
            ("sobol", variance(64, |seed| replica(&Sobol::new(1, seed).unwrap(), 64, comb))),
            ("halton", variance(64, |seed| replica(&Halton::new(1, seed).unwrap(), 64, comb))),
            ("hammersley", variance(64, |seed| replica(&Hammersley::new(64, 1, seed).unwrap(), 64, comb))),
            ("latin", variance(64, |seed| replica(&LatinHypercube::new(64, 1, seed).unwrap(), 64, comb))),
        ] {
            assert!(measured < independent / 16.0, "{name}: {measured:e} for {independent:e}");
        }
    }

    /// Ratio tracking decides how many variates it draws, and jumps where that number does. What there is to gain is in the first
    /// coordinates; no rate is claimed, only that nothing is lost beyond what the sample shows (chi-square of 399 degrees of
    /// freedom: 1.35 at a level of 1e-5). Measured with one collision for a walk: 0.01 to 0.08 of the variance of independent points.
    #[test]
    fn ratio_tracking_loses_nothing() {
        let field = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.1, 0.5, 0.2]).unwrap();
        let (control, sampling) = (Vacuum::new(2.0), Constant::new(0.5, 2.0).unwrap());
        let tracking = Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling);
        let mut quadrature = RayQuadrature::new(&field, &[]);
        let theory = tracking.theory(&mut quadrature, 0.65, Tolerance::TIGHT);
        let independent = theory.relative_central[0] * (-1.3_f64).exp();
        let estimate = |mut source: &mut dyn UniformSource| tracking.estimate(&field, &mut source);
        for (name, measured) in [
            ("sobol", variance(64, |seed| replica(&Sobol::new(6, seed).unwrap(), 64, estimate))),
            ("halton", variance(64, |seed| replica(&Halton::new(6, seed).unwrap(), 64, estimate))),
            (
                "hammersley",
                variance(64, |seed| replica(&Hammersley::new(64, 6, seed).unwrap(), 64, estimate)),
            ),
            ("latin", variance(64, |seed| replica(&LatinHypercube::new(64, 6, seed).unwrap(), 64, estimate))),
        ] {
            assert!(measured < 1.35 * independent, "{name}: {measured:e} for {independent:e}");
        }
    }
}
