//! Unbiased ray marching with combs of other shapes, and in segments.

use super::comb::{Comb, Shape};
use super::unbiased_ray_marching::{order, series};
use super::{Cases, Kind, Model, mistakes};
use crate::moments::Moments;
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "unbiased_ray_marching_combs",
    outputs: &["transmittance"],
    notes: &[
        ("series", "that of unbiased_ray_marching: order, weights, means, all pivots"),
        (
            "bernoulli 2",
            "X less h [sigma_t] (u - 1/2) + h ((f(end) - f(end - h/2)) - (f(h/2) - f(0))) (u (u - 1) + 1/6); [] is the value at the end of the part less that at its start",
        ),
        (
            "bernoulli 3",
            "slopes h f' = 4 (f_1 - f_0) - (f_2 - f_0) and curvatures h^2/4 f'' = (f_0 - f_1) + (f_2 - f_1) from points at h/2 and h; X less h [f] B_1 + h/2 [h f'] B_2 + 2/3 h [h^2/4 f''] B_3, B_3 = u (u - 1/2) (u - 1)",
        ),
        ("periodised", "t = (j + u)/M, s = from + t^2 (3 - 2 t) length, X = 6 h sum of t (1 - t) sigma_t(s)"),
        (
            "segments",
            "the product of estimates of equal parts, each with the whole comb and an order of its own; the end of part k of G is length * (k/G)",
        ),
        (
            "look-ups",
            "shared ones of a part before its order is drawn: its start (not again behind another part), its end, then h/2 from start and end, then h from both",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct InSegments {
    teeth: u32,
    shape: Shape,
    segments: u32,
    /// The probability of stopping at order 0.
    roulette: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    OneTerm,
    NoWeights,
    OneOrder,
    FirstPart,
}

const SLIPS: [(&str, Slip); 4] = [
    ("only the first term of the ends", Slip::OneTerm),
    ("periodised places with equal weights", Slip::NoWeights),
    ("one order for all segments", Slip::OneOrder),
    ("the combs of all segments on the first one", Slip::FirstPart),
];

impl Model for InSegments {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let shape = match (self.slip, self.shape) {
            (Some(Slip::OneTerm), Shape::Bernoulli2 | Shape::Bernoulli3) => Shape::Matched,
            (Some(Slip::NoWeights), Shape::Periodised) => Shape::Uniform,
            (_, shape) => shape,
        };
        let end = |run: &Run<'_, A>, k: u32| {
            let k = if self.slip == Some(Slip::FirstPart) { 1 } else { k };
            let share = f64::from(k) / f64::from(self.segments);
            run.number(if k == self.segments { run.length() } else { run.length() * share })
        };
        let going_on = run.number(1.0 - self.roulette);
        let (start, to) = (run.number(0.0), end(run, 1));
        let mut comb = Comb::prepare(run, (self.teeth, shape), (start.clone(), None), &to);
        let (mut product, mut thickness, mut drawn) = (run.number(1.0), start.clone(), 0);
        for segment in 1..=self.segments {
            if segment > 1 && self.slip != Some(Slip::FirstPart) {
                let to = end(run, segment);
                comb = comb.next(run, &to);
            }
            if segment == 1 || self.slip != Some(Slip::OneOrder) {
                drawn = order(run, &going_on);
            }
            let u = run.uniform();
            let first = comb.thickness(run, u);
            thickness = thickness + first.clone();
            let mut deviations = vec![start.clone()];
            for _ in 0..drawn {
                let u = run.uniform();
                deviations.push(first.clone() - comb.thickness(run, u));
            }
            product = product * series(&going_on, &deviations);
        }
        Outcome::of(product * (-thickness).exp())
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
        let mut estimator = json!({
            "kind": "unbiased_ray_marching",
            "teeth": self.teeth,
            "roulette": self.roulette,
            "segments": self.segments,
        });
        let (key, value) = match self.shape {
            Shape::Uniform | Shape::Matched => ("endpoint_matching", json!(self.shape == Shape::Matched)),
            Shape::Bernoulli2 => ("order", json!(2)),
            Shape::Bernoulli3 => ("order", json!(3)),
            Shape::Periodised => ("comb", json!("periodised")),
        };
        if key == "order" {
            estimator["comb"] = json!("bernoulli");
        }
        estimator[key] = value;
        json!({ "estimator": estimator })
    }
}

fn cases(cases: &mut Cases) {
    let of = |teeth, shape, segments| InSegments { teeth, shape, segments, roulette: 0.5, slip: None };
    for (name, model) in [
        ("bernoulli-2", of(5, Shape::Bernoulli2, 1)),
        ("bernoulli-3", of(4, Shape::Bernoulli3, 1)),
        ("periodised", of(5, Shape::Periodised, 1)),
        ("segments", of(2, Shape::Uniform, 3)),
        ("segments-matched", of(2, Shape::Matched, 2)),
    ] {
        cases.draw_some(10, &format!("{}/{name}", KIND.name), &model, Profile::SMOKE);
    }
}
