//! Free flights with one candidate in each stratum: the companion of jittered ratio tracking.

use super::{Cases, Kind, Model, given, mistakes, u};
use crate::moments::{Moments, coin};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "jittered_flight",
    outputs: &["distance", "weight"],
    notes: &[
        ("distance", "of the collision; the length where the flight escaped"),
        ("strata", "ceil(majorant * length/epsilon), at least 1; width = length/strata"),
        ("candidate", "at (i + u) * width; accepted with v < width * sigma_t, strictly"),
        (
            "survival",
            "an accepted one is put to a Woodcock flight from the start of its stratum: s += e/majorant; s >= candidate survives, w * majorant < sigma_t(s) fails. One that fails leaves the whole stratum behind",
        ),
        ("weight", "1"),
        (
            "variates",
            "u, v; if accepted an exponential, and a uniform variate at each look-up of the survival test",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Flight {
    epsilon: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    NoTest,
    FromStart,
    Included,
    Resumes,
}

const SLIPS: [(&str, Slip); 4] = [
    ("no survival test", Slip::NoTest),
    ("the survival test from the start of the ray", Slip::FromStart),
    ("<= for < in the decision to accept", Slip::Included),
    ("a candidate that fails ends the flight where the test collided", Slip::Resumes),
];

impl Model for Flight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let thickness = run.majorant() * run.length();
        let count = (thickness / self.epsilon).ceil().max(1.0);
        let [one, majorant, width, length] =
            [1.0, run.majorant(), run.length() / count, run.length()].map(A::Number::of);
        'strata: for stratum in 0..count as u32 {
            let i = run.number(f64::from(stratum));
            let candidate = ((i.clone() + run.uniform()) * width.clone()).min(length.clone());
            let accepts = run.look_up(candidate.clone()) * width.clone();
            let decides = run.uniform();
            if decides > accepts || decides == accepts && self.slip != Some(Slip::Included) {
                continue;
            }
            if self.slip == Some(Slip::NoTest) {
                return Outcome::collided(candidate, one);
            }
            let mut s = if self.slip == Some(Slip::FromStart) { run.number(0.0) } else { i * width.clone() };
            loop {
                s = s + run.exponential() / majorant.clone();
                if s >= candidate {
                    return Outcome::collided(candidate, one);
                }
                let sigma_t = run.look_up(s.clone());
                if run.uniform() * majorant.clone() < sigma_t {
                    if self.slip == Some(Slip::Resumes) {
                        return Outcome::collided(s, one);
                    }
                    continue 'strata;
                }
            }
        }
        Outcome::escaped(length, one)
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        Some(coin("escaped", profile))
    }

    fn stated(&self) -> Value {
        json!({ "sampler": { "kind": KIND.name, "epsilon": self.epsilon } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |epsilon| Flight { epsilon, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for epsilon in [1.0, 0.5] {
        cases.draw_some(24, &name(&epsilon.to_string()), &of(epsilon), Profile::SMOKE);
    }
    // Two strata of the width 2 of the even profile at ε = 1, accepted with 1 surely; four at 1/2, with 1/2.
    let strata = |first: Vec<crate::Draw>| {
        let rest = (0..3).flat_map(|_| [u(0.5), u(0.75)]);
        first.into_iter().chain(rest).collect::<Vec<_>>()
    };
    let draws = strata(vec![u(0.5), u(0.5)]);
    cases.tie(&name("tie/accepted-at-the-border"), &of(0.5), Profile::EVEN, draws);
    let draws = vec![u(0.5), u(0.25), given(0.25)];
    cases.tie(&name("tie/survives-at-the-border"), &of(0.5), Profile::EVEN, draws);
}
