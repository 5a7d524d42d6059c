//! Row 15: a medium that breaks its promises is refused, with the point.

use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::{Observed, check};
use fairflight_laws::{Expectation, Refusal, Run, Truth};
use fairflight_media::{Extinction, Majorant, Vacuum};
use fairflight_stats::Scores;
use fairflight_transmittance::{LineIntegral, Theory, Tracking, TransmittanceEstimator, Woodcock};

/// σ_t = 0.5 but for the second half of a ray of length 2, with a declared majorant of 1.
#[derive(Clone, Copy, Debug)]
struct Faulty(f64);

impl Extinction for Faulty {
    fn sigma_t(&self, s: f64) -> f64 {
        if s < 1.0 { 0.5 } else { self.0 }
    }
    fn length(&self) -> f64 {
        2.0
    }
}

impl Majorant for Faulty {
    fn majorant(&self) -> f64 {
        1.0
    }
}

/// An arbitrary expectation: nothing is judged before every look-up was lawful.
fn expectation() -> Expectation {
    let truth = Truth { optical_thickness: 1.0, error: 0.0 };
    let theory = Theory::mean_only(1.0);
    Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::MeanOnly }
}

fn tried<'f, E>(field: &'f Faulty, estimator: E) -> Outcome
where
    E: TransmittanceEstimator<&'f Faulty> + TransmittanceEstimator<Observed<&'f Faulty, E>> + Copy,
{
    let run = Run { samples: 100, seed: 15, alpha: 1e-6 };
    match check(field, estimator, &expectation(), run) {
        Err(refusal @ Refusal::Unlawful(violation)) if violation.s >= 1.0 => Outcome::refusal(refusal),
        Err(refusal) => Outcome::said(false, refusal.to_string()),
        Ok(_) => Outcome::said(false, "not noticed"),
    }
}

pub(super) fn cases() -> Vec<HardCase> {
    let mut cases = Vec::new();
    let faults = [
        ("NaN", f64::NAN),
        ("inf", f64::INFINITY),
        ("-inf", f64::NEG_INFINITY),
        ("1.5 above its majorant 1", 1.5),
    ];
    for (name, value) in faults {
        let mut add = |estimator: &'static str, kind: &'static str, function: fn(&Faulty) -> Outcome| {
            let case = HardCase::deterministic(
                15,
                format!("a medium that returns {name}: {estimator}"),
                estimator,
                "an error with the point",
                "refused",
                move || function(&Faulty(value)),
            );
            cases.push(HardCase { refusal: true, ..case }.about([kind]));
        };
        add("woodcock", "woodcock", |field| tried(field, Woodcock));
        add("line integral", "line_integral", |field| tried(field, LineIntegral::new(4).expect(LAWFUL)));
        // The double particle model has no majorant to be violated.
        if !value.is_finite() {
            add("double particle", "double_particle", |field| {
                let model = DoubleParticle { albedo: Albedo::default() };
                let sampling = constant(1.0, 2.0);
                tried(field, &Tracking::new(model, Vacuum::new(2.0), sampling))
            });
        }
    }
    cases
}
