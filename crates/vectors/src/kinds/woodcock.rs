//! Woodcock tracking as an estimator of transmittance (raab-2008 algorithm 1).

use super::{Cases, Kind, LARGEST, Model, given, mistake, u};
use crate::moments::{Collision, Moments, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "woodcock",
    outputs: &["transmittance"],
    notes: &[
        ("step", "s += e * (1/majorant), not e/majorant"),
        ("end", "s >= length is outside: no look-up there"),
        ("collision", "u * majorant < sigma_t, strictly: u is in [0, 1)"),
        ("variates", "an exponential, then a uniform variate at each look-up"),
    ],
    cases,
};

struct Woodcock;

impl Model for Woodcock {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (majorant, length) = (run.number(run.majorant()), run.number(run.length()));
        let mean_free_path = run.number(1.0) / majorant.clone();
        let mut s = run.number(0.0);
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length {
                return Outcome::of(run.number(1.0));
            }
            let sigma_t = run.look_up(s.clone());
            if run.uniform() * majorant.clone() < sigma_t {
                return Outcome::of(run.number(0.0));
            }
        }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let all = [
            ("<= for < in the decision to collide", Slip::Collides),
            ("<= for < at the end of the profile", Slip::EndIncluded),
            ("1 - sigma_t/majorant as the probability of a collision", Slip::Reversed),
        ];
        all.map(|(name, slip)| mistake(name, &slip, script, profile)).into()
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let rate = profile.majorant();
        let at = |_: f64, sigma_t: f64| Collision { rate, goes_on: 1.0 - sigma_t / rate, weight: 1.0 };
        Some(product("transmittance", profile, profile.s, (0.0, 0.0), at))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name } })
    }
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Collides,
    EndIncluded,
    Reversed,
}

impl Model for Slip {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [one, majorant, length] = [1.0, run.majorant(), run.length()].map(A::Number::of);
        let mut s = run.number(0.0);
        loop {
            s = s + run.exponential() * (one.clone() / majorant.clone());
            if s > length || s == length && *self != Self::EndIncluded {
                return Outcome::of(one);
            }
            let (sigma_t, sample) = (run.look_up(s.clone()), run.uniform() * majorant.clone());
            let collides = match self {
                Self::Collides => sample <= sigma_t,
                Self::EndIncluded => sample < sigma_t,
                Self::Reversed => sample >= sigma_t,
            };
            if collides {
                return Outcome::of(run.number(0.0));
            }
        }
    }
}

fn cases(cases: &mut Cases) {
    cases.draw(&format!("{}/smoke", KIND.name), &Woodcock, Profile::SMOKE);
    cases.draw(&format!("{}/even", KIND.name), &Woodcock, Profile::EVEN);
    let mut tie = |name: &str, draws| {
        cases.tie(&format!("{}/tie/{name}", KIND.name), &Woodcock, Profile::SMOKE, draws);
    };
    tie("end", vec![given(8.0)]);
    // σ_t = 1/4 at 0, 0 at 2, 1 at 1.
    tie("collision-at-the-border", vec![Draw::lattice(0), u(0.25), given(8.0)]);
    tie("collision-below-the-border", vec![Draw::lattice(0), u(0.25 - 2.0_f64.powi(-24))]);
    tie("vacuum", vec![given(2.0), u(0.0), given(6.0)]);
    tie("majorant", vec![given(1.0), u(1.0 - 2.0_f64.powi(-24))]);
    let largest = || Draw::lattice(LARGEST);
    cases.extreme(
        &format!("{}/extreme/largest-variate", KIND.name),
        &Woodcock,
        Profile::SMOKE,
        vec![Draw::lattice(1), largest(), largest()],
    );
}
