//! The direction behind a collision, about the direction of propagation before it.

use super::{Cases, Kind, Model, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "deflection",
    outputs: &["cosine", "length", "pdf_solid_angle"],
    notes: &[
        (
            "cosine",
            "incident . direction of the direction that was made, in any frame about the incident one",
        ),
        ("length", "that of the direction: 1"),
        ("pdf", "per steradian: the phase function at the cosine, schlick's with k"),
        ("variates", "u for the cosine, then v for the azimuth 2 pi v"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Deflection {
    k: f64,
    incident: [f64; 3],
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Reversed,
    OneVariate,
    FixedAxis,
}

const SLIPS: [(&str, Slip); 3] = [
    ("the lobe about the direction back", Slip::Reversed),
    ("one variate for cosine and azimuth", Slip::OneVariate),
    ("the lobe about the third axis, whatever the incident direction", Slip::FixedAxis),
];

impl Model for Deflection {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let u = run.uniform();
        let v = if self.slip == Some(Slip::OneVariate) { u.clone() } else { run.uniform() };
        let [zero, one, two] = [0.0, 1.0, 2.0].map(A::Number::of);
        let pi = zero.atan2(&run.input(-1.0));
        let k = run.input(self.k);
        let [back, front] = [one.clone() - k.clone(), one.clone() + k];
        let [far, near] = [back.clone() * (one.clone() - u.clone()), front.clone() * u];
        let below = two.clone() * far.clone() / (far + near);
        let cosine = one.clone() - below;
        let root = run.number(0.5)
            * (back.clone() * (one.clone() + cosine.clone())
                + front.clone() * (one.clone() - cosine.clone()));
        let pdf = back * front / (run.number(4.0) * pi.clone() * root.clone() * root);
        let seen = match self.slip {
            Some(Slip::Reversed) => -cosine,
            Some(Slip::FixedAxis) => {
                let sine = ((one.clone() - cosine.clone()) * (one.clone() + cosine.clone())).max(zero).sqrt();
                let [x, _, z] = self.incident.map(A::Number::of);
                sine * (two * pi * v).cos() * x + cosine * z
            }
            _ => cosine,
        };
        Outcome::all([seen, one, pdf])
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "phase": { "kind": "schlick", "k": self.k }, "incident": self.incident })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    // Of unit length to the last digit: quadruples of Pythagoras over a power of two are none, so that axes and 0.6, 0.8 must do.
    for (name, incident) in [
        ("down", [0.0, 0.0, -1.0]),
        ("up", [0.0, 0.0, 1.0]),
        ("aside", [0.6, 0.0, -0.8]),
        ("along-y", [0.0, 1.0, 0.0]),
    ] {
        let model = Deflection { k: 0.5, incident, slip: None };
        cases.draw_some(8, &format!("{}/{name}", KIND.name), &model, Profile::EVEN);
    }
}
