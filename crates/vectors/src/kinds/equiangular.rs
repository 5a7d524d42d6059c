//! Distances along a ray that mimic the inverse square of a point light (kulla-2012).

use super::{Cases, Kind, LARGEST, Model, mistake};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "equiangular",
    outputs: &["distance", "pdf_distance"],
    notes: &[
        (
            "geometry",
            "closest = (light - origin) . direction; D = |light - origin - closest direction|, not through a difference of squares",
        ),
        ("angles", "a = atan2(-closest, D), b = atan2(length - closest, D): the angle is b - a"),
        ("distance", "closest + D tan(a + u (b - a)), clamped to [0, length]"),
        ("pdf", "D/((b - a)(D^2 + (s - closest)^2)) per length, not per angle"),
    ],
    cases,
};

struct Equiangular {
    light: [f64; 3],
    length: f64,
}

/// The ray starts here, along the third axis.
const ORIGIN: [f64; 3] = [1.0, 2.0, 3.0];

impl Model for Equiangular {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let length = run.number(self.length);
        // Inputs are exact, and so are differences of those here.
        let [x, y, closest] = std::array::from_fn(|axis| run.input(self.light[axis] - ORIGIN[axis]));
        let squared = x.clone() * x + y.clone() * y;
        let distance = squared.sqrt();
        let from = (-closest.clone()).atan2(&distance);
        let to = (length.clone() - closest.clone()).atan2(&distance);
        let angle = to - from.clone();
        let seen = (from + run.uniform() * angle.clone()).tan();
        let s = (closest.clone() + distance.clone() * seen).max(run.number(0.0)).min(length);
        let along = s.clone() - closest;
        let pdf = distance.clone() / (angle * (distance.clone() * distance + along.clone() * along));
        Outcome { event: None, values: vec![s, pdf] }
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let Self { light, length } = *self;
        let all = [
            ("a density per angle, not per length", Slip::PerAngle),
            ("the distance from the light's foot", Slip::FromFoot),
        ];
        all.map(|(name, slip)| mistake(name, &Wrong { right: Self { light, length }, slip }, script, profile))
            .into()
    }

    fn stated(&self) -> Value {
        json!({ "sampler": {
            "kind": KIND.name,
            "origin": ORIGIN,
            "direction": [0.0, 0.0, 1.0],
            "length": self.length,
            "light": self.light,
        } })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    PerAngle,
    FromFoot,
}

/// Equiangular sampling with a mistake.
struct Wrong {
    right: Equiangular,
    slip: Slip,
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let Equiangular { light, length } = self.right;
        let Outcome { event, mut values } = self.right.run(run);
        let [x, y, closest] = std::array::from_fn(|axis| light[axis] - ORIGIN[axis]);
        match self.slip {
            Slip::FromFoot => values[0] = values[0].clone() - run.number(closest),
            Slip::PerAngle => {
                let distance = run.number((x * x + y * y).sqrt());
                let [from, to] = [-closest, length - closest].map(|along| run.number(along).atan2(&distance));
                values[1] = run.number(1.0) / (to - from);
            }
        }
        Outcome { event, values }
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let near = 2.0_f64.powi(-10);
    for (name, light) in [
        ("beside", [1.5, 2.0, 7.0]),
        ("behind-the-start", [1.0, 9.0, -4.0]),
        ("beyond-the-end", [0.0, 2.5, 12.0]),
        ("near-the-ray", [1.0 + near, 2.0, 5.0]),
    ] {
        cases.draw(&format!("{}/{name}", KIND.name), &Equiangular { light, length: 6.0 }, Profile::EVEN);
    }
    let beside = Equiangular { light: [1.5, 2.0, 7.0], length: 6.0 };
    for (name, k) in [("smallest", 0), ("largest", LARGEST)] {
        let name = format!("{}/extreme/{name}-variate", KIND.name);
        cases.extreme(&name, &beside, Profile::EVEN, vec![Draw::lattice(k)]);
    }
}
