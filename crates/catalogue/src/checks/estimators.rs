//! The estimators that every medium is tried with, their parameters taken from the medium's bounds.

use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::scores::Ranged;
use fairflight_media::{
    Breakpoints, Constant, FieldError, InvertOpticalThickness, OpticalThickness, PiecewiseConstant,
    PiecewiseLinear, Vacuum,
};
use fairflight_transmittance::{Explorers, Offset, RayMarching, Tracking};
use std::sync::Arc;

/// Samples of a quick run, of walks whose laws are known in full: more where closed moments ask for them.
const SURVIVING: u64 = 80_000;
pub(super) const ENDING: u64 = 160_000;
/// Flights of a line integral of several, whose look-ups have a skewed law of which only the mean is known.
const SPLIT: u64 = 800_000;

/// A control and a sampling extinction.
type Tracker<C, R> = Tracking<DoubleParticle, C, R>;

/// The double particle model; the albedo does not enter transmittance.
fn double_particle<C: OpticalThickness, R: InvertOpticalThickness>(control: C, sampling: R) -> Tracker<C, R> {
    Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling)
}

/// The estimators that admit values of any sign, their sampling extinctions multiples of `majorant`; `mean` is a rough
/// middle of the field. Weights above 1 are unbounded scores, which only a mild law makes testable: hence the larger
/// sampling extinctions beside a control.
pub(super) fn of_any_sign<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    majorant: f64,
    mean: f64,
    explorers: usize,
) -> Vec<Check> {
    let length = specimen.field.length();
    let constant = move |sigma: f64| Constant::new(sigma, length);
    vec![
        tracking(specimen, "ratio_tracking", move |_| {
            Ok(double_particle(Vacuum::new(length), constant(majorant)?))
        }),
        tracking(specimen, "below_the_extinction", move |_| {
            Ok(double_particle(Vacuum::new(length), constant(0.7 * majorant)?))
        }),
        tracking(specimen, "residual_constant_control", move |_| {
            Ok(double_particle(constant(mean)?, constant(2.0 * majorant)?))
        }),
        tracking(specimen, "negative_difference", move |_| {
            Ok(double_particle(constant(2.0 * mean)?, constant(4.0 * majorant)?))
        }),
        tracking(specimen, "piecewise_sampling", move |_| {
            let edges = vec![0.0, 0.4 * length, length];
            let sampling = PiecewiseConstant::new(edges, vec![1.2 * majorant, 0.8 * majorant])?;
            Ok(double_particle(Vacuum::new(length), sampling))
        }),
        tracking(specimen, "piecewise_linear_control", move |_| {
            let nodes = vec![0.0, 0.3 * length, length];
            let control = PiecewiseLinear::new(nodes, vec![0.5 * mean, 1.2 * mean, 0.8 * mean])?;
            Ok(double_particle(control, constant(2.0 * majorant)?))
        }),
        tracking(specimen, "explorers", move |field: &F| {
            let Ok(control) = Explorers::through(field, explorers) else {
                return Err(FieldError::TooFew { what: "explorers", least: 2, found: explorers });
            };
            Ok(double_particle(control, constant(majorant)?))
        }),
        marching(specimen, "ray_marching_fixed", Offset::Fixed),
    ]
}

/// The baseline with a random offset, whose own law is an integral over the offset: cheap where the field has few cells.
pub(super) fn jittered<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    marching(specimen, "ray_marching_jittered", Offset::Jittered)
}

/// The estimators that need 0 ≤ σ_t ≤ the field's own majorant, the line integral with each of `splits`.
pub(super) fn of_positive<F: SpecimenField>(specimen: &Arc<Specimen<F>>, splits: &[u32]) -> Vec<Check> {
    let mut checks =
        vec![add(specimen, "woodcock", Law::Transmittance, ENDING, Specimen::woodcock).about(["woodcock"])];
    for &splits in splits {
        let name = format!("line_integral_{splits}");
        // The look-ups of n flights are less skewed than those of one.
        let samples = if splits == 1 { ENDING } else { SPLIT / u64::from(splits) };
        let check = add(specimen, &name, Law::Transmittance, samples, move |specimen, run| {
            specimen.line_integral(splits, run)
        });
        checks.push(check.about(["line_integral"]));
    }
    checks
}

/// A double particle walk built from the field when it is run.
fn tracking<F, C, R>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    build: impl Fn(&F) -> Result<Tracker<C, R>, FieldError> + Send + Sync + 'static,
) -> Check
where
    F: SpecimenField,
    C: OpticalThickness + Breakpoints + Ranged,
    R: InvertOpticalThickness + Breakpoints + Ranged,
{
    add(specimen, name, Law::Transmittance, SURVIVING, move |specimen, run| match build(&specimen.field) {
        Ok(tracking) => specimen.tracking(&tracking, run),
        Err(error) => fairflight_laws::CheckResult::exact(false, format!("refused: {error}")),
    })
    .about(["double_particle"])
}

fn marching<F: SpecimenField>(specimen: &Arc<Specimen<F>>, name: &str, offset: Offset) -> Check {
    const STEPS: u32 = 8;
    add(specimen, name, Law::OwnExpectation, SURVIVING, move |specimen, run| {
        match RayMarching::new(STEPS, offset) {
            Ok(estimator) => specimen.ray_marching(&estimator, run),
            Err(error) => fairflight_laws::CheckResult::exact(false, format!("refused: {error}")),
        }
    })
    .about(match offset {
        Offset::Fixed => vec!["ray_marching"],
        // One comb with a random shift, by its other name.
        Offset::Jittered => vec!["ray_marching", "naive"],
    })
}

/// A check named after its medium and its estimator.
pub(super) fn add<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    law: Law,
    samples: u64,
    run: impl Fn(&Specimen<F>, fairflight_laws::Run) -> fairflight_laws::CheckResult + Send + Sync + 'static,
) -> Check {
    let (id, medium) = (format!("{}/{name}", specimen.name), specimen.name);
    let samples = samples / specimen.frugality;
    let specimen = Arc::clone(specimen);
    Check::new(id, law, name.replace('_', " "), medium.replace('_', " "), samples, move |arguments| {
        run(&specimen, arguments)
    })
}
