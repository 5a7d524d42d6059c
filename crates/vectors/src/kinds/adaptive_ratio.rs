//! Adaptive ratio tracking: collisions at the rate of the null extinction found last (misso-2023).

use super::{Cases, Kind, Model, given, mistakes};
use crate::moments::Moments;
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "adaptive_ratio",
    outputs: &["transmittance"],
    notes: &[
        ("flight", "d = e/rate, not e * (1/rate); the rate is the majorant at the start"),
        ("end", "x + d >= length is outside: no look-up there"),
        (
            "weight",
            "behind a flight weight *= (majorant - sigma_t)/rate, with the rate by which it was drawn",
        ),
        ("rate", "then max(majorant - sigma_t, floor * majorant): fixed before the next look-up"),
        (
            "exponent",
            "(rate - majorant) * d is added up, the last stretch included; one exponential at the end",
        ),
        ("variates", "one exponential a flight, the last one included"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct AdaptiveRatio {
    majorant: f64,
    floor: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Foresees,
    ByMajorant,
    NoLast,
    Floor,
}

const SLIPS: [(&str, Slip); 4] = [
    ("the weight divided by the rate that the look-up gave", Slip::Foresees),
    ("the weight divided by the majorant", Slip::ByMajorant),
    ("the last stretch left out of the exponent", Slip::NoLast),
    ("the floor not times the majorant", Slip::Floor),
];

impl Model for AdaptiveRatio {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, majorant, floor, length] =
            [0.0, 1.0, self.majorant, self.floor, run.length()].map(A::Number::of);
        let least = if self.slip == Some(Slip::Floor) { floor } else { floor * majorant.clone() };
        let (mut x, mut rate, mut weight, mut exponent) = (zero.clone(), majorant.clone(), one, zero.clone());
        loop {
            let flight = run.exponential() / rate.clone();
            let excess = rate.clone() - majorant.clone();
            let next = x.clone() + flight.clone();
            if next >= length {
                if self.slip != Some(Slip::NoLast) {
                    exponent = exponent + excess * (length - x);
                }
                return Outcome::of(weight * exponent.exp());
            }
            x = next;
            exponent = exponent + excess * flight;
            let null = majorant.clone() - run.look_up(x.clone());
            let after = null.clone().max(least.clone());
            let divisor = match self.slip {
                Some(Slip::Foresees) => after.clone(),
                Some(Slip::ByMajorant) => majorant.clone(),
                _ => rate,
            };
            weight = weight * (null / divisor);
            run.weighs(&weight);
            rate = after;
        }
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        Some(Moments::unbiased("transmittance", profile))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "majorant": self.majorant, "floor": self.floor } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |majorant, floor| AdaptiveRatio { majorant, floor, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.draw_some(24, &name("1-0.125"), &of(1.0, 0.125), Profile::SMOKE);
    cases.draw_some(24, &name("1.25-0.5"), &of(1.25, 0.5), Profile::SMOKE);
    cases.tie(&name("tie/end"), &of(1.0, 0.125), Profile::SMOKE, vec![given(8.0)]);
}
