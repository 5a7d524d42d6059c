//! Distances within a bounding region: the exponential distribution cut off at a length (engelhardt-2013 eq. 4 and 5).

use super::{Cases, Kind, LARGEST, Model, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "truncated_exponential",
    outputs: &["distance", "pdf_distance", "probability_beyond"],
    notes: &[
        ("mass", "m = 1 - exp(-rate * length), as -expm1"),
        ("distance", "-ln(1 - u m)/rate, as -log1p, at most the length"),
        ("pdf", "rate exp(-rate t)/m per length, at the distance that was drawn"),
        ("beyond", "P(t >= s) = exp(-rate s) (-expm1(-rate (length - s)))/m at s = `beyond`"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Truncated {
    rate: f64,
    length: f64,
    beyond: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Untruncated,
    NotNormalised,
    FreeFlight,
}

const SLIPS: [(&str, Slip); 3] = [
    ("the distance of a free flight without the cut", Slip::Untruncated),
    ("the density not over the mass", Slip::NotNormalised),
    ("exp(-rate s) as the probability beyond", Slip::FreeFlight),
];

impl Model for Truncated {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [rate, length, beyond] = [self.rate, self.length, self.beyond].map(|x| run.input(x));
        let mass = -(-(rate.clone() * length.clone())).exp_m1();
        let share = run.uniform();
        let share = if self.slip == Some(Slip::Untruncated) { share } else { share * mass.clone() };
        let distance = (-((-share).ln_1p()) / rate.clone()).min(length.clone());
        let mut pdf = rate.clone() * (-(rate.clone() * distance.clone())).exp();
        if self.slip != Some(Slip::NotNormalised) {
            pdf = pdf / mass.clone();
        }
        let passed = (-(rate.clone() * beyond.clone())).exp();
        let rest = -(-(rate * (length - beyond))).exp_m1();
        let past = if self.slip == Some(Slip::FreeFlight) { passed } else { passed * rest / mass };
        Outcome::all([distance, pdf, past])
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "sampler": {
            "kind": KIND.name,
            "rate": self.rate,
            "length": self.length,
            "beyond": self.beyond,
        } })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let of = |rate, length| Truncated { rate, length, beyond: 0.75 * length, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let thin = 2.0_f64.powi(-30);
    for (parameters, model) in [("thick", of(2.0, 4.0)), ("half", of(0.5, 1.0)), ("thin", of(thin, 2.0))] {
        cases.draw_some(12, &name(parameters), &model, Profile::EVEN);
    }
    for (end, k) in [("smallest", 0), ("largest", LARGEST)] {
        let draws = vec![Draw::lattice(k)];
        cases.extreme(&name(&format!("extreme/{end}-variate")), &of(0.5, 1.0), Profile::EVEN, draws);
    }
}
