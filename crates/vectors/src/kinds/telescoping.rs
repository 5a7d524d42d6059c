//! A coarse comb and the difference that a finer one makes, at a random level (misso-2022, blanchet-2015).

use super::comb::{Comb, Shape};
use super::{Cases, Kind, Model, mistakes, u};
use crate::moments::{Moments, Shifts, of_shifts};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "telescoping",
    outputs: &["transmittance"],
    notes: &[
        ("level", "goes up by 1 as long as a new u has u >= level_ratio; its probability is r (1 - r)^level"),
        (
            "combs",
            "those of level 0 within that of level l have the variates (a + u)/2^l, a = 0 .. 2^l - 1, of one u for all",
        ),
        ("base", "the mean of exp(-X_a) over them"),
        (
            "difference",
            "exp(-X) - (exp(-X_even) + exp(-X_odd))/2 = -2 exp(-X) sinh((X_odd - X_even)/4)^2 with the means X of all, X_even of those of even a, X_odd; 0 at level 0",
        ),
        ("estimate", "base + difference/probability"),
        ("look-ups", "the ends, if matched, behind the level and before u; combs in the order of a"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Telescoping {
    teeth: u32,
    level_ratio: f64,
    shape: Shape,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    EvenHalf,
    NotDivided,
    NoRatio,
    Fine,
    FirstComb,
}

const SLIPS: [(&str, Slip); 5] = [
    ("the difference to the even half alone", Slip::EvenHalf),
    ("the difference not divided by the probability of its level", Slip::NotDivided),
    ("(1 - r)^level for r (1 - r)^level", Slip::NoRatio),
    ("exp(-X) of the finest comb for the base", Slip::Fine),
    ("the base from the first comb alone", Slip::FirstComb),
];

impl Telescoping {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }
}

impl Model for Telescoping {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (zero, length, ratio) = (run.number(0.0), run.number(run.length()), run.number(self.level_ratio));
        let mut level = 0_u32;
        while run.uniform() >= ratio {
            level += 1;
        }
        let comb = Comb::prepare(run, (self.teeth, self.shape), (zero.clone(), None), &length);
        let u = run.uniform();
        if level == 0 {
            return Outcome::of((-comb.thickness(run, u)).exp());
        }
        let scale = run.number(0.5_f64.powi(level as i32));
        let sums = [(); 3].map(|()| zero.clone());
        let [mut base, mut even, mut odd] = sums;
        for a in 0..1_u32 << level {
            let x = comb.thickness(run, (run.number(f64::from(a)) + u.clone()) * scale.clone());
            if a == 0 || !self.has(Slip::FirstComb) {
                base = base + (-x.clone()).exp();
            }
            if a % 2 == 0 {
                even = even + x;
            } else {
                odd = odd + x;
            }
        }
        let whole = (-(scale.clone() * (even.clone() + odd.clone()))).exp();
        let half = run.number(0.5) * scale.clone() * (odd - even.clone());
        let sine = half.sinh();
        let mut difference = run.number(-2.0) * whole.clone() * sine.clone() * sine;
        if self.has(Slip::EvenHalf) {
            difference = whole.clone() - (-(run.number(2.0) * scale.clone() * even)).exp();
        }
        let first = if self.has(Slip::NoRatio) { 1.0 } else { self.level_ratio };
        let mut probability = run.number(first);
        for _ in 0..level {
            probability = probability * run.number(1.0 - self.level_ratio);
        }
        if !self.has(Slip::NotDivided) {
            difference = difference / probability;
        }
        let base = match self.slip {
            Some(Slip::Fine) => whole,
            Some(Slip::FirstComb) => base,
            _ => scale * base,
        };
        Outcome::of(base + difference)
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let comb = Shifts::new(profile, self.teeth, self.shape == Shape::Matched);
        let (mut raw, mut probability) = ([0.0; 4], self.level_ratio);
        // Differences fall by four from level to level, the probabilities of levels by 8/3.
        for level in 0..14 {
            let combs = 1_u32 << level;
            let inner = |a: u32, u: f64| comb.thickness((f64::from(a) + u) / f64::from(combs));
            let folds = comb.breaks().into_iter().map(|u| (u * f64::from(combs)).fract());
            let mut breaks: Vec<f64> = folds.chain([0.0, 1.0]).collect();
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            let of_level = of_shifts(&breaks, |u| {
                let (mut base, mut sums) = (0.0, [0.0; 2]);
                for a in 0..combs {
                    let x = inner(a, u);
                    base += libm::exp(-x) / f64::from(combs);
                    sums[a as usize % 2] += x / f64::from(combs);
                }
                let sine = libm::sinh(0.5 * (sums[1] - sums[0]));
                let difference =
                    if level == 0 { 0.0 } else { -2.0 * libm::exp(-sums[0] - sums[1]) * sine * sine };
                base + difference / probability
            });
            raw = std::array::from_fn(|i| raw[i] + probability * of_level[i]);
            probability *= 1.0 - self.level_ratio;
        }
        // Higher levels add next to nothing to a base that hardly varies there. Their look-ups have no variance to be judged by.
        let [base, ..] = of_shifts(&comb.breaks(), |u| libm::exp(-comb.thickness(u)));
        let rest = probability / self.level_ratio;
        raw = std::array::from_fn(|i| raw[i] + rest * base.powi(i as i32 + 1));
        Some(Moments::of_raw("transmittance", raw, None))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": {
            "kind": KIND.name,
            "teeth": self.teeth,
            "level_ratio": self.level_ratio,
            "endpoint_matching": self.shape == Shape::Matched,
        } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |teeth, shape| Telescoping { teeth, level_ratio: 0.625, shape, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.draw_some(20, &name("2"), &of(2, Shape::Uniform), Profile::SMOKE);
    cases.draw_some(16, &name("3-matched"), &of(3, Shape::Matched), Profile::SMOKE);
    let draws = vec![u(0.625), u(0.625 - 2.0_f64.powi(-24)), u(0.5)];
    cases.tie(&name("tie/level-1-at-the-border"), &of(2, Shape::Uniform), Profile::EVEN, draws);
}
