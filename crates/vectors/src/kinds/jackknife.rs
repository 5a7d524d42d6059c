//! Jackknife transmittance: two combs (peters-2025). Biased.

use super::comb::{Comb, Shape};
use super::{Cases, Kind, LARGEST, Model, mistakes};
use crate::moments::{Moments, Shifts, of_two_shifts};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "jackknife",
    outputs: &["transmittance"],
    notes: &[
        (
            "estimate",
            "cos((X_1 - X_2)/2) exp(-(X_1 + X_2)/2) of two combs with a variate each; may be negative",
        ),
        ("teeth", "tooth j of M at min(u h + j h, length) with h = length/M; X = h times the sum"),
        ("bias", "none for a normal X only"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Jackknife {
    teeth: u32,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    NoCosine,
    Mean,
    Whole,
}

const SLIPS: [(&str, Slip); 3] = [
    ("the cosine left out", Slip::NoCosine),
    ("the mean of two exponentials", Slip::Mean),
    ("cos(X_1 - X_2), not of the half", Slip::Whole),
];

impl Model for Jackknife {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (start, length, half) = (run.number(0.0), run.number(run.length()), run.number(0.5));
        let comb = Comb::prepare(run, (self.teeth, Shape::Uniform), (start, None), &length);
        let [x1, x2] = [(); 2].map(|()| {
            let u = run.uniform();
            comb.thickness(run, u)
        });
        if self.slip == Some(Slip::Mean) {
            return Outcome::of(half * ((-x1).exp() + (-x2).exp()));
        }
        let apart = x1.clone() - x2.clone();
        let cosine = match self.slip {
            Some(Slip::NoCosine) => run.number(1.0),
            Some(Slip::Whole) => apart.cos(),
            _ => (half.clone() * apart).cos(),
        };
        Outcome::of(cosine * (-(half * (x1 + x2))).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let comb = Shifts::new(profile, self.teeth, false);
        let raw = of_two_shifts(&comb, |x, y| libm::cos(0.5 * (x - y)) * libm::exp(-0.5 * (x + y)));
        Some(Moments::of_raw("transmittance", raw, Some(2.0 * f64::from(self.teeth))))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "teeth": self.teeth } })
    }
}

fn cases(cases: &mut Cases) {
    for teeth in [3, 8] {
        let model = Jackknife { teeth, slip: None };
        cases.draw_some(16, &format!("{}/{teeth}", KIND.name), &model, Profile::SMOKE);
    }
    let draws = vec![Draw::lattice(0), Draw::lattice(LARGEST)];
    let model = Jackknife { teeth: 3, slip: None };
    cases.extreme(&format!("{}/extreme/both-ends", KIND.name), &model, Profile::SMOKE, draws);
}
