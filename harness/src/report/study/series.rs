//! The estimators that are swept: all parameters but the sampling extinction.

use super::Subject;
use crate::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, LineIntegralSpec, RayMarchingSpec, SamplingSpec,
    SingleParticleSpec, WoodcockSpec,
};
use crate::report::result::Series;
use fairflight_collision::{Albedo, Version};
use fairflight_transmittance::Offset;

/// Explorer points of the controls.
pub(super) const EXPLORERS: u32 = 16;
/// Flights per set of the line integral.
pub(super) const SPLITS: u32 = 8;
/// The albedos of the single particle model: it enters the variance of transmittance too.
const ALBEDOS: [f64; 3] = [0.0, 0.5, 0.9];

/// One estimator with a sampling extinction to be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) series: Series,
    pub(super) albedo: Option<Albedo>,
}

/// All swept estimators, in the order of the report.
pub(super) fn all() -> Vec<Entry> {
    let plain = |series| Entry { series, albedo: None };
    let mut entries = vec![
        plain(Series::Woodcock),
        plain(Series::DoubleParticle),
        plain(Series::DoubleParticleMean),
        plain(Series::DoubleParticleExplorers),
    ];
    for series in [Series::Terminating, Series::NonTerminating, Series::Adaptive] {
        let albedos = ALBEDOS.into_iter().filter_map(|albedo| Albedo::new(albedo).ok());
        entries.extend(albedos.map(|albedo| Entry { series, albedo: Some(albedo) }));
    }
    entries.extend([
        plain(Series::LineIntegral),
        plain(Series::RayMarching),
        plain(Series::JitteredRayMarching),
    ]);
    entries
}

impl Entry {
    /// The estimator at one sampling extinction \[1/length\]. Ray marching takes as many steps as tracking takes look-ups.
    pub(super) fn at(&self, subject: &Subject, sigma_samp: f64) -> EstimatorSpec {
        let double = |control| DoubleParticleSpec::at(sigma_samp, control).into();
        let single = |version| {
            EstimatorSpec::from(SingleParticleSpec {
                version,
                albedo: self.albedo.unwrap_or_default(),
                sigma_samp: SamplingSpec::Constant(sigma_samp),
                control: ControlSpec::none(),
            })
        };
        let marching = |offset| {
            let steps = (sigma_samp * subject.facts.length).round().max(1.0) as u32;
            RayMarchingSpec::at(steps, offset).into()
        };
        match self.series {
            Series::Woodcock => WoodcockSpec { majorant: sigma_samp }.into(),
            Series::DoubleParticle => double(ControlSpec::none()),
            Series::DoubleParticleMean => double(ControlSpec::constant(subject.facts.mean)),
            Series::DoubleParticleExplorers => double(ControlSpec::through(EXPLORERS)),
            Series::Terminating => single(Version::Terminating),
            Series::NonTerminating => single(Version::NonTerminating),
            Series::Adaptive => single(Version::Adaptive),
            Series::LineIntegral => LineIntegralSpec { majorant: sigma_samp, splits: SPLITS }.into(),
            Series::RayMarching => marching(Offset::Fixed),
            Series::JitteredRayMarching => marching(Offset::Jittered),
        }
    }

    /// Its name among all entries, for the streams of its points.
    pub(super) fn name(&self) -> String {
        match self.albedo {
            Some(albedo) => format!("{:?} of albedo {albedo}", self.series),
            None => format!("{:?}", self.series),
        }
    }

    /// The parameters in words.
    pub(super) fn parameters(&self) -> String {
        match (self.series, self.albedo) {
            (Series::Woodcock, _) => "majorant = sigma_samp".to_owned(),
            (Series::DoubleParticle, _) => "no control".to_owned(),
            (Series::DoubleParticleMean, _) => "control = mean of the ray (an oracle)".to_owned(),
            (Series::DoubleParticleExplorers, _) => format!("{EXPLORERS} explorers"),
            (Series::LineIntegral, _) => format!("{SPLITS} splits, majorant = sigma_samp"),
            (Series::RayMarching, _) => "midpoints of the steps, biased".to_owned(),
            (Series::JitteredRayMarching, _) => "one random offset, biased".to_owned(),
            (_, Some(albedo)) => format!("albedo {albedo}"),
            (_, None) => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_not_shared() {
        let mut names: Vec<String> = all().iter().map(Entry::name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all().len());
    }
}
