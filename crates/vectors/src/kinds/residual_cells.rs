//! Residual ratio tracking between bounds in cells.

use super::cells::Bounds;
use super::{Cases, Kind, Model, given, mistakes};
use crate::moments::{Collision, Moments, breaks_at, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "residual_cells",
    outputs: &["transmittance"],
    notes: &[
        ("sampling", "rate * (majorant - minorant) of the cell; nothing is looked up where that is 0"),
        (
            "step",
            "s += depth/sampling, not times its reciprocal; a step to the end of the cell or beyond leaves it",
        ),
        (
            "next cell",
            "what a cell does not use up of a depth is left for the next: depth - sampling * (end - s), at least 0. No exponential is drawn at a border",
        ),
        ("weight", "weight *= 1 - (sigma_t - minorant)/sampling"),
        ("control", "exp(-sum of minorant * width) once, at the end"),
        ("variates", "an exponential at the start, and one behind each look-up"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct ResidualCells {
    cells: Bounds,
    rate: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Again,
    WithoutMinorant,
    ByRange,
    NoControl,
}

const SLIPS: [(&str, Slip); 4] = [
    ("a depth drawn anew at each border, and the rest kept", Slip::Again),
    ("sigma_t for sigma_t - minorant in the weight", Slip::WithoutMinorant),
    ("the ratio to the range, not to rate times it", Slip::ByRange),
    ("the minorants' transmittance left out", Slip::NoControl),
];

impl Model for ResidualCells {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (zero, one) = (run.number(0.0), run.number(1.0));
        let (mut weight, mut thickness) = (one.clone(), 0.0);
        let mut depth = run.exponential();
        for [from, to, minorant, majorant] in self.cells.cells() {
            thickness += minorant * (to - from);
            let range = run.number(majorant - minorant);
            let sampling = run.number(self.rate) * range.clone();
            if sampling <= zero {
                continue;
            }
            let (mut s, to) = (run.number(from), run.number(to));
            loop {
                let next = s.clone() + depth.clone() / sampling.clone();
                if next >= to {
                    depth = (depth - sampling.clone() * (to - s)).max(zero.clone());
                    break;
                }
                s = next;
                let sigma_t = run.look_up(s.clone());
                let less = if self.slip == Some(Slip::WithoutMinorant) { 0.0 } else { minorant };
                let divisor = if self.slip == Some(Slip::ByRange) { range.clone() } else { sampling.clone() };
                weight = weight * (one.clone() - (sigma_t - run.number(less)) / divisor);
                run.weighs(&weight);
                depth = run.exponential();
            }
            if self.slip == Some(Slip::Again) {
                depth = depth + run.exponential();
            }
        }
        if self.slip == Some(Slip::NoControl) {
            return Outcome::of(weight);
        }
        Outcome::of(weight * (-run.input(thickness)).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let control: f64 = self.cells.cells().map(|[from, to, minorant, _]| minorant * (to - from)).sum();
        let breaks = breaks_at(profile, self.cells.edges, &[]);
        let at = |s: f64, sigma_t: f64| {
            let [_, _, minorant, majorant] = self.cells.at(s);
            let rate = self.rate * (majorant - minorant);
            Collision::always(rate, if rate > 0.0 { 1.0 - (sigma_t - minorant) / rate } else { 1.0 })
        };
        Some(product("transmittance", profile, &breaks, (-control, 0.0), at))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "cells": self.cells.json(), "rate": self.rate } })
    }
}

fn cases(cases: &mut Cases) {
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for rate in [1.0, 0.5, 2.0] {
        let model = ResidualCells { cells: Bounds::SMOKE, rate, slip: None };
        cases.draw_some(16, &name(&rate.to_string()), &model, Profile::SMOKE);
    }
    // 3/4 of depth in the first cell, none in the second.
    let model = ResidualCells { cells: Bounds::EVEN, rate: 1.0, slip: None };
    cases.tie(&name("tie/end-of-a-cell"), &model, Profile::EVEN, vec![given(0.75)]);
    cases.tie(&name("tie/start-of-a-cell"), &model, Profile::EVEN, vec![given(0.0), given(2.0)]);
}
