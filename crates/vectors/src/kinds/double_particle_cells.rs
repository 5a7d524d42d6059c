//! Residual ratio tracking with a sampling extinction in cells and a control that is linear between nodes (szirmay-kalos-2017 section 4.2).

use super::cells::Rates;
use super::{Cases, Kind, Model, given, mistakes};
use crate::moments::{Collision, Moments, breaks_at, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "double_particle_cells",
    outputs: &["transmittance"],
    notes: &[
        (
            "step",
            "by inversion of the depth D(s) of the sampling extinction: D(s) + e, then the cell that it is in",
        ),
        ("place", "start of the cell + (D(s) + e - D(start of the cell))/value of the cell"),
        ("border", "s at a border belongs to the cell behind it"),
        ("weight", "w *= 1 - (sigma_t - control(s))/sigma_samp(s), both at s"),
        ("control", "exp(-integral of the control) once, at the end"),
        ("variates", "one exponential a step, the last one included"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct InCells {
    sampling: Rates,
    control: Option<Profile>,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Before,
    Restart,
    NoControl,
    MeanControl,
}

const SLIPS: [(&str, Slip); 4] = [
    ("the sampling extinction of the cell where the step began", Slip::Before),
    ("a step through a border at the rate of the cell where it began", Slip::Restart),
    ("the control's transmittance left out", Slip::NoControl),
    ("the mean of the control for its value at s", Slip::MeanControl),
];

/// Half of the smoke, roughly: nodes of its own.
const HALF: Profile = Profile { s: &[0.0, 4.0, 8.0], sigma_t: &[0.25, 0.25, 0.5] };

impl Model for InCells {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (zero, one, length) = (run.number(0.0), run.number(1.0), run.number(run.length()));
        let main = self.control.map(|control| control.thickness(&run.input(run.length())));
        let (mut s, mut weight) = (zero.clone(), one.clone());
        loop {
            let (before, depth) = (self.sampling.at(&s), run.exponential());
            let next = match self.slip {
                Some(Slip::Restart) => Some(s.clone() + depth / before.clone()).filter(|next| *next < length),
                _ => self.sampling.invert(&s, depth),
            };
            let Some(next) = next else { break };
            s = next;
            let control = match (self.control, &main) {
                (Some(_), Some(main)) if self.slip == Some(Slip::MeanControl) => {
                    main.clone() / length.clone()
                }
                (Some(control), _) => control.at(&s),
                _ => zero.clone(),
            };
            let here = self.sampling.at(&s);
            let sampling = if self.slip == Some(Slip::Before) { before } else { here };
            let ratio = (run.look_up(s.clone()) - control) / sampling;
            weight = weight * (one.clone() - ratio);
            run.weighs(&weight);
        }
        let main = main.filter(|_| self.slip != Some(Slip::NoControl));
        Outcome::of(main.map_or(weight.clone(), |main| weight * (-main).exp()))
    }

    fn takes_functions(&self) -> bool {
        self.control.is_some()
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let control = self.control;
        let main = control.map_or(0.0, |control| -control.thickness(&profile.length()));
        let mut further = self.sampling.edges.to_vec();
        further.extend(control.iter().flat_map(|control| control.s));
        let at = |s: f64, sigma_t: f64| {
            let (rate, control) = (self.sampling.at(&s), control.map_or(0.0, |control| control.at(&s)));
            Collision::always(rate, 1.0 - (sigma_t - control) / rate)
        };
        Some(product("transmittance", profile, &breaks_at(profile, &further, &[]), (main, 0.0), at))
    }

    fn stated(&self) -> Value {
        let mut estimator = json!({ "kind": "double_particle", "sigma_samp": self.sampling.json() });
        if let Some(control) = self.control {
            estimator["control"] =
                json!({ "kind": "piecewise_linear", "positions": control.s, "sigma_main": control.sigma_t });
        }
        json!({ "estimator": estimator })
    }
}

fn cases(cases: &mut Cases) {
    let of = |control| InCells { sampling: Rates::TWO, control, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.draw_some(20, &name("two"), &of(None), Profile::SMOKE);
    cases.draw_some(20, &name("two-controlled"), &of(Some(HALF)), Profile::SMOKE);
    // 5/2 of depth in the first cell, 33/8 in the second.
    cases.tie(&name("tie/border"), &of(None), Profile::SMOKE, vec![given(2.5), given(4.125)]);
    cases.tie(&name("tie/end"), &of(None), Profile::SMOKE, vec![given(1.0), given(5.625)]);
}
