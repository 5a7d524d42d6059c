//! Common parts of single and double particle tracking.

use super::ray::{RayControl, RayTracking};
use super::{AnyControl, AnySampling, ControlSpec, FOR_ONE_RAY, Prepared, SamplingSpec, refuse};
use crate::Failure;
use crate::field::AnyProfile;
use fairflight_collision::CollisionModel;
use fairflight_laws::scores::{self, Interval, Ranged};
use fairflight_media::{Breakpoints, OpticalThickness};
use fairflight_transmittance::Tracking;
use std::fmt::Debug;

/// Tracking with a control and a sampling extinction of any kind.
pub(super) type AnyTracking<M> = Tracking<M, AnyControl, AnySampling>;

/// Tracking on one profile.
pub(super) fn tracking<M: CollisionModel + Copy>(
    model: M,
    sampling: &SamplingSpec,
    control: &ControlSpec,
    profile: &AnyProfile,
) -> Result<AnyTracking<M>, Failure> {
    let control = AnyControl::build(control, profile)?;
    let sampling = AnySampling::build(sampling, profile)?;
    Ok(Tracking::new(model, control, sampling))
}

/// Adds the facts of a tracking estimator: scores, breakpoints, explorers, objections.
pub(super) fn with_facts<M: CollisionModel + Clone + Debug + Send + Sync + 'static>(
    prepared: Prepared,
    tracking: AnyTracking<M>,
    profile: &AnyProfile,
) -> Prepared {
    let sigma_t = Interval::from(profile.field().knowledge());
    let ratios = scores::ratio_range(sigma_t, tracking.control().range(), tracking.sampling().range());
    let main_thickness = tracking.control().optical_thickness(0.0, profile.length());
    let model = tracking.model().clone();
    let mut breakpoints = tracking.control().breakpoints();
    breakpoints.extend(tracking.sampling().breakpoints());
    let explorers = match tracking.control() {
        AnyControl::Explorers(explorers) => Some(explorers.clone()),
        AnyControl::None(_) | AnyControl::Constant(_) | AnyControl::PiecewiseLinear(_) => None,
    };
    Prepared { preparation_lookups: tracking.control().lookups(), explorers, breakpoints, ..prepared }
        .scoring(move |unit| scores::tracking(&model, ratios, main_thickness, unit))
        .objecting(move |place, s, sigma_t| objection(place, tracking.ratio_at(s, sigma_t), sigma_t))
}

fn objection(place: &str, ratio: Option<f64>, sigma_t: f64) -> String {
    match ratio {
        None => format!(
            "estimator.sigma_samp: is 0 where sigma_t − control is not (a silent bias): sigma_t = {sigma_t} at {place}"
        ),
        Some(r) => format!(
            "estimator.version: terminating needs 0 <= r <= 2/(1 + albedo), but r = (sigma_t − control)/sigma_samp = \
             {r} at {place}"
        ),
    }
}

/// Tracking that is prepared for each ray of a scene.
pub(super) fn for_all_rays<M>(
    model: M,
    sampling: &SamplingSpec,
    control: &ControlSpec,
    key: &str,
) -> Result<RayTracking<M>, Failure> {
    let one_ray = |what: &str| refuse(&format!("{key}.{what}"), FOR_ONE_RAY);
    let SamplingSpec::Constant(sigma_samp) = *sampling else { return Err(one_ray("sigma_samp")) };
    let control = RayControl::of(control).ok_or_else(|| one_ray("control"))?;
    Ok(RayTracking::new(model, control, sigma_samp))
}

/// The parameter that belongs to one ray.
pub(super) fn of_one_ray(sampling: &SamplingSpec, control: &ControlSpec) -> Option<(&'static str, String)> {
    match (sampling, control) {
        (SamplingSpec::PiecewiseConstant { .. }, _) => {
            Some(("sigma_samp", format!("{FOR_ONE_RAY}: a number is allowed")))
        }
        (_, ControlSpec::PiecewiseLinear(_)) => {
            Some(("control.kind", format!("{FOR_ONE_RAY}: none, constant and explorers are allowed")))
        }
        _ => None,
    }
}
