//! Tracking by the single particle model: at most one particle leaves a collision (szirmay-kalos-2017 eq. 9 and 12).

use super::{Cases, Kind, LARGEST, Model, given, mistakes, u};
use crate::moments::{Collision, Moments, breaks_at, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "single_particle",
    outputs: &["transmittance"],
    notes: &[
        ("step", "s += e * (1/sigma_samp), not e/sigma_samp"),
        ("end", "s >= length is outside: no look-up there"),
        ("ratio", "r = (sigma_t - control)/sigma_samp; sum = albedo |r| + |1 - r|"),
        (
            "version",
            "terminating divides by nothing, non_terminating by sum, adaptive by sum unless r >= 1 and sum <= 1",
        ),
        ("transmission", "u < |1 - r|, or u < |1 - r|/sum, strictly; else the estimate is 0"),
        ("energy", "1, or sum, with the sign of 1 - r"),
        ("control", "the product is multiplied by exp(-control * length) once, at the end"),
        ("variates", "an exponential, then a uniform variate at each look-up, also where r = 1"),
    ],
    cases,
};

/// A rule for the probabilities of a collision.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Version {
    Terminating,
    NonTerminating,
    Adaptive,
}

impl Version {
    /// Name, as specs have it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Terminating => "terminating",
            Self::NonTerminating => "non_terminating",
            Self::Adaptive => "adaptive",
        }
    }

    /// True where the probabilities are a|r| and |1 − r| themselves; else they are divided by their sum.
    pub(super) fn terminates<N: Number>(self, r: &N, sum: &N) -> bool {
        match self {
            Self::Terminating => true,
            Self::NonTerminating => false,
            Self::Adaptive => *r >= N::of(1.0) && *sum <= N::of(1.0),
        }
    }
}

#[derive(Clone, Copy)]
struct SingleParticle {
    version: Version,
    albedo: f64,
    /// σ_samp \[1/length\].
    sigma_samp: f64,
    /// The control \[1/length\].
    control: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Sign,
    Included,
    NoAlbedo,
    Kept,
    NotScaled,
}

const SLIPS: [(&str, Slip); 5] = [
    ("the sign of 1 - r lost", Slip::Sign),
    ("<= for < in the decision to go on", Slip::Included),
    ("the albedo left out of the sum", Slip::NoAlbedo),
    ("a walk that ends counts for what it had", Slip::Kept),
    ("an energy of 1 where probabilities are divided by their sum", Slip::NotScaled),
];

impl Model for SingleParticle {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, sigma_samp, control, length] =
            [0.0, 1.0, self.sigma_samp, self.control, run.length()].map(A::Number::of);
        let albedo = run.number(if self.slip == Some(Slip::NoAlbedo) { 1.0 } else { self.albedo });
        let mean_free_path = one.clone() / sigma_samp.clone();
        let main = (-(control.clone() * length.clone())).exp();
        let (mut s, mut weight) = (zero.clone(), one.clone());
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length {
                return Outcome::of(weight * main);
            }
            let r = (run.look_up(s.clone()) - control.clone()) / sigma_samp.clone();
            let rest = one.clone() - r.clone();
            let transmit = rest.clone().abs();
            let sum = albedo.clone() * r.clone().abs() + transmit.clone();
            let terminates = self.version.terminates(&r, &sum);
            let probability = if terminates || transmit == zero { transmit } else { transmit / sum.clone() };
            let decides = run.uniform();
            if decides > probability || decides == probability && self.slip != Some(Slip::Included) {
                return Outcome::of(if self.slip == Some(Slip::Kept) { weight * main } else { zero });
            }
            let size = if terminates || self.slip == Some(Slip::NotScaled) { one.clone() } else { sum };
            let is_negative = rest < zero && self.slip != Some(Slip::Sign);
            weight = weight * if is_negative { -size } else { size };
            run.weighs(&weight);
        }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let Self { version, albedo, sigma_samp, control, .. } = *self;
        let kinks = [0.0, 1.0, 2.0 / (1.0 + albedo)].map(|r| control + r * sigma_samp);
        let at = |_: f64, sigma_t: f64| {
            let r = (sigma_t - control) / sigma_samp;
            let (transmit, sum) = ((1.0 - r).abs(), albedo * r.abs() + (1.0 - r).abs());
            let terminates = version.terminates(&r, &sum);
            let (goes_on, size) = if terminates { (transmit, 1.0) } else { (transmit / sum, sum) };
            Collision { rate: sigma_samp, goes_on, weight: size.copysign(1.0 - r) }
        };
        let breaks = breaks_at(profile, &[], &kinks);
        Some(product("transmittance", profile, &breaks, (-control * profile.length(), 0.0), at))
    }

    fn stated(&self) -> Value {
        let mut estimator = json!({
            "kind": KIND.name,
            "version": self.version.name(),
            "albedo": self.albedo,
            "sigma_samp": self.sigma_samp,
        });
        if self.control != 0.0 {
            estimator["control"] = json!({ "kind": "constant", "sigma_main": self.control });
        }
        json!({ "estimator": estimator })
    }

    fn takes_functions(&self) -> bool {
        self.control != 0.0
    }
}

fn cases(cases: &mut Cases) {
    let of = |version, albedo, sigma_samp, control| SingleParticle {
        version,
        albedo,
        sigma_samp,
        control,
        slip: None,
    };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for (parameters, model) in [
        ("terminating", of(Version::Terminating, 0.5, 1.75, 0.0)),
        ("non-terminating", of(Version::NonTerminating, 0.75, 1.0, 0.0)),
        ("adaptive", of(Version::Adaptive, 0.5, 1.25, 0.0)),
        ("adaptive-residual", of(Version::Adaptive, 0.25, 0.75, 0.625)),
    ] {
        cases.draw_some(24, &name(parameters), &model, Profile::HILL);
    }
    let one = of(Version::Adaptive, 0.5, 1.0, 0.0);
    let terminating = of(Version::Terminating, 0.5, 1.0, 0.0);
    // r = 1/4 at the start, where a terminating particle is transmitted with 3/4; 1 at the node at 1, where it never is.
    let mut tie = |parameters: &str, model, draws| {
        cases.tie(&name(parameters), model, Profile::SMOKE, draws);
    };
    tie("tie/ended-at-the-border", &terminating, vec![Draw::lattice(0), u(0.75)]);
    let below = u(0.75 - 2.0_f64.powi(-24));
    tie("tie/transmitted-below-the-border", &terminating, vec![Draw::lattice(0), below, given(8.0)]);
    tie("tie/no-transmission", &one, vec![given(1.0), u(0.0)]);
    tie("tie/vacuum", &one, vec![given(2.0), u(1.0 - 2.0_f64.powi(-24)), given(6.0)]);
    tie("tie/end", &one, vec![given(8.0)]);
    let draws = vec![Draw::lattice(1), Draw::lattice(0), Draw::lattice(LARGEST)];
    cases.extreme(&name("extreme/largest-variate"), &terminating, Profile::SMOKE, draws);
}
