//! Ratio tracking with a guess for a majorant, which every σ_t above it raises (misso-2023). Biased, consistent.

use super::{Cases, Kind, Model, given, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "progressive_majorant",
    outputs: &["transmittance_1", "transmittance_2", "transmittance_3", "majorant"],
    notes: &[
        ("three", "a case is three estimates in a row, from one guess on, and the guess behind them"),
        ("step", "s += e/guess, not e * (1/guess); s >= length is outside"),
        ("raise", "sigma_t > guess, strictly: the guess becomes sigma_t, and the estimate is 0"),
        ("weight", "else weight *= 1 - sigma_t/guess"),
        ("bias", "too high as long as the guess is no majorant: by exp(integral of max(sigma_t - guess, 0))"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct ProgressiveMajorant {
    start: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    GoesOn,
    Forgets,
    Clamped,
}

const SLIPS: [(&str, Slip); 3] = [
    ("a walk that raises the guess goes on with a negative weight", Slip::GoesOn),
    ("each estimate begins with the first guess", Slip::Forgets),
    ("a walk that raises the guess goes on with the new one", Slip::Clamped),
];

impl ProgressiveMajorant {
    fn estimate<A: Arithmetic>(&self, run: &mut Run<'_, A>, guess: &mut A::Number) -> A::Number {
        let [zero, one, length] = [0.0, 1.0, run.length()].map(A::Number::of);
        let (mut s, mut weight) = (zero.clone(), one.clone());
        loop {
            s = s + run.exponential() / guess.clone();
            if s >= length {
                return weight;
            }
            let sigma_t = run.look_up(s.clone());
            let before = guess.clone();
            if sigma_t > *guess {
                *guess = sigma_t.clone();
                if !matches!(self.slip, Some(Slip::GoesOn | Slip::Clamped)) {
                    return zero;
                }
            }
            let divisor = if self.slip == Some(Slip::Clamped) { guess.clone() } else { before };
            weight = weight * (one.clone() - sigma_t / divisor);
        }
    }
}

impl Model for ProgressiveMajorant {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let mut guess = run.number(self.start);
        let mut values = Vec::new();
        for _ in 0..3 {
            if self.slip == Some(Slip::Forgets) {
                guess = run.number(self.start);
            }
            values.push(self.estimate(run, &mut guess));
        }
        values.push(guess);
        Outcome::all(values)
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "start": self.start } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |start| ProgressiveMajorant { start, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for start in [0.25, 0.625] {
        cases.draw_some(16, &name(&start.to_string()), &of(start), Profile::SMOKE);
    }
    // σ_t = 1/2 everywhere: a guess of that is a majorant, and every factor 0.
    let draws = vec![given(1.0), given(1.0), given(2.0), given(2.0)];
    cases.tie(&name("tie/guess-not-exceeded"), &of(0.5), Profile::EVEN, draws);
}
