//! The phase functions.

use super::{Check, Law};
use fairflight_laws::{CheckResult, phase};
use fairflight_media::PhaseFunction;
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh, Schlick, Tabulated};

/// Twenty cells of the cosine, expected as often as chi-square asks for at the level of one check of many.
const SAMPLES: u64 = 400_000;

const LAWFUL: &str = "the catalogue's phase functions are lawful";

/// The law of every phase function.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = vec![of("isotropic", Isotropic), of("rayleigh", Rayleigh)];
    for g in [0.0, 1e-7, 1e-4, 0.5, 0.95, -0.95] {
        checks.push(of(format!("henyey_greenstein {g}"), HenyeyGreenstein::new(g).expect(LAWFUL)));
    }
    for k in [1e-7, 0.5, 0.95, -0.95] {
        checks.push(of(format!("schlick {k}"), Schlick::new(k).expect(LAWFUL)));
    }
    checks.push(of("hazy_mie", Tabulated::hazy_mie(65).expect(LAWFUL)));
    // A gap, a kink and a jump of the slope, at distances that no quadrature guesses.
    let cosines = vec![-1.0, -0.83, -0.5, 0.07, 0.11, 0.9, 1.0];
    let ragged = Tabulated::new(cosines, vec![2.0, 0.0, 0.0, 3.0, 0.5, 0.5, 40.0]).expect(LAWFUL);
    checks.push(of("tabulated", ragged));
    checks
}

fn of(name: impl Into<String>, phase: impl PhaseFunction + Send + Sync + 'static) -> Check {
    let name = name.into();
    Check::new(format!("phase/{name}"), Law::Phase, name, "any", SAMPLES, move |run| {
        match phase::check(&phase, run) {
            Ok(evidence) => evidence.result(run.samples),
            Err(broken) => CheckResult::exact(false, broken.to_string()),
        }
    })
}
