//! Ray marching: the exponential of a Riemann sum (perlin-1989). Biased.

use super::{Cases, Kind, LARGEST, Model, mistakes};
use crate::moments::{Moments, Shifts, of_shifts};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "ray_marching",
    outputs: &["transmittance"],
    notes: &[
        ("bias", "exp of an unbiased sum: the mean is above exp(-optical thickness)"),
        ("places", "step k looks up (k + u) * (length/steps), with u = 1/2 for all or one variate for all"),
        ("sum", "exp(-(sum * (length/steps)))"),
        ("naive", "the estimator `naive` of as many teeth is the jittered one"),
        ("variates", "one if jittered, else none"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct RayMarching {
    steps: u32,
    jitter: bool,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Start,
    Each,
    WorldUnits,
    NotScaled,
}

const SLIPS: [(&str, Slip); 4] = [
    ("the start of each step for its middle", Slip::Start),
    ("a variate for each step", Slip::Each),
    ("the offset in world units: u not times the step", Slip::WorldUnits),
    ("the sum not times the step", Slip::NotScaled),
];

impl Model for RayMarching {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let step = run.input(run.length()) / run.number(f64::from(self.steps));
        let mut offset = run.number(0.5);
        if self.slip == Some(Slip::Start) && !self.jitter {
            offset = run.number(0.0);
        }
        if self.jitter {
            offset = run.uniform();
        }
        let mut sum = run.number(0.0);
        for k in 0..self.steps {
            if k > 0 && self.jitter && self.slip == Some(Slip::Each) {
                offset = run.uniform();
            }
            let k = run.number(f64::from(k));
            let s = match self.slip {
                Some(Slip::WorldUnits) => k * step.clone() + offset.clone(),
                _ => (k + offset.clone()) * step.clone(),
            };
            sum = sum + run.look_up(s);
        }
        let thickness = if self.slip == Some(Slip::NotScaled) { sum } else { sum * step };
        Outcome::of((-thickness).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let comb = Shifts::new(profile, self.steps, false);
        let raw = of_shifts(&comb.breaks(), |u| libm::exp(-comb.thickness(u)));
        self.jitter.then(|| Moments::of_raw("transmittance", raw, Some(f64::from(self.steps))))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "steps": self.steps, "jitter": self.jitter } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |steps, jitter| RayMarching { steps, jitter, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for (parameters, steps) in [("jittered-5", 5), ("jittered-8", 8)] {
        cases.draw_some(16, &name(parameters), &of(steps, true), Profile::SMOKE);
    }
    for (parameters, steps) in [("middles-1", 1), ("middles-7", 7), ("middles-16", 16)] {
        cases.draw_some(1, &name(parameters), &of(steps, false), Profile::SMOKE);
    }
    for (end, k) in [("smallest", 0), ("largest", LARGEST)] {
        let draws = vec![Draw::lattice(k)];
        cases.extreme(&name(&format!("extreme/{end}-variate")), &of(4, true), Profile::SMOKE, draws);
    }
}
