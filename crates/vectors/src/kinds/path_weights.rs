//! Weights of all strategies that make a path, from the densities of its vertices (veach-1995, antwerpen-2011 section 5.3).

use super::mis_weight::Heuristic;
use super::{Cases, Kind, Model, mistakes, u};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "path_weights",
    outputs: &["weight_0", "weight_1", "weight_2", "weight_3", "weight_4"],
    notes: &[
        (
            "path",
            "vertex i = 1 .. 4 has the density F_i = 2^a (1 + u) if the camera's subpath made it, B_i = 2^b (1 + v) if the light's did: one pair of variates a vertex, u first",
        ),
        ("strategy", "t makes the first t vertices from the camera: p_t = F_1 .. F_t B_(t+1) .. B_4"),
        (
            "weight",
            "p_t^b/sum p_j^b with b = 1 (balance) or 2 (power); maximum: 1 for the greatest, of equal ones for that of fewer eye vertices",
        ),
        (
            "range",
            "p_t themselves leave single precision: p_(t+1)/p_t = F_(t+1)/B_(t+1), or their logarithms; logarithms of densities lose as many digits as they are great",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Weights {
    heuristic: Heuristic,
    /// Exponents of the densities of each vertex, from the camera and from the light.
    exponents: [[i32; 2]; 4],
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Exchanged,
    Shifted,
    Products,
}

const SLIPS: [(&str, Slip); 3] = [
    ("densities from camera and light exchanged", Slip::Exchanged),
    ("the ratio of the vertex before, as printed", Slip::Shifted),
    ("products of densities themselves, in single precision", Slip::Products),
];

/// p_0 … p_4 in single precision.
fn products<N: Number>(densities: &[[N; 2]]) -> Vec<f32> {
    let of = |t: usize| {
        densities.iter().enumerate().map(|(i, pair)| pair[usize::from(i >= t)].to_f64() as f32).product()
    };
    (0..=densities.len()).map(of).collect()
}

impl Weights {
    /// p_j/p_t, scaled by the heuristic.
    fn ratio<N: Number>(&self, densities: &[[N; 2]], t: usize, j: usize) -> N {
        let mut ratio = N::of(1.0);
        let range = if j < t { j..t } else { t..j };
        for i in range {
            let [own, other] =
                &densities[if self.slip == Some(Slip::Shifted) { i.saturating_sub(1) } else { i }];
            let step = if j > t { own.clone() / other.clone() } else { other.clone() / own.clone() };
            ratio = ratio * step;
        }
        if self.heuristic == Heuristic::Power { ratio.clone() * ratio } else { ratio }
    }
}

impl Model for Weights {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one] = [0.0, 1.0].map(A::Number::of);
        let mut densities: Vec<[A::Number; 2]> = Vec::new();
        for exponents in self.exponents {
            let mut pair =
                exponents.map(|exponent| run.number(2.0_f64.powi(exponent)) * (one.clone() + run.uniform()));
            if self.slip == Some(Slip::Exchanged) {
                pair.reverse();
            }
            densities.push(pair);
        }
        if self.slip == Some(Slip::Products) {
            let all = products(&densities);
            let sum: f32 = all.iter().sum();
            let weight = |p: &f32| if sum > 0.0 && sum.is_finite() { f64::from(p / sum) } else { 0.0 };
            return Outcome::all(all.iter().map(|p| run.number(weight(p))).collect::<Vec<_>>());
        }
        let mut weights = Vec::new();
        for t in 0..=densities.len() {
            let ratios: Vec<A::Number> =
                (0..=densities.len()).map(|j| self.ratio(&densities, t, j)).collect();
            if self.heuristic == Heuristic::Maximum {
                let wins =
                    ratios.iter().enumerate().all(|(j, ratio)| *ratio < one || *ratio == one && j >= t);
                weights.push(if run.decided(wins) { one.clone() } else { zero.clone() });
            } else {
                let sum = ratios.into_iter().fold(zero.clone(), |sum, ratio| sum + ratio);
                weights.push(one.clone() / sum);
            }
        }
        Outcome::all(weights)
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "heuristic": self.heuristic.name(), "path": self.exponents })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let near = [[0, 1], [-1, 0], [1, 0], [0, 0]];
    let small = [[-40, -39], [-38, -40], [-41, -40], [-39, -39]];
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for (parameters, heuristic, exponents) in [
        ("balance", Heuristic::Balance, near),
        ("balance-small", Heuristic::Balance, small),
        ("power", Heuristic::Power, near),
        ("power-small", Heuristic::Power, small),
        ("maximum", Heuristic::Maximum, near),
    ] {
        let model = Weights { heuristic, exponents, slip: None };
        cases.draw_some(6, &name(parameters), &model, Profile::EVEN);
    }
    let equal = (0..8).map(|_| u(0.5)).collect();
    let model = Weights { heuristic: Heuristic::Maximum, exponents: [[0, 0]; 4], slip: None };
    cases.tie(&name("tie/all-equal"), &model, Profile::EVEN, equal);
}
