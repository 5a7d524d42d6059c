//! Free flights with any sampling extinction, alone or against a control that they race with: the single particle model up to its first scattering
//! (szirmay-kalos-2017 eq. 9 and 12, kutz-2017).

use super::single_particle::Version;
use super::{Cases, Kind, Model, given, mistakes, u};
use crate::moments::{Collision, Moments, breaks_at, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "tracking_flight",
    outputs: &["distance", "weight"],
    notes: &[
        ("distance", "of the collision; the length where the flight escaped"),
        ("step", "s += e * (1/sigma_samp)"),
        ("ratio", "r = (sigma_t - control)/sigma_samp, of any sign; sum = |r| + |1 - r|"),
        (
            "collision",
            "u * sum < |r|, strictly, or |1 - r| = 0; terminating and adaptive with 1 <= r, sum <= 1: u < |r|",
        ),
        (
            "weight",
            "times sum with the sign of r at a collision, with that of 1 - r at none (times 1 where it terminates)",
        ),
        (
            "decomposition_tracking",
            "a flight through the control is drawn first, e * (1/control); a tentative collision at or behind its end is not looked up: collided there, with the weight as it is",
        ),
        (
            "variates",
            "with a control an exponential first; then an exponential, and a uniform variate at each look-up",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Flight {
    version: Version,
    sigma_samp: f64,
    /// The control \[1/length\].
    control: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    NoCollisionWeight,
    NoTransmissionWeight,
    Sign,
    WithoutControl,
    ControlEscapes,
}

const SLIPS: [(&str, Slip); 5] = [
    ("a collision counts the weight before it", Slip::NoCollisionWeight),
    ("a flight goes on with its old weight", Slip::NoTransmissionWeight),
    ("the sign of 1 - r lost", Slip::Sign),
    ("the ratio of sigma_t, not of what the control leaves", Slip::WithoutControl),
    ("a flight that the control ends has escaped", Slip::ControlEscapes),
];

impl Flight {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }
}

impl Model for Flight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, sigma_samp, length] = [0.0, 1.0, self.sigma_samp, run.length()].map(A::Number::of);
        let control = run.number(self.control);
        let mut end = None;
        if self.control > 0.0 {
            let s = run.exponential() * (one.clone() / control.clone());
            end = Some(s).filter(|s| *s < length);
        }
        let less = if self.has(Slip::WithoutControl) { zero.clone() } else { control };
        let mean_free_path = one.clone() / sigma_samp.clone();
        let (mut s, mut weight) = (zero.clone(), one.clone());
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length || end.as_ref().is_some_and(|end| s >= *end) {
                return match end.filter(|_| !self.has(Slip::ControlEscapes)) {
                    Some(end) => Outcome::collided(end, weight),
                    None => Outcome::escaped(length, weight),
                };
            }
            let r = (run.look_up(s.clone()) - less.clone()) / sigma_samp.clone();
            let rest = one.clone() - r.clone();
            let (scatter, transmit) = (r.clone().abs(), rest.clone().abs());
            let sum = scatter.clone() + transmit.clone();
            let terminates = self.version.terminates(&r, &sum);
            let decides = run.uniform();
            let collides = match terminates {
                true => decides < scatter,
                false => decides * sum.clone() < scatter || transmit == zero,
            };
            let size = if terminates { one.clone() } else { sum };
            let toward = if collides { r } else { rest };
            let is_negative = toward < zero && (collides || !self.has(Slip::Sign));
            let energy = if is_negative { -size } else { size };
            if collides {
                let weight = if self.has(Slip::NoCollisionWeight) { weight } else { weight * energy };
                return Outcome::collided(s, weight);
            }
            if !self.has(Slip::NoTransmissionWeight) {
                weight = weight * energy;
            }
            run.weighs(&weight);
        }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let Self { version, sigma_samp, control, .. } = *self;
        let kinks = [0.0, 1.0].map(|r| control + r * sigma_samp);
        let at = |_: f64, sigma_t: f64| {
            let r = (sigma_t - control) / sigma_samp;
            let (transmit, sum) = ((1.0 - r).abs(), r.abs() + (1.0 - r).abs());
            let terminates = version.terminates(&r, &sum);
            let (goes_on, size) = if terminates { (transmit, 1.0) } else { (transmit / sum, sum) };
            Collision { rate: sigma_samp, goes_on, weight: size.copysign(1.0 - r) }
        };
        Some(product("escaped", profile, &breaks_at(profile, &[], &kinks), (0.0, control), at))
    }

    fn stated(&self) -> Value {
        let version = self.version.name();
        if self.control > 0.0 {
            return json!({ "sampler": {
                "kind": "decomposition_tracking",
                "version": version,
                "control": self.control,
                "sigma_samp": self.sigma_samp,
            } });
        }
        json!({ "sampler": { "kind": KIND.name, "version": version, "sigma_samp": self.sigma_samp } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |version, sigma_samp, control| Flight { version, sigma_samp, control, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for (parameters, model) in [
        ("terminating", of(Version::Terminating, 2.0, 0.0)),
        ("non-terminating", of(Version::NonTerminating, 0.75, 0.0)),
        ("adaptive", of(Version::Adaptive, 1.25, 0.0)),
        ("decomposition", of(Version::Adaptive, 0.75, 0.5)),
        ("decomposition-signed", of(Version::NonTerminating, 0.5, 0.875)),
    ] {
        cases.draw_some(20, &name(parameters), &model, Profile::HILL);
    }
    let (one, race) = (of(Version::NonTerminating, 1.0, 0.0), of(Version::NonTerminating, 1.0, 0.25));
    let mut tie = |parameters: &str, model, draws| {
        cases.tie(&name(parameters), model, Profile::SMOKE, draws);
    };
    tie("tie/end", &one, vec![given(8.0)]);
    tie("tie/not-at-the-border", &one, vec![Draw::lattice(0), u(0.25), given(8.0)]);
    tie("tie/sure-collision", &one, vec![given(1.0), u(1.0 - 2.0_f64.powi(-24))]);
    // Both at 2: the control's collision counts, and nothing is looked up.
    tie("tie/both-at-once", &race, vec![given(0.5), given(2.0)]);
    tie("tie/control-at-the-end", &race, vec![given(2.0), given(8.0)]);
}
