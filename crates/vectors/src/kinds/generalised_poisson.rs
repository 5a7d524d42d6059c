//! One term of the exponential series, of Poisson order (fearnhead-2008, wagner-1987).

use super::p_series::{point, poisson};
use super::{Cases, Kind, Model, given, mistakes, u};
use crate::moments::{Collision, Moments, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "generalised_poisson",
    outputs: &["transmittance"],
    notes: &[
        (
            "order",
            "exponentials are added as long as their sum is below the rate, strictly; all before the points",
        ),
        ("point", "X = length * sigma_t(length * u), u uniform"),
        ("product", "of (pivot - X)/rate, times exp(rate - pivot) once, at the end; of any sign"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct GeneralisedPoisson {
    pivot: f64,
    rate: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    ByPivot,
    WithoutRate,
    OneMore,
}

const SLIPS: [(&str, Slip); 3] = [
    ("factors over the pivot, not over the rate", Slip::ByPivot),
    ("exp(-pivot) for exp(rate - pivot)", Slip::WithoutRate),
    ("one factor too many: the exponential that does not fit counts", Slip::OneMore),
];

impl Model for GeneralisedPoisson {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let order = poisson(run, self.rate) + u32::from(self.slip == Some(Slip::OneMore));
        let [mut product, pivot, rate] = [1.0, self.pivot, self.rate].map(A::Number::of);
        let divisor = if self.slip == Some(Slip::ByPivot) { pivot.clone() } else { rate };
        for _ in 0..order {
            product = product * ((pivot.clone() - point(run)) / divisor.clone());
        }
        let exponent = if self.slip == Some(Slip::WithoutRate) { 0.0 } else { self.rate } - self.pivot;
        Outcome::of(product * run.input(exponent).exp())
    }

    fn takes_functions(&self) -> bool {
        self.rate != self.pivot
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let (Self { pivot, rate, .. }, length) = (*self, profile.length());
        let at = |_: f64, sigma_t: f64| Collision::always(rate / length, (pivot - length * sigma_t) / rate);
        Some(product("transmittance", profile, profile.s, (rate - pivot, 0.0), at))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "pivot": self.pivot, "rate": self.rate } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |pivot, rate| GeneralisedPoisson { pivot, rate, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.draw_some(20, &name("8-4"), &of(8.0, 4.0), Profile::SMOKE);
    cases.draw_some(20, &name("4.5-3"), &of(4.5, 3.0), Profile::SMOKE);
    let equal = of(4.0, 4.0);
    cases.tie(&name("tie/order-0"), &equal, Profile::SMOKE, vec![given(4.0)]);
    cases.tie(&name("tie/order-1"), &equal, Profile::SMOKE, vec![given(1.0), given(3.0), u(0.25)]);
}
