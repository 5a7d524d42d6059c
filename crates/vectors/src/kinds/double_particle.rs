//! Ratio tracking and residual ratio tracking: the double particle model at albedo 0 (szirmay-kalos-2017 eq. 12, novak-2014).

use super::{Cases, Kind, LARGEST, Model, given, mistake};
use crate::moments::{Collision, Moments, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "double_particle",
    outputs: &["transmittance"],
    notes: &[
        ("step", "s += e * (1/sigma_samp), not e/sigma_samp"),
        ("end", "s >= length is outside: no look-up there"),
        ("weight", "w *= 1 - (sigma_t - control)/sigma_samp, of any sign and size: never clamped"),
        ("control", "the product is multiplied by exp(-control * length) once, at the end"),
        ("variates", "one exponential a step, the last one included"),
    ],
    cases,
};

/// Ratio tracking at any rate, against a constant control.
struct DoubleParticle {
    /// σ_samp \[1/length\].
    sigma_samp: f64,
    /// The control \[1/length\].
    control: f64,
}

impl Model for DoubleParticle {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (one, sigma_samp, control) =
            (run.number(1.0), run.number(self.sigma_samp), run.number(self.control));
        let length = run.number(run.length());
        let mean_free_path = one.clone() / sigma_samp.clone();
        let (mut s, mut weight) = (run.number(0.0), one.clone());
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length {
                break;
            }
            let sigma_t = run.look_up(s.clone());
            weight = weight * (one.clone() - (sigma_t - control.clone()) / sigma_samp.clone());
            run.weighs(&weight);
        }
        Outcome::of(weight * (-(control * length)).exp())
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let Self { sigma_samp, control } = *self;
        let all = [
            ("weights clamped to [0, 1]", Slip::Clamped),
            ("ratio to the majorant instead of sigma_samp", Slip::ByMajorant),
            ("<= for < at the end of the profile", Slip::EndIncluded),
            ("the control's transmittance left out", Slip::NoControl),
        ];
        all.map(|(name, slip)| mistake(name, &Wrong { sigma_samp, control, slip }, script, profile)).into()
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let Self { sigma_samp, control } = *self;
        let main = -control * profile.length();
        let at = |_: f64, sigma_t: f64| Collision::always(sigma_samp, 1.0 - (sigma_t - control) / sigma_samp);
        Some(product("transmittance", profile, profile.s, (main, 0.0), at))
    }

    fn stated(&self) -> Value {
        let mut estimator = json!({ "kind": KIND.name, "sigma_samp": self.sigma_samp });
        if self.control != 0.0 {
            estimator["control"] = json!({ "kind": "constant", "sigma_t": self.control });
        }
        json!({ "estimator": estimator })
    }

    fn takes_functions(&self) -> bool {
        self.control != 0.0
    }
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Clamped,
    ByMajorant,
    EndIncluded,
    NoControl,
}

/// Tracking with a mistake.
struct Wrong {
    sigma_samp: f64,
    control: f64,
    slip: Slip,
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [one, zero, sigma_samp, control, length] =
            [1.0, 0.0, self.sigma_samp, self.control, run.length()].map(A::Number::of);
        let divisor =
            if self.slip == Slip::ByMajorant { run.number(run.majorant()) } else { sigma_samp.clone() };
        let (mut s, mut weight) = (zero.clone(), one.clone());
        loop {
            s = s + run.exponential() * (one.clone() / sigma_samp.clone());
            if s > length || s == length && self.slip != Slip::EndIncluded {
                break;
            }
            let sigma_t = run.look_up(s.clone());
            weight = weight * (one.clone() - (sigma_t - control.clone()) / divisor.clone());
            if self.slip == Slip::Clamped {
                weight = weight.max(zero.clone()).min(one.clone());
            }
        }
        let main = if self.slip == Slip::NoControl { one } else { (-(control * length)).exp() };
        Outcome::of(weight * main)
    }
}

fn cases(cases: &mut Cases) {
    let at = |sigma_samp, control| DoubleParticle { sigma_samp, control };
    for (name, model) in [
        ("1", at(1.0, 0.0)),
        ("0.75", at(0.75, 0.0)),
        ("0.3", at(0.3, 0.0)),
        ("2.5", at(2.5, 0.0)),
        ("residual-0.5", at(0.5, 0.5)),
        ("residual-0.7-0.4", at(0.7, 0.4)),
    ] {
        cases.draw(&format!("{}/{name}", KIND.name), &model, Profile::SMOKE);
    }
    let mut tie = |name: &str, draws| {
        cases.tie(&format!("{}/tie/{name}", KIND.name), &at(1.0, 0.0), Profile::SMOKE, draws);
    };
    tie("end", vec![given(8.0)]);
    tie("end-behind-a-collision", vec![given(0.5), given(7.5)]);
    tie("start", vec![Draw::lattice(0), given(8.0)]);
    tie("weight-0", vec![given(1.0), given(1.0), given(7.0)]);
    tie("node", vec![given(2.0), given(2.0), given(4.0)]);
    cases.extreme(
        &format!("{}/extreme/largest-variate", KIND.name),
        &at(1.0, 0.0),
        Profile::SMOKE,
        vec![Draw::lattice(0), Draw::lattice(1), Draw::lattice(LARGEST)],
    );
}
