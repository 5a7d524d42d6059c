//! Ratio tracking and residual ratio tracking: the double particle model with any control and sampling extinction.

mod control;
mod logarithm;
mod sampling;
mod variance;
mod weights;

use super::Kind;
use super::on_profile::estimator;
use super::add;
use crate::checks::{Check, Law, Specimen, SpecimenField};
use crate::function::joined;
use crate::hard_cases::Subject;
use crate::twins::Twin;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::CheckResult;
use fairflight_laws::scores::Ranged;
use fairflight_media::{
    Breakpoints, Constant, Extinction, FieldError, InvertOpticalThickness, OpticalThickness, PiecewiseConstant,
    PiecewiseLinear, Vacuum,
};
use fairflight_transmittance::{Explorers, Tracking};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "double_particle", checks: Vec::new, twins, subjects, spared: &[] };

/// Samples of a quick run of walks whose laws are known in full: more where closed moments ask for them.
const SURVIVING: u64 = 80_000;

/// A control and a sampling extinction.
type Tracker<C, R> = Tracking<DoubleParticle, C, R>;

/// The double particle model; the albedo does not enter transmittance.
fn double_particle<C: OpticalThickness, R: InvertOpticalThickness>(control: C, sampling: R) -> Tracker<C, R> {
    Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling)
}

/// The law on a medium of any sign, with sampling extinctions that are multiples of `majorant`; `mean` is a rough middle of the field.
/// Weights above 1 are unbounded scores, which only a mild law makes testable: hence the larger sampling extinctions beside a control.
pub(crate) fn on<F: SpecimenField>(
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
    ]
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
        Err(error) => CheckResult::exact(false, format!("refused: {error}")),
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![estimator!("double particle", above: true, below: true, |profile| {
        double_particle(Vacuum::new(profile.length()), profile.rates(1.0))
    })]
}

fn twins() -> Vec<Twin> {
    joined!(twins of weights, control, sampling, logarithm, variance)
}
