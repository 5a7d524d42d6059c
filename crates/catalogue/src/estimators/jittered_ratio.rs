//! Jittered ratio tracking, on one majorant and between bounds in cells.

use super::Kind;
use super::on_profile::estimator;
use super::in_cells::{Celled, add, minorant_thickness, on_all};
use crate::checks::{Check, LAWFUL, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::constant;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_freeflight::HIGHEST_MOMENT;
use fairflight_laws::lookups::{self, LookupLaw};
use fairflight_laws::scores;
use fairflight_media::{BoundCell, BoundedInCells, Bounded, Extinction, Majorant, OpticalThickness};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{JitteredRatio, JitteredRatioInCells};

pub(super) const KIND: Kind = Kind { name: "jittered_ratio", checks, twins, subjects, spared: &[(20, "its law is one of each stratum, of which there would be a million")] };

fn checks() -> Vec<Check> {
    on_all!(on)
}

fn on<F: SpecimenField + OpticalThickness>(specimen: &Celled<F>) -> Vec<Check> {
    let whole = |name: &str, epsilon: f64| {
        add(specimen, name, move |specimen, run| {
            let estimator = JitteredRatio::new(epsilon).expect(LAWFUL);
            let cell =
                BoundCell { to: specimen.field.length(), minorant: 0.0, majorant: specimen.field.majorant() };
            let lookups = in_strata(&[cell], epsilon);
            specimen.examine_in_lanes(&estimator, &[], |unit| scores::in_cells(0.0, unit), |_| lookups, run)
        })
    };
    let in_cells = |name: &str, epsilon: f64| {
        add(specimen, name, move |specimen, run| {
            let estimator = JitteredRatioInCells::new(epsilon).expect(LAWFUL);
            let main = minorant_thickness(&specimen.field);
            let lookups = in_strata(specimen.field.bound_cells(), epsilon);
            specimen.examine_in_lanes(&estimator, &[], |unit| scores::in_cells(main, unit), |_| lookups, run)
        })
    };
    let checks = [
        whole("jittered_ratio_1", 1.0),
        whole("jittered_ratio_0.3", 0.3),
        in_cells("jittered_ratio_in_cells_1", 1.0),
        in_cells("jittered_ratio_in_cells_0.25", 0.25),
    ];
    checks.map(|check| check.about([KIND.name])).into()
}

/// The look-ups of jittered ratio tracking: in each stratum of the optical thickness e the order N of its series, P(N ≥ k) =
/// e^(k − 1)/k!, k ≥ 1. Strata are as many in a cell as none is thicker than `epsilon`.
fn in_strata(cells: &[BoundCell], epsilon: f64) -> LookupLaw {
    let (mut whole, mut from) = ([0.0; HIGHEST_MOMENT], 0.0);
    for cell in cells {
        let thickness = cell.range() * (cell.to - std::mem::replace(&mut from, cell.to));
        if thickness <= 0.0 {
            continue;
        }
        let count = (thickness / epsilon).ceil().max(1.0);
        let stratum = order_moments(thickness / count);
        whole = (0..count as u64).fold(whole, |whole, _| lookups::sum(&whole, &stratum));
    }
    LookupLaw::Moments(whole)
}

/// E\[N^k\], k = 1 … 8, of the order of one stratum; for e ≤ 1 orders from 30 on have a probability below 1/30! = 4e-33.
fn order_moments(e: f64) -> [f64; HIGHEST_MOMENT] {
    let mut moments = [0.0; HIGHEST_MOMENT];
    let mut reached = 1.0;
    for order in 1..30 {
        let next = reached * e / f64::from(order + 1);
        for (i, moment) in moments.iter_mut().enumerate() {
            *moment += (reached - next) * f64::from(order).powi(i as i32 + 1);
        }
        reached = next;
    }
    moments
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("one majorant", above: false, below: false, |_| JitteredRatio::new(0.5).expect(LAWFUL))
            .tried_where(|profile| profile.depth() <= 3e3),
        estimator!("in cells", above: false, below: true, |_| JitteredRatioInCells::new(0.5).expect(LAWFUL))
            .tried_where(|profile| profile.depth_in_cells() <= 3e3),
    ]
}

/// Jittered ratio tracking with ε = 1 that continues to the k-th point with the probability ε/(k + 1).
struct ContinuesTooRarely;

impl<F: Majorant> Wrong<F> for ContinuesTooRarely {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let strata = (field.majorant() * field.length()).ceil();
        let width = field.length() / strata;
        let mut estimate = 1.0;
        for i in 0..strata as u32 {
            let (mut factor, mut term, mut order) = (1.0, -1.0, 1.0);
            loop {
                term *= width * field.sigma_t((f64::from(i) + source.next_uniform()) * width);
                factor += term;
                term = -term;
                order += 1.0;
                // right: 1/order, the order of the point to come
                if source.next_uniform() >= 1.0 / (order + 1.0) {
                    break;
                }
            }
            estimate *= factor;
        }
        estimate
    }
}

fn twins() -> Vec<Twin> {
    vec![
        // P(N ≥ k) = 2/(k + 1)! for 1/k!: a stratum has the expectation 1 − R + Σ_{k≥2} 2 (−R)^k/(k + 1)! = 2 (1 − e^−R)/R − 1 = 0.5739 for
        // 0.6065, four of them 0.1085 for 0.1353: a bias of −20 %, with Var/T² = 0.1468.
        Twin::new(
            "jittered ratio tracking",
            "jittered_ratio_continues_too_rarely",
            "the k-th point is drawn with the probability epsilon/(k + 1) for epsilon/k: the order counted from 0",
            "sigma_t 0.5, majorant 1, length 4, epsilon 1",
            (20_000, Evident::Mean { z: 73.3 }),
            |run| {
                // Four strata of the optical thickness 1 in the majorant and 1/2 in the field.
                let field = Bounded::new(constant(0.5, 4.0), 1.0).expect(LAWFUL);
                judged_as(&JitteredRatio::new(1.0).expect(LAWFUL), &ContinuesTooRarely, &field, run)
            },
        )
        .answers(|vector, source| {
            let field = vector.of(KIND.name).filter(|field| field.bound_cells().is_empty())?;
            (vector.estimator("epsilon")? == 1.0).then(|| ContinuesTooRarely.draw(&field, source).into())
        }),
    ]
}
