//! The law of a phase function: normalised, its mean cosine, and drawn as it is evaluated.

use crate::{CheckResult, PValue, Run, batch_count, batch_size};
use fairflight_media::{PhaseFunction, Tolerance, adaptive_integral};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::{GoodnessOfFit, chi_square};
use glam::{DVec3, dvec3};
use std::f64::consts::{PI, TAU};

/// Cells of the cosine, about equally probable, and of the azimuth.
const CELLS: u32 = 20;

/// Greatest error of a probability by quadrature to 1e-12 and by the rounding of a cosine. A peak whose density is P per unit of
/// cosine turns a rounding of 1e-16 into 1e-16 P: peaks up to 1e5 are told from mistakes.
const TOLERANCE: f64 = 1e-10;

/// Directions of travel that differ in the branch of the frame.
const INCIDENT: [DVec3; 4] =
    [DVec3::Z, DVec3::NEG_Z, dvec3(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0), dvec3(-0.36, 0.48, -0.8)];

/// Violation of the law of a phase function, told without sampling.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Broken {
    /// The integral over the sphere is not 1, or eval is negative or no number.
    #[error("it integrates to {found}, not 1, over the sphere")]
    Normalisation {
        /// The integral.
        found: f64,
    },
    /// The stated mean cosine is not the integral.
    #[error("the mean cosine is stated as {found} and integrates to {expected}")]
    MeanCosine {
        /// The stated mean cosine.
        found: f64,
        /// The integral.
        expected: f64,
    },
    /// A cosine outside \[-1, 1\], or one that does not solve the distribution.
    #[error("u = {u} gives the cosine {cosine}, at which the distribution is {found}")]
    Inversion {
        /// The variate.
        u: f64,
        /// The cosine.
        cosine: f64,
        /// The probability up to it.
        found: f64,
    },
    /// A drawn direction is not at the angle of its cosine, or not of unit length.
    #[error("u = {u} gives the cosine {expected} and a direction at the cosine {found}")]
    Direction {
        /// The variate.
        u: f64,
        /// The scalar product of the directions.
        found: f64,
        /// The cosine.
        expected: f64,
    },
    /// The stated density, or weight times density, of a drawn direction is not the phase function there.
    #[error("at the cosine {cosine} the density is {found}, eval {expected}")]
    Density {
        /// The scalar product of the directions.
        cosine: f64,
        /// The density.
        found: f64,
        /// The phase function.
        expected: f64,
    },
}

/// The outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// Test of the cosines of the drawn directions; detectable is a relative deviation of the probability of one cell.
    pub cosine: GoodnessOfFit,
    /// Test of the azimuths of the drawn directions about the direction of travel before.
    pub azimuth: GoodnessOfFit,
    /// (mean cosine drawn - stated)/standard error; told, not judged: the cells say more. `None` for no samples.
    pub mean_z: Option<f64>,
}

impl Evidence {
    /// True if both laws hold; `None` if none is broken and one is not testable.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        match (self.cosine.sound, self.azimuth.sound) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        }
    }

    /// The result for a table.
    #[must_use]
    pub fn result(&self, samples: u64) -> CheckResult {
        CheckResult {
            holds: self.holds(),
            samples,
            mean_z: self.mean_z,
            p_values: [("cosine", &self.cosine), ("azimuth", &self.azimuth)]
                .into_iter()
                .filter_map(|(name, fit)| PValue::of_fit(fit, name))
                .collect(),
            detectable_relative_bias: self
                .cosine
                .detectable
                .zip(self.azimuth.detectable)
                .map(|(a, b)| a.max(b)),
            reason: format!("cosine {}; azimuth {}", self.cosine.reason, self.azimuth.reason),
            ..CheckResult::default()
        }
    }
}

/// Checks everything: [`check_exactly`], then [`check_samples`].
///
/// # Errors
/// If the law is broken without sampling.
pub fn check(phase: &impl PhaseFunction, run: Run) -> Result<Evidence, Broken> {
    check_exactly(phase)?;
    Ok(check_samples(phase, run))
}

/// Checks that the phase function integrates to 1 and its mean cosine is the integral; that `sample_cosine` inverts the
/// integral of `eval`; and that `sample` turns by that angle, with `eval` as its density. So the phase function depends on
/// the angle alone, which is reciprocity.
///
/// # Errors
/// At the first that does not hold.
pub fn check_exactly(phase: &impl PhaseFunction) -> Result<(), Broken> {
    let [one, mean, _] = moments(phase, -1.0, 1.0);
    // No number agrees with none.
    let agree = |found: f64, expected: f64| (found - expected).abs() <= TOLERANCE;
    let is_nowhere_negative = (0..=1000).all(|i| phase.eval(f64::from(i) / 500.0 - 1.0) >= 0.0);
    if !is_nowhere_negative || !agree(one, 1.0) {
        return Err(Broken::Normalisation { found: one });
    }
    if !agree(mean, phase.mean_cosine()) {
        return Err(Broken::MeanCosine { found: phase.mean_cosine(), expected: mean });
    }
    // Increasing or decreasing in u.
    let decreases = phase.sample_cosine(0.25) > phase.sample_cosine(0.75);
    let (mut from, mut below) = (-1.0, 0.0);
    for i in 0..CELLS {
        let u = f64::from(if decreases { CELLS - i } else { i }) / f64::from(CELLS);
        let u = u.min(fairflight_sources::LARGEST_VARIATE);
        let (cosine, expected) = (phase.sample_cosine(u), if decreases { 1.0 - u } else { u });
        if !(-1.0..=1.0).contains(&cosine) {
            return Err(Broken::Inversion { u, cosine, found: f64::NAN });
        }
        below += moments(phase, from, cosine)[0];
        from = cosine;
        if !agree(below, expected) {
            return Err(Broken::Inversion { u, cosine, found: below });
        }
        for (incident, j) in INCIDENT.into_iter().flat_map(|incident| (0..8).map(move |j| (incident, j))) {
            let scattered = phase.sample(incident, u, f64::from(j) / 8.0);
            let found = scattered.direction.dot(incident);
            let is_unit = (scattered.direction.length() - 1.0).abs() < 1e-14;
            let is_turned = (found - cosine).abs() < 1e-14;
            if !is_unit || !is_turned {
                return Err(Broken::Direction { u, found, expected: cosine });
            }
            let expected = phase.eval(found);
            let close = |x: f64| (x - expected).abs() <= TOLERANCE * (1.0 + expected);
            if !close(scattered.pdf_solid_angle) || !close(scattered.weight * scattered.pdf_solid_angle) {
                return Err(Broken::Density { cosine: found, found: scattered.pdf_solid_angle, expected });
            }
        }
    }
    Ok(())
}

/// Draws directions and tests their cosines against the integral of `eval` over cells, and their azimuths against the
/// uniform law, each with half of the false alarm.
///
/// The cells end at `sample_cosine(i/20)`. Their probabilities are integrated, whatever that function returns: a wrong one
/// makes cells of unequal probability, not a wrong test.
pub fn check_samples(phase: &impl PhaseFunction, run: Run) -> Evidence {
    let mut edges: Vec<f64> =
        (1..CELLS).map(|i| phase.sample_cosine(f64::from(i) / f64::from(CELLS)).clamp(-1.0, 1.0)).collect();
    edges.sort_by(f64::total_cmp);
    let probabilities: Vec<f64> = std::iter::once(-1.0)
        .chain(edges.iter().copied())
        .zip(edges.iter().copied().chain([1.0]))
        .map(|(from, to)| moments(phase, from, to)[0])
        .collect();
    let mut cosines = vec![0; CELLS as usize];
    let mut azimuths = vec![0; CELLS as usize];
    let mut sum = 0.0;
    for batch in 0..batch_count(run.samples) {
        let mut source = Seeded::for_batch(run.seed, batch);
        let incident = INCIDENT[batch as usize % INCIDENT.len()];
        let (x, y) = incident.any_orthonormal_pair();
        for _ in 0..batch_size(run.samples, batch) {
            let (u, v) = (source.next_uniform(), source.next_uniform());
            let direction = phase.sample(incident, u, v).direction;
            let cosine = direction.dot(incident);
            sum += cosine;
            cosines[edges.partition_point(|&edge| edge <= cosine)] += 1;
            let turn = (direction.dot(y).atan2(direction.dot(x)) + PI) / TAU;
            azimuths[((turn * f64::from(CELLS)) as usize).min(CELLS as usize - 1)] += 1;
        }
    }
    let [_, mean, square] = moments(phase, -1.0, 1.0);
    let n = run.samples as f64;
    Evidence {
        cosine: chi_square(&cosines, &probabilities, 0.5 * run.alpha),
        azimuth: chi_square(&azimuths, &[1.0 / f64::from(CELLS); CELLS as usize], 0.5 * run.alpha),
        mean_z: (run.samples > 0).then(|| (sum / n - mean) / ((square - mean * mean) / n).sqrt()),
    }
}

/// 2π ∫ eval · (1, μ, μ²) over cosines, by quadrature.
fn moments(phase: &impl PhaseFunction, from: f64, to: f64) -> [f64; 3] {
    if from >= to {
        return [0.0; 3];
    }
    adaptive_integral(to - from, &[], Tolerance::TIGHT, |s| {
        let (cosine, density) = (from + s, TAU * phase.eval(from + s));
        [density, density * cosine, density * cosine * cosine]
    })
    .value
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::{HenyeyGreenstein, Isotropic};

    /// Half of the sphere missing, half as bright, or of the wrong mean.
    struct Wrong {
        factor: f64,
        mean_cosine: f64,
    }

    impl PhaseFunction for Wrong {
        fn eval(&self, _cosine: f64) -> f64 {
            self.factor / (4.0 * PI)
        }
        fn sample_cosine(&self, u: f64) -> f64 {
            2.0 * u - 1.0
        }
        fn mean_cosine(&self) -> f64 {
            self.mean_cosine
        }
    }

    #[test]
    fn each_part_of_the_law_can_be_broken() {
        assert_eq!(check_exactly(&Wrong { factor: 1.0, mean_cosine: 0.0 }), Ok(()));
        let halved = check_exactly(&Wrong { factor: 0.5, mean_cosine: 0.0 });
        assert!(matches!(halved, Err(Broken::Normalisation { .. })));
        let not_a_number = check_exactly(&Wrong { factor: f64::NAN, mean_cosine: 0.0 });
        assert!(matches!(not_a_number, Err(Broken::Normalisation { .. })));
        let shifted = check_exactly(&Wrong { factor: 1.0, mean_cosine: 1e-6 });
        assert!(matches!(shifted, Err(Broken::MeanCosine { .. })));
    }

    /// Isotropic, drawn over a part of its variates.
    struct Part {
        u: f64,
        v: f64,
    }

    impl PhaseFunction for Part {
        fn eval(&self, cosine: f64) -> f64 {
            Isotropic.eval(cosine)
        }
        fn sample_cosine(&self, u: f64) -> f64 {
            Isotropic.sample_cosine(u)
        }
        fn mean_cosine(&self) -> f64 {
            0.0
        }
        fn sample(&self, incident: DVec3, u: f64, v: f64) -> fairflight_media::Scattered {
            Isotropic.sample(incident, self.u * u, self.v * v)
        }
    }

    #[test]
    fn samples_of_a_part_of_the_sphere_are_rejected() {
        let run = Run { samples: 400_000, seed: 1, alpha: 1e-9 };
        let verdict = |u, v| {
            let evidence = check_samples(&Part { u, v }, run);
            (evidence.cosine.sound, evidence.azimuth.sound)
        };
        assert_eq!(verdict(1.0, 1.0), (Some(true), Some(true)));
        assert_eq!(verdict(0.98, 1.0), (Some(false), Some(true)));
        assert_eq!(verdict(1.0, 0.98), (Some(true), Some(false)));
        assert!(matches!(check_exactly(&Part { u: 0.98, v: 1.0 }), Err(Broken::Direction { .. })));
    }

    #[test]
    fn few_samples_are_not_testable() {
        let run = Run { samples: 1000, seed: 1, alpha: 1e-9 };
        let phase = HenyeyGreenstein::new(0.5).unwrap();
        assert_eq!(check(&phase, run).unwrap().holds(), None);
    }
}
