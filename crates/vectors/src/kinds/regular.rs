//! Regular tracking: exp(−τ) of an optical thickness in closed form.

use super::{Cases, Kind, Model, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "regular",
    outputs: &["transmittance"],
    notes: &[
        (
            "thickness",
            "of a profile that is linear between nodes: the sum of width (a + b)/2 over its pieces",
        ),
        ("variates", "none, and no look-up: the closed form is what is known"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Regular {
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Steps,
    EqualPieces,
}

const SLIPS: [(&str, Slip); 2] =
    [("the value at its start for each piece", Slip::Steps), ("pieces of equal width", Slip::EqualPieces)];

impl Model for Regular {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let Profile { s, sigma_t } = run.profile();
        let mut thickness = run.number(0.0);
        for i in 1..s.len() {
            let width = match self.slip {
                Some(Slip::EqualPieces) => run.length() / (s.len() - 1) as f64,
                _ => s[i] - s[i - 1],
            };
            let end = sigma_t[if self.slip == Some(Slip::Steps) { i - 1 } else { i }];
            let values = run.input(sigma_t[i - 1]) + run.input(end);
            thickness = thickness + run.number(0.5) * run.number(width) * values;
        }
        Outcome::of((-thickness).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip) }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name } })
    }
}

fn cases(cases: &mut Cases) {
    for (name, profile) in [("smoke", Profile::SMOKE), ("even", Profile::EVEN), ("ramp", Profile::RAMP)] {
        cases.draw_some(1, &format!("{}/{name}", KIND.name), &Regular { slip: None }, profile);
    }
}
