//! Closed forms against the integrals, equations and averages that they stand for.

use super::super::media::{analytic_cosine, voxels};
use super::super::specimen::SpecimenField;
use super::{Check, LAWFUL, check};
use fairflight_freeflight::{FreeFlight, Inversion, Newton, Regular};
use fairflight_laws::CheckResult;
use fairflight_laws::exact::orders::{self, mean_and_variance};
use fairflight_laws::exact::renewal::{self, Scoring, relative_variance};
use fairflight_laws::exact::thickness::{self, deviation_of_integral, deviation_of_inverse};
use fairflight_laws::exact::{agree, greatest};
use fairflight_media::{
    Bounded, Breakpoints, Constant, Majorant, OpticalThickness, PiecewiseConstant, PiecewiseLinear,
    RayQuadrature, Tolerance, adaptive_integral,
};
use fairflight_transmittance::{
    ClosedForm, Comb, CombShape, NextFlight, NextFlightVersion, Roulette, UnbiasedRayMarching, Unidirectional,
};
use glam::{DVec3, dvec3};

pub(super) fn checks() -> Vec<Check> {
    let seed_ray = || analytic_cosine(DVec3::ZERO, DVec3::Z);
    let mut checks = vec![
        integral("constant", constant()),
        integral("piecewise_constant", steps()),
        integral("piecewise_linear", tent()),
        integral("eq21_seed_ray", seed_ray()),
        integral("eq21_oblique_ray", analytic_cosine(dvec3(-9.0, 3.0, -4.0), dvec3(0.55, -0.2, 0.81))),
        integral("voxels", voxels()),
        inverse("inversion_flight", "inversion", "constant", constant(), Inversion),
        inverse("inversion_flight", "inversion", "piecewise_constant", steps(), Inversion),
        inverse("inversion_flight", "inversion", "piecewise_linear", tent(), Inversion),
        inverse("newton_flight", "newton", "piecewise_constant", steps(), Newton),
        inverse("newton_flight", "newton", "piecewise_linear", tent(), Newton),
        inverse("newton_flight", "newton", "eq21_seed_ray", seed_ray(), Newton),
        inverse("newton_flight", "newton", "voxels", voxels(), Newton),
        inverse("regular_flight", "regular", "piecewise_constant", steps(), Regular),
        inverse("regular_flight", "regular", "piecewise_linear", tent(), Regular),
        inverse("regular_flight", "regular", "voxels", voxels(), Regular),
    ];
    checks.push(variance("next flight", "ratio", Scoring::Ratio, NextFlight::new(NextFlightVersion::Ratio)));
    checks.push(variance("next flight", "delta", Scoring::Delta, NextFlight::new(NextFlightVersion::Delta)));
    checks.push(variance("unidirectional", "balance", Scoring::Unidirectional, Unidirectional));
    checks.push(
        check("mean of combs", "combs", "piecewise linear", mean_of_combs).about(["unbiased_ray_marching"]),
    );
    for stop in [0.2, 0.9] {
        let name = format!("orders of combs, stop {stop}");
        let orders = check(&name, "combs", "two cells", move || orders(stop));
        checks.push(orders.about(["unbiased_ray_marching"]));
    }
    checks
}

fn constant() -> Constant {
    Constant::new(0.7, 3.0).expect(LAWFUL)
}

fn steps() -> PiecewiseConstant {
    PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL)
}

fn tent() -> PiecewiseLinear {
    PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL)
}

fn integral<F: SpecimenField + OpticalThickness>(medium: &str, field: F) -> Check {
    check(&format!("optical thickness/{medium}"), "optical thickness", medium, move || {
        agree(deviation_of_integral(&field), thickness::GRANTED)
    })
}

fn inverse<F: SpecimenField + OpticalThickness, E: FreeFlight<F> + Send + Sync + 'static>(
    kind: &'static str,
    name: &str,
    medium: &str,
    field: F,
    sampler: E,
) -> Check {
    let words = format!("free flight by {name}");
    check(&format!("depth of {name}/{medium}"), &words, medium, move || {
        agree(deviation_of_inverse(&field, &sampler), thickness::GRANTED)
    })
    .about([kind])
}

/// The closed variance of an estimator that scores on the way, below and above the field, against its renewal equation.
fn variance<E>(kind: &str, name: &str, scoring: Scoring, estimator: E) -> Check
where
    E: Copy + Send + Sync + 'static,
    for<'f> E: ClosedForm<&'f Bounded<PiecewiseLinear>> + ClosedForm<&'f Bounded<PiecewiseConstant>>,
{
    check(&format!("variance of {kind}/{name}"), kind, "kinks and steps", move || {
        let tent = Bounded::new(tent(), 2.0).expect(LAWFUL);
        let steps = Bounded::new(steps(), 1.3).expect(LAWFUL);
        let deviations = [
            deviation_of_variance(&tent, scoring, estimator),
            deviation_of_variance(&steps, scoring, estimator),
        ];
        agree(greatest(deviations), renewal::GRANTED)
    })
    .about(["next_flight"])
}

fn deviation_of_variance<'f, F: OpticalThickness + Breakpoints + Majorant, E: ClosedForm<&'f F>>(
    field: &'f F,
    scoring: Scoring,
    estimator: E,
) -> f64 {
    let thickness = field.optical_thickness(0.0, field.length());
    let theory = estimator.theory(&mut RayQuadrature::new(field, &[]), thickness, Tolerance::TIGHT);
    (theory.relative_central[0] / relative_variance(field, scoring) - 1.0).abs()
}

/// **Law.** A comb of any shape has the optical thickness as its mean over the variate.
fn mean_of_combs() -> CheckResult {
    let (field, thickness) = (tent(), tent().optical_thickness(0.0, 3.0));
    let of = |(shape, teeth): (CombShape, u32)| {
        let comb = Comb::new(teeth, shape).expect(LAWFUL);
        let prepared = comb.prepare(&field, 0.0, 3.0);
        // Where a tooth stands on the kink at 1, or a difference would be taken across it: thirds of teeth for all of these.
        let breaks: Vec<f64> = match shape {
            CombShape::Periodised => {
                let t = 0.5 - ((1.0 - 2.0 / 3.0_f64).asin() / 3.0).sin();
                vec![(t * f64::from(teeth)).fract()]
            }
            _ => vec![(f64::from(teeth) / 3.0).fract()],
        };
        let mean =
            adaptive_integral(1.0, &breaks, Tolerance::TIGHT, |u| [comb.thickness(&field, &prepared, u)]);
        (mean.value[0] / thickness - 1.0).abs()
    };
    let cases = CombShape::ALL.into_iter().flat_map(|shape| [1, 4, 5].map(|teeth| (shape, teeth)));
    agree(greatest(cases.map(of)), thickness::GRANTED)
}

/// **Law.** Averaged over its orders and all that they draw, an estimate is the transmittance and has the variance of its theory.
fn orders(stop: f64) -> CheckResult {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.4, 0.8]).expect(LAWFUL);
    let comb = Comb::new(1, CombShape::Uniform).expect(LAWFUL);
    let estimator = UnbiasedRayMarching::new(comb, Roulette::new(stop).expect(LAWFUL));
    let thickness = field.optical_thickness(0.0, 2.0);
    let [mean, variance] = mean_and_variance(&estimator, &field, thickness);
    let theory = estimator.theory(&mut RayQuadrature::new(&field, &[]), thickness, Tolerance::TIGHT);
    let told = theory.relative_central[0];
    let holds = (mean - 1.0).abs() <= orders::MEAN_GRANTED
        && (variance / told - 1.0).abs() <= orders::VARIANCE_GRANTED;
    CheckResult {
        detectable_relative_bias: Some(orders::MEAN_GRANTED),
        ..CheckResult::exact(holds, format!("mean {mean}, variance {variance:.9} for {told:.9}"))
    }
}
