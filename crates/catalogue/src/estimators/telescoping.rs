//! Telescoping combs of geometric levels, without and with endpoint matching.

use super::Kind;
use super::on_profile::estimator;
use super::add;
use super::profiles::{rough_cells, seed_ray, signed, tent};
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_laws::lookups::LookupLaw;
use fairflight_media::{Extinction, PiecewiseLinear};
use fairflight_sources::UniformSource;
use fairflight_stats::Scores;
use fairflight_transmittance::{Comb, CombShape, Telescoping};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "telescoping", checks, twins, subjects, spared: &[] };

/// Samples of a quick run. The look-ups of geometric levels double with each: their skewness is infinite at the ratios in use, and no N
/// tests them. Combs that resolve their profile have next to no variance.
const LEVELS: u64 = 250_000;
const RESOLVED: u64 = 60_000;

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    checks.extend(on(&tent(), LEVELS, 2, Telescoping::matched_ratio(4.0)));
    // The difference of level k falls like 4^−k and is divided by its probability r (1 − r)^k: with r = 3/4 no level stands out, and
    // skewness and kurtosis exist. (With 0.9 they do not, and one estimate of a high level makes a run untestable.)
    checks.extend(on(&seed_ray(), RESOLVED, 20, 0.75));
    checks.extend(on(&signed(), 2 * LEVELS, 3, 0.75));
    checks.extend(on(&rough_cells(), LEVELS, 12, Telescoping::matched_ratio(2.0)));
    checks
}

fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>, samples: u64, teeth: u32, ratio: f64) -> [Check; 2] {
    [("telescoping", CombShape::Uniform), ("telescoping_matched", CombShape::EndpointMatched)].map(
        |(name, shape)| {
            let estimator = Telescoping::new(teeth, ratio, shape).expect(LAWFUL);
            add(specimen, name, Law::Transmittance, samples, move |specimen, run| {
                specimen.examine_in_lanes(&estimator, &[], |_| Scores::Unbounded, |_| LookupLaw::Unknown, run)
            })
            .about([KIND.name])
        },
    )
}

fn subjects() -> Vec<Subject> {
    vec![estimator!("telescoping", above: true, below: true, |_| {
        Telescoping::new(4, 0.8, CombShape::EndpointMatched).expect(LAWFUL)
    })]
}

/// Telescoping that subtracts only the even half of the finer comb.
struct EvenHalfOnly {
    comb: Comb,
    level_ratio: f64,
}

impl<F: Extinction> Wrong<F> for EvenHalfOnly {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let (mut level, mut probability) = (0, self.level_ratio);
        while source.next_uniform() >= self.level_ratio {
            level += 1;
            probability *= 1.0 - self.level_ratio;
        }
        let prepared = self.comb.prepare(field, 0.0, field.length());
        let (u, combs) = (source.next_uniform(), 1_u32 << level);
        let x: Vec<f64> = (0..combs)
            .map(|a| self.comb.thickness(field, &prepared, (f64::from(a) + u) / f64::from(combs)))
            .collect();
        let base = x.iter().map(|x| (-x).exp()).sum::<f64>() / f64::from(combs);
        if level == 0 {
            return base;
        }
        let all = x.iter().sum::<f64>() / f64::from(combs);
        let even = x.iter().step_by(2).sum::<f64>() / f64::from(combs / 2);
        base + ((-all).exp() - (-even).exp()) / probability // right: the mean of both halves
    }
}

fn twins() -> Vec<Twin> {
    vec![
        Twin::new(
            "telescoping",
            "level_without_its_odd_half",
            "a level's difference is taken from the even half of its comb alone, not from the mean of both halves (-9.6 %)",
            "sigma_t 0.1, 1.5, 0.2 at 0, 1, 3, two matched teeth, level ratio 0.65",
            (100_000, Evident::Mean { z: 114.0 }),
            |run| {
                let level_ratio = 0.65;
                let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
                let right = Telescoping::new(2, level_ratio, CombShape::EndpointMatched).expect(LAWFUL);
                judged_as(&right, &EvenHalfOnly { comb: right.comb(), level_ratio }, &tent, run)
            },
        )
        .answers(|vector, source| {
            let field = vector.of(KIND.name)?;
            let is_matched = vector.estimator("endpoint_matching")? == 1.0;
            let shape = if is_matched { CombShape::EndpointMatched } else { CombShape::Uniform };
            let comb = Comb::new(vector.estimator("teeth")? as u32, shape).ok()?;
            let level_ratio = vector.estimator("level_ratio")?;
            Some(EvenHalfOnly { comb, level_ratio }.draw(field, source).into())
        }),
    ]
}
