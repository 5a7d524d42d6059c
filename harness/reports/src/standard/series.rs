//! The estimators that are swept: all parameters but the sampling extinction.

use super::Subject;
use super::laws::SharedLaws;
use super::result::Series;
use fairflight_collision::{Albedo, Version};
use fairflight_harness::Failure;
use fairflight_harness::comparison::{Entrant, Facts, entrants};
use fairflight_harness::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, LineIntegralSpec, RayMarchingSpec, SamplingSpec,
    SingleParticleSpec, WoodcockSpec,
};
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_transmittance::Offset;

/// Explorer points of the controls.
pub(super) const EXPLORERS: u32 = 16;
/// Flights per set of the line integral.
pub(super) const SPLITS: u32 = 8;
/// The albedos of the single particle model: it enters the variance of transmittance too.
const ALBEDOS: [f64; 3] = [0.0, 0.5, 0.9];

/// One estimator with a sampling extinction to be chosen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) series: Series,
    pub(super) albedo: Option<Albedo>,
    /// The entrant of the comparison, where it is not of the papers that this report measures again.
    pub(super) entrant: Option<Entrant>,
}

/// All swept estimators, in the order of the report: those of the papers, and what else claims a majorant and has a closed form.
pub(super) fn all(subject: &Subject, laws: &SharedLaws) -> Result<Vec<Entry>, Failure> {
    let mut entries = of_the_papers();
    let others: Vec<Entrant> = entrants()
        .into_iter()
        .filter(|entrant| matches!(Series::of(entrant.name), Series::Entrant(_)))
        // What a choice claims depends on what it chose.
        .filter(|entrant| entrant.hybrid(&subject.ray(subject.majorant), &Facts::default()).is_none())
        .collect();
    let swept = try_in_parallel(others.len(), &|i| {
        let entry = Entry { series: Series::of(others[i].name), albedo: None, entrant: Some(others[i]) };
        let Ok(plan) = Plan::on(subject.profile.clone(), entry.at(subject, subject.majorant), 0, 0) else {
            return Ok(None);
        };
        if plan.estimator.claimed_majorant.is_none() {
            return Ok(None);
        }
        let law = laws.law(subject, &plan.estimator)?;
        Ok(law.filter(|law| !law.theory.log_relative_variance.is_nan()).map(|_| entry))
    })?;
    entries.extend(swept.into_iter().flatten());
    Ok(entries)
}

/// The estimators of the papers that this report measures again.
pub(super) fn of_the_papers() -> Vec<Entry> {
    let plain = Entry::plain;
    let mut entries = vec![
        plain(Series::Woodcock),
        plain(Series::DoubleParticle),
        plain(Series::DoubleParticleMean),
        plain(Series::DoubleParticleExplorers),
    ];
    for series in [Series::Terminating, Series::NonTerminating, Series::Adaptive] {
        let albedos = ALBEDOS.into_iter().filter_map(|albedo| Albedo::new(albedo).ok());
        entries.extend(albedos.map(|albedo| Entry { albedo: Some(albedo), ..plain(series) }));
    }
    entries.extend([
        plain(Series::LineIntegral),
        plain(Series::RayMarching),
        plain(Series::JitteredRayMarching),
    ]);
    entries
}

impl Entry {
    /// An estimator of the papers.
    pub(super) fn plain(series: Series) -> Self {
        Self { series, albedo: None, entrant: None }
    }

    /// True of an estimator of the papers.
    pub(super) fn is_of_the_papers(&self) -> bool {
        self.entrant.is_none()
    }

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
        if let Some(spec) = self.entrant.and_then(|it| it.spec(&subject.ray(sigma_samp), &Facts::default())) {
            return spec;
        }
        match self.series {
            Series::Entrant(_) | Series::Woodcock => WoodcockSpec { majorant: sigma_samp }.into(),
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
            (Series::Woodcock | Series::Entrant(_), _) => "majorant = sigma_samp".to_owned(),
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
    use crate::standard::subject;
    use fairflight_harness::field::MediumLibrary;

    #[test]
    fn names_are_not_shared_and_what_claims_a_majorant_is_swept() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        let all = all(&subject, &SharedLaws::of(&subject)).unwrap();
        let mut names: Vec<String> = all.iter().map(Entry::name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        let others: Vec<&str> = all[of_the_papers().len()..].iter().map(|it| it.series.label()).collect();
        for name in ["next-flight delta", "unidirectional", "adaptive ratio", "jittered ratio, 0.25"] {
            assert!(others.contains(&name), "{others:?}");
        }
        assert!(!others.contains(&"telescoping") && !others.contains(&"hybrid"), "{others:?}");
    }
}
