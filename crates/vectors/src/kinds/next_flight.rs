//! Next-flight estimators and their combinations with ratio tracking (cramer-1978, georgiev-2019).

use super::{Cases, Kind, Model, given, mistakes};
use crate::moments::{Moments, integrate};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "next_flight",
    outputs: &["transmittance"],
    notes: &[
        ("step", "s += e/majorant, not e * (1/majorant); s >= length is outside"),
        (
            "score",
            "at the start and behind each collision, weight * q with q = exp(-majorant * (length - s))",
        ),
        ("delta", "ends at a collision with v * majorant < sigma_t, strictly; its weight is 1"),
        ("ratio", "weight *= 1 - sigma_t/majorant"),
        (
            "unidirectional",
            "ratio with weight * q/(1 + q) for weight * q; the score of the last point once more where the walk leaves",
        ),
        (
            "bidirectional",
            "the walk from the far end is drawn whole, first: s -= e/majorant while s > 0. Every pair y < z of a point of the walk from the start and one of the other, ends included, and either whole walk score weight/(2 + sum of exp(majorant * d)) over all gaps d of their path",
        ),
        ("variates", "an exponential a step; delta a uniform variate at each look-up"),
    ],
    cases,
};

#[derive(Clone, Copy, PartialEq)]
enum Version {
    Delta,
    Ratio,
    Unidirectional,
    Bidirectional,
}

#[derive(Clone, Copy)]
struct NextFlight {
    version: Version,
    majorant: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    WayFlown,
    NoStart,
    Last,
    Included,
    LastOnce,
    NoWholeWalk,
}

const SLIPS: [(&str, Slip); 6] = [
    ("exp(-majorant s) of the way flown, not of the way left", Slip::WayFlown),
    ("no score at the start", Slip::NoStart),
    ("only the last score counts", Slip::Last),
    ("<= for < in the decision to collide", Slip::Included),
    ("unidirectional: the last score not once more", Slip::LastOnce),
    ("bidirectional: the whole walk from the far end left out", Slip::NoWholeWalk),
];

/// A point of a walk: its place, the weight behind it, and Σ exp(μ d) over the gaps d before it.
#[derive(Clone)]
struct Point<N> {
    s: N,
    weight: N,
    gaps: N,
}

impl NextFlight {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }

    /// The point behind a flight forward or backward, unless it leaves.
    fn next<A: Arithmetic>(
        &self,
        run: &mut Run<'_, A>,
        from: &Point<A::Number>,
        is_forward: bool,
    ) -> Option<Point<A::Number>> {
        let (zero, length, majorant) = (run.number(0.0), run.number(run.length()), run.number(self.majorant));
        let depth = run.exponential();
        let way = depth.clone() / majorant.clone();
        let s = from.s.clone() + if is_forward { way } else { -way };
        if s <= zero || s >= length {
            return None;
        }
        let ratio = run.look_up(s.clone()) / majorant;
        let weight = from.weight.clone() * (run.number(1.0) - ratio);
        Some(Point { s, weight, gaps: from.gaps.clone() + depth.exp() })
    }

    /// Both walks, and all connections.
    fn both_ways<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> A::Number {
        let [zero, one, two, length, majorant] =
            [0.0, 1.0, 2.0, run.length(), self.majorant].map(A::Number::of);
        let score = |weight: A::Number, gaps: A::Number, gap: A::Number| {
            weight / (two.clone() + (gaps + (majorant.clone() * gap).exp()))
        };
        let first = |s: &A::Number| Point { s: s.clone(), weight: one.clone(), gaps: zero.clone() };
        let mut backward = vec![first(&length)];
        while let Some(next) = self.next(run, &backward[backward.len() - 1], false) {
            backward.push(next);
        }
        let Point { s, weight, gaps } = backward[backward.len() - 1].clone();
        let mut sum = if self.has(Slip::NoWholeWalk) { zero.clone() } else { score(weight, gaps, s) };
        let mut point = first(&zero);
        loop {
            for other in backward.iter().take_while(|other| other.s > point.s) {
                let weight = point.weight.clone() * other.weight.clone();
                let gaps = point.gaps.clone() + other.gaps.clone();
                sum = sum + score(weight, gaps, other.s.clone() - point.s.clone());
            }
            match self.next(run, &point, true) {
                Some(next) => point = next,
                None => return sum + score(point.weight, point.gaps, length - point.s),
            }
        }
    }
}

impl Model for NextFlight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        if self.version == Version::Bidirectional {
            return Outcome::of(self.both_ways(run));
        }
        let [zero, one, length, majorant] = [0.0, 1.0, run.length(), self.majorant].map(A::Number::of);
        let (mut s, mut weight, mut sum) = (zero.clone(), one.clone(), zero.clone());
        loop {
            let way = if self.has(Slip::WayFlown) { s.clone() } else { length.clone() - s.clone() };
            let straight = (-(majorant.clone() * way)).exp();
            let mut score = weight.clone() * straight.clone();
            if self.version == Version::Unidirectional {
                score = score / (one.clone() + straight);
            }
            if self.has(Slip::Last) || self.has(Slip::NoStart) && s == zero {
                sum = zero.clone();
            }
            if !(self.has(Slip::NoStart) && s == zero) {
                sum = sum + score.clone();
            }
            s = s + run.exponential() / majorant.clone();
            if s >= length {
                let again = self.version == Version::Unidirectional && !self.has(Slip::LastOnce);
                return Outcome::of(if again { sum + score } else { sum });
            }
            let sigma_t = run.look_up(s.clone());
            if self.version == Version::Delta {
                let decides = run.uniform() * majorant.clone();
                if decides < sigma_t || decides == sigma_t && self.has(Slip::Included) {
                    return Outcome::of(sum);
                }
            } else {
                weight = weight * (one.clone() - sigma_t / majorant.clone());
                run.weighs(&weight);
            }
        }
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let (mu, length) = (self.majorant, profile.length());
        let is_ratio = self.version == Version::Ratio;
        if !is_ratio && self.version != Version::Delta {
            return Some(Moments::unbiased("transmittance", profile));
        }
        // A collision at y moves the expectation by W T(y, S) (w - 1 + exp(-g)), g = mu (S - y) - tau(y, S); E[W^2] = exp(int (w^2 - 1) mu).
        let tau = |s: f64| profile.thickness(&s);
        let growth = |y: f64| {
            let mut before: Vec<f64> = profile.s.iter().copied().filter(|s| *s < y).collect();
            before.push(y);
            integrate(&before, |s| {
                let r = profile.at(&s) / mu;
                mu * if is_ratio { r * r - 2.0 * r } else { -r }
            })
        };
        let variance = integrate(profile.s, |y| {
            let (r, behind) = (profile.at(&y) / mu, tau(length) - tau(y));
            let jump = libm::exp(behind - mu * (length - y)) - r;
            let ending = if is_ratio { 0.0 } else { r * (1.0 - r) };
            mu * libm::exp(growth(y) - 2.0 * behind) * (jump * jump + ending)
        });
        let lookups = integrate(profile.s, |s| mu * if is_ratio { 1.0 } else { libm::exp(-tau(s)) });
        let known = Moments { variance: Some(variance), ..Moments::unbiased("transmittance", profile) };
        Some(known.looking_up(lookups))
    }

    fn stated(&self) -> Value {
        let version = match self.version {
            Version::Delta => "delta",
            Version::Ratio => "ratio",
            Version::Unidirectional => "unidirectional",
            Version::Bidirectional => "bidirectional",
        };
        json!({ "estimator": { "kind": KIND.name, "majorant": self.majorant, "version": version } })
    }
}

fn cases(cases: &mut Cases) {
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let of = |version, majorant| NextFlight { version, majorant, slip: None };
    for (parameters, model) in [
        ("delta", of(Version::Delta, 1.0)),
        ("ratio", of(Version::Ratio, 1.25)),
        ("unidirectional", of(Version::Unidirectional, 1.25)),
        ("bidirectional", of(Version::Bidirectional, 1.0)),
    ] {
        cases.draw_some(12, &name(parameters), &model, Profile::SMOKE);
    }
    let delta = of(Version::Delta, 1.0);
    cases.tie(&name("tie/end"), &delta, Profile::SMOKE, vec![given(8.0)]);
    // σ_t = 1/4 at the start.
    let draws = vec![Draw::lattice(0), Draw::uniform(0.25), given(8.0)];
    cases.tie(&name("tie/collision-at-the-border"), &delta, Profile::SMOKE, draws);
    // At 2^−8, σ_t is 0.2529; 256 levels take the variate 0.2534 for 1/4.
    let draws = vec![given(2.0_f64.powi(-8)), Draw::uniform(0.25 + 7.0 * 2.0_f64.powi(-11)), given(8.0)];
    cases.tie(&name("tie/between-two-of-256-levels"), &delta, Profile::SMOKE, draws);
}
