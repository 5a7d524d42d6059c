//! Lessons of stages of replicas for later ones.

use super::replicas::{Replica, mean_and_variance};
use crate::Failure;
use crate::plan::{Learning, Lesson, SIZES};
use fairflight_metropolis::{Importance, ImportanceRule, Kernels};
use fairflight_scene::Spectrum;
use fairflight_sources::SmallStep;

/// What replicas of a stage are taught: an importance for all, and sizes of steps for each of two halves, which are told apart by their numbers.
///
/// **Law.** Each replica is unbiased whatever it was taught by others, since its own starts and brightness come from its own target. Replicas of a later stage
/// are no longer independent of earlier ones, but uncorrelated: the mean of each given what it was taught is the image. So the variance among all
/// is that of their mean.
pub(super) struct Lessons {
    importance: Option<(Importance, ImportanceRule)>,
    kernels: Option<[Kernels; 2]>,
}

impl Lessons {
    /// Nothing learnt yet.
    pub(super) fn first(learning: Learning, step: SmallStep, resolution: [u32; 2]) -> Result<Self, Failure> {
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("integrator: {error}"));
        let importance = learning.importance.map(|(_, rule)| {
            Importance::even(resolution).map(|even| (even, rule)).map_err(|error| refuse(&error))
        });
        let kernels = learning.adapts.then(|| {
            let even = Kernels::parting(step, SIZES, resolution).map_err(|error| refuse(&error))?;
            Ok([even.clone(), even])
        });
        Ok(Self { importance: importance.transpose()?, kernels: kernels.transpose()? })
    }

    /// Those for a replica.
    pub(super) fn of(&self, index: u32) -> Lesson<'_> {
        let kernels = self.kernels.as_ref().map(|halves| &halves[index as usize % 2]);
        Lesson { importance: self.importance.as_ref().map(|(map, _)| map), kernels }
    }

    /// Those for the next stage, taught by the replicas of this one: of an importance by all, of sizes by the other half.
    pub(super) fn next<C: Spectrum>(self, made: &[Replica<C>]) -> Result<Self, Failure> {
        let Self { mut importance, mut kernels } = self;
        if let Some((importance, rule)) = importance.as_mut().filter(|_| made.len() > 1) {
            let (means, variances): (Vec<f64>, Vec<f64>) = mean_and_variance(made)
                .map(|(mean, variance)| (mean.magnitude(), variance.magnitude()))
                .unzip();
            let learnt = importance.learn(rule, &means, &variances);
            *importance = learnt.map_err(|error| Failure::refused(format!("integrator: {error}")))?;
        }
        if let Some(halves) = &mut kernels {
            for (half, taught) in halves.iter_mut().enumerate() {
                let mut seen = taught.experience();
                let others = made.iter().filter(|replica| replica.number as usize % 2 != half);
                others.filter_map(|replica| replica.experience.as_ref()).for_each(|other| seen.merge(other));
                *taught = taught.learn(&seen);
            }
        }
        Ok(Self { importance, kernels })
    }
}
