//! S1: eq. 16 is the variance of the double particle model.
//!
//! Criterion: of all measured points whose N can test a variance none may be unsound at a false alarm of 1e-6 each, and
//! among them must be σ_samp below the maximum of σ_t, a constant control and explorers with negative differences.
//!
//! The cases are chosen for laws whose variance 10^5 to 10^6 samples can test. Stronger negative ratios (r = −0.5, and −2)
//! were tried and cannot be tested at these N: their tails are too heavy, and they are no evidence either way.

use super::case::{Case, homogeneous, with_error};
use super::{Evidence, claim};
use crate::standard::result::Series;
use crate::standard::series::EXPLORERS;
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::estimator::{ControlSpec, DoubleParticleSpec};
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_media::PiecewiseLinear;

pub(super) fn s1(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let subject = evidence.analytic();
    let seed_ray = (subject.profile.clone(), subject.lookup_nanoseconds);
    let slab = (homogeneous(1.0, 1.0)?, 3.0);
    let ramp = PiecewiseLinear::new(vec![0.0, 2.0], vec![0.0, 1.0]).map_err(Failure::refused)?;
    let ramp = (AnyProfile::PiecewiseLinear(ramp), 5.0);
    let majorant = subject.majorant;
    let constant = ControlSpec::constant;
    let cases = [
        ("eq. 21, no control, below the maximum", &seed_ray, 0.6 * majorant, ControlSpec::none()),
        ("eq. 21, no control, at the maximum", &seed_ray, majorant, ControlSpec::none()),
        ("eq. 21, explorers", &seed_ray, 3.0 * majorant, ControlSpec::through(EXPLORERS)),
        ("ramp, control = mean (differences of both signs)", &ramp, 2.0, constant(0.5)),
        ("homogeneous, no control, r = 2", &slab, 0.5, ControlSpec::none()),
        ("homogeneous, control below sigma_t, r = 1.25", &slab, 0.4, constant(0.5)),
        ("homogeneous, control above sigma_t, r = -0.125 (negative everywhere)", &slab, 2.0, constant(1.25)),
    ];
    let seconds = evidence.effort.claim_seconds;
    let measured = try_in_parallel(cases.len(), &|i| {
        let (name, (profile, nanoseconds), sigma_samp, control) = &cases[i];
        let spec = DoubleParticleSpec::at(*sigma_samp, control.clone()).into();
        Case::measure(profile, spec, evidence.seed(format_args!("S1/{name}")), seconds, *nanoseconds)
    })?;

    let mut tested = Vec::new();
    let mut parts = Vec::new();
    for ((name, ..), case) in cases.iter().zip(&measured) {
        let ratio = with_error(case.measured / case.closed, 1.96 * case.error / case.closed);
        let note = if case.testable { "" } else { ", not testable at this N" };
        parts.push(format!("{name}: {ratio} (N = {}{note})", case.samples));
        if case.testable {
            tested.push((case.z(), case.sound));
        }
    }
    let dedicated = tested.len();
    let double = [Series::DoubleParticle, Series::DoubleParticleMean, Series::DoubleParticleExplorers];
    let curves = evidence.media.iter().flat_map(|medium| &medium.sweeps);
    for point in curves.filter(|curve| double.contains(&curve.series)).flat_map(|curve| &curve.points) {
        if let Some(found) = point.measured.as_ref().filter(|found| found.testable)
            && let Some(z) = found.variance_z
        {
            tested.push((z, found.sound));
        }
    }
    let largest = tested.iter().map(|(z, _)| z.abs()).fold(0.0, f64::max);
    let unsound = tested.iter().filter(|(_, sound)| *sound == Some(false)).count();
    let text = format!(
        "Measured/closed variance: {}. With the sweeps {} testable points, {unsound} of them unsound, largest |z| = {largest:.2}.",
        parts.join("; "),
        tested.len(),
    );
    let verdict = match (unsound, dedicated == cases.len()) {
        (0, true) => ClaimVerdict::Holds,
        (0, false) if dedicated > 0 => ClaimVerdict::HoldsUnder,
        (0, false) => ClaimVerdict::NotTestable,
        _ => ClaimVerdict::DoesNotHold,
    };
    let comment = match verdict {
        ClaimVerdict::HoldsUnder => {
            "For the cases that this N can test; the law of the others has too heavy a tail for the samples of this report."
        }
        ClaimVerdict::DoesNotHold => "See the unsound points.",
        _ => {
            "For any sampling extinction, with and without control, also for negative difference extinction."
        }
    };
    Ok(claim(
        "S1",
        "Eq. 16 gives the variance of the double particle model for any sampling extinction, with or without control, also \
         for negative difference extinction.",
        text,
        verdict,
        comment,
    ))
}
