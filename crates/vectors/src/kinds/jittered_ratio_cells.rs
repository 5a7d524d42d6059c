//! Jittered ratio tracking between the bounds of each cell.

use super::cells::Bounds;
use super::{Cases, Kind, Model, mistakes};
use crate::moments::{Moments, strata};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "jittered_ratio_cells",
    outputs: &["transmittance"],
    notes: &[
        (
            "strata",
            "of each cell ceil((majorant - minorant) * width/epsilon), at least one, none where that is 0; e = min(thickness/strata, epsilon)",
        ),
        ("order", "that of jittered_ratio: u < a, a = e/2, then a *= e/(n + 1)"),
        ("ratio", "r = (sigma_t - minorant)/(majorant - minorant)"),
        ("places", "start of the cell + (i + u) * width of a stratum, below the end of the cell"),
        ("control", "exp(-sum of minorant * width) once, at the end"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct InCells {
    cells: Bounds,
    epsilon: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    WithoutMinorant,
    Start,
    NoControl,
}

const SLIPS: [(&str, Slip); 3] = [
    ("sigma_t for sigma_t - minorant in the ratio", Slip::WithoutMinorant),
    ("places from the start of the ray, not of the cell", Slip::Start),
    ("the minorants' transmittance left out", Slip::NoControl),
];

impl Model for InCells {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (zero, one) = (run.number(0.0), run.number(1.0));
        let (mut product, mut control) = (one.clone(), 0.0);
        for [from, to, minorant, majorant] in self.cells.cells() {
            control += minorant * (to - from);
            let thickness = (majorant - minorant) * (to - from);
            let count = if thickness > 0.0 { (thickness / self.epsilon).ceil().max(1.0) } else { 0.0 };
            let width = run.number((to - from) / count.max(1.0));
            let e = run.number((thickness / count.max(1.0)).min(self.epsilon));
            let (range, last) = (run.number(majorant - minorant), run.number(to.next_down()));
            let less = run.number(if self.slip == Some(Slip::WithoutMinorant) { 0.0 } else { minorant });
            let start = run.number(if self.slip == Some(Slip::Start) { 0.0 } else { from });
            for stratum in 0..count as u32 {
                let decides = run.uniform();
                let (mut order, mut at_least) = (1_u32, run.number(0.5) * e.clone());
                while decides < at_least {
                    order += 1;
                    at_least = at_least * (e.clone() / run.number(f64::from(order + 1)));
                }
                let (mut bracket, mut r) = (one.clone(), zero.clone());
                for _ in 0..order {
                    bracket = one.clone() - r * bracket;
                    let within = (run.number(f64::from(stratum)) + run.uniform()) * width.clone();
                    let s = (start.clone() + within).min(last.clone());
                    r = (run.look_up(s) - less.clone()) / range.clone();
                }
                product = product * (one.clone() - e.clone() * (r * bracket));
                run.weighs(&product);
            }
        }
        if self.slip == Some(Slip::NoControl) {
            return Outcome::of(product);
        }
        Outcome::of(product * (-run.input(control)).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        Some(strata(profile, self.cells.cells(), self.epsilon))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": "jittered_ratio", "cells": self.cells.json(), "epsilon": self.epsilon } })
    }
}

fn cases(cases: &mut Cases) {
    for (name, cells, epsilon, profile) in [
        ("smoke-1", Bounds::SMOKE, 1.0, Profile::SMOKE),
        ("smoke-0.5", Bounds::SMOKE, 0.5, Profile::SMOKE),
        ("even-0.5", Bounds::EVEN, 0.5, Profile::EVEN),
    ] {
        let model = InCells { cells, epsilon, slip: None };
        cases.draw_some(12, &format!("{}/{name}", KIND.name), &model, profile);
    }
}
