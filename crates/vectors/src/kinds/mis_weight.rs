//! Weights of two sampling techniques (veach-1995).

use super::{Cases, Kind, Model, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "mis_weight",
    outputs: &["own", "other"],
    notes: &[
        (
            "densities",
            "p = 2^a (1 + u) and q = 2^b (1 + v) of two techniques at one point, in the same measure",
        ),
        (
            "own",
            "the weight of a sample of the first technique; other: that of one of the second. They sum to 1",
        ),
        ("balance", "p/(p + q)"),
        ("power", "p^2/(p^2 + q^2) through the ratio of the smaller to the greater: squares leave the range"),
        ("maximum", "1 for the greater, 1/2 each where they are equal"),
    ],
    cases,
};

/// A law of weights from densities.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Heuristic {
    Balance,
    Power,
    Maximum,
}

impl Heuristic {
    /// Name in cases.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Balance => "balance",
            Self::Power => "power",
            Self::Maximum => "maximum",
        }
    }
}

#[derive(Clone, Copy)]
struct Weight {
    heuristic: Heuristic,
    /// Exponents of the two densities.
    exponents: [i32; 2],
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Exchanged,
    Squares,
    Balance,
}

const SLIPS: [(&str, Slip); 3] = [
    ("the weight of the other technique", Slip::Exchanged),
    ("squares of densities themselves, in single precision", Slip::Squares),
    ("the balance heuristic for every other", Slip::Balance),
];

impl Model for Weight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, half] = [0.0, 1.0, 0.5].map(A::Number::of);
        let [p, q] =
            self.exponents.map(|exponent| run.number(2.0_f64.powi(exponent)) * (one.clone() + run.uniform()));
        let balance = |p: &A::Number, q: &A::Number| p.clone() / (p.clone() + q.clone());
        let power = |p: &A::Number, q: &A::Number| {
            // The ratio of the smaller to the greater.
            let (least, most) = if p < q { (p, q) } else { (q, p) };
            let ratio = least.clone() / most.clone();
            let square = ratio.clone() * ratio;
            let of_least = square.clone() / (one.clone() + square.clone());
            if p < q { of_least } else { one.clone() / (one.clone() + square) }
        };
        let maximum = |p: &A::Number, q: &A::Number| match () {
            () if p == q => half.clone(),
            () if p > q => one.clone(),
            () => zero.clone(),
        };
        let squares = |p: &A::Number, q: &A::Number| {
            let [p, q] = [p, q].map(|x| (x.to_f64() * x.to_f64()) as f32);
            A::Number::of(if p + q > 0.0 && (p + q).is_finite() { f64::from(p / (p + q)) } else { 0.0 })
        };
        let weight = |p: &A::Number, q: &A::Number| match (self.heuristic, self.slip) {
            (Heuristic::Balance, _) | (_, Some(Slip::Balance)) => balance(p, q),
            (Heuristic::Power, Some(Slip::Squares)) => squares(p, q),
            (Heuristic::Power, _) => power(p, q),
            (Heuristic::Maximum, _) => maximum(p, q),
        };
        let both = [weight(&p, &q), weight(&q, &p)];
        let [own, other] = both;
        Outcome::all(if self.slip == Some(Slip::Exchanged) { [other, own] } else { [own, other] })
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "heuristic": self.heuristic.name(), "exponents": self.exponents })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let of = |heuristic, exponents| Weight { heuristic, exponents, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for (parameters, heuristic, exponents) in [
        ("balance", Heuristic::Balance, [0, 1]),
        ("power", Heuristic::Power, [-1, 0]),
        ("power-small", Heuristic::Power, [-80, -78]),
        ("power-great", Heuristic::Power, [79, 80]),
        ("maximum", Heuristic::Maximum, [0, 0]),
    ] {
        cases.draw_some(8, &name(parameters), &of(heuristic, exponents), Profile::EVEN);
    }
    let equal = || vec![super::u(0.25), super::u(0.25)];
    cases.tie(&name("tie/maximum"), &of(Heuristic::Maximum, [3, 3]), Profile::EVEN, equal());
    cases.tie(&name("tie/power"), &of(Heuristic::Power, [3, 3]), Profile::EVEN, equal());
}
