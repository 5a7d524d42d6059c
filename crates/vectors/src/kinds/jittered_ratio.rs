//! Jittered ratio tracking: a random alternating series in each stratum.

use super::{Cases, Kind, LARGEST, Model, mistake, u};
use crate::moments::{Moments, strata};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "jittered_ratio",
    outputs: &["transmittance"],
    notes: &[
        (
            "strata",
            "max(1, ceil(majorant * length/epsilon)) of them; e = min(majorant * length/strata, epsilon)",
        ),
        (
            "order",
            "one variate u a stratum; a = e/2; while u < a, strictly, the order n grows by 1 and a *= e/(n + 1)",
        ),
        ("bracket", "from the innermost point outwards: b = 1 - r b, then the next point"),
        ("last", "a point is at most the number below the end (in binary32: of binary32)"),
        ("variates", "u of the order, then one for each point, first drawn innermost"),
    ],
    cases,
};

struct JitteredRatio {
    epsilon: f64,
}

impl Model for JitteredRatio {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (one, majorant) = (run.number(1.0), run.number(run.majorant()));
        let thickness = run.majorant() * run.length();
        let count = (thickness / self.epsilon).ceil().max(1.0);
        let width = run.number(run.length() / count);
        let e = run.number((thickness / count).min(self.epsilon));
        let last = run.number(run.length().next_down());
        let mut product = one.clone();
        for stratum in 0..count as u32 {
            let decides = run.uniform();
            let (mut order, mut at_least) = (1_u32, run.number(0.5) * e.clone());
            while decides < at_least {
                order += 1;
                at_least = at_least * (e.clone() / run.number(f64::from(order + 1)));
            }
            let (mut bracket, mut r) = (one.clone(), run.number(0.0));
            for _ in 0..order {
                bracket = one.clone() - r * bracket;
                let s = (run.number(f64::from(stratum)) + run.uniform()) * width.clone();
                r = run.look_up(s.min(last.clone())) / majorant.clone();
            }
            product = product * (one.clone() - e.clone() * (r * bracket));
            run.weighs(&product);
        }
        Outcome::of(product)
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let epsilon = self.epsilon;
        let all = [
            ("<= for < in the decision of the order", Slip::Order),
            ("the series from the outermost point inwards", Slip::Outermost),
            ("points in world units, not in strata", Slip::WorldUnits),
            ("e/n for e/(n + 1) in the probabilities of orders", Slip::Probability),
        ];
        all.map(|(name, slip)| mistake(name, &Wrong { epsilon, slip }, script, profile)).into()
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let whole = [0.0, profile.length(), 0.0, profile.majorant()];
        Some(strata(profile, std::iter::once(whole), self.epsilon))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "epsilon": self.epsilon } })
    }
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Order,
    Outermost,
    WorldUnits,
    Probability,
}

/// Jittered ratio tracking with a mistake.
struct Wrong {
    epsilon: f64,
    slip: Slip,
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let thickness = run.majorant() * run.length();
        let count = (thickness / self.epsilon).ceil().max(1.0);
        let (least, most) = (run.number(0.0), run.number(run.length().next_down()));
        let [one, majorant, width, e] =
            [1.0, run.majorant(), run.length() / count, (thickness / count).min(self.epsilon)]
                .map(A::Number::of);
        let mut product = one.clone();
        for stratum in 0..count as u32 {
            let (decides, mut order) = (run.uniform(), 1_u32);
            let mut at_least = run.number(0.5) * e.clone();
            // At u = 0 a port with <= never ends once the probability is 0; here it does behind all variates.
            let ends = |order: u32| order as usize > super::MOST_DRAWS;
            while decides < at_least || decides == at_least && self.slip == Slip::Order && !ends(order) {
                order += 1;
                let divisor = if self.slip == Slip::Probability { order } else { order + 1 };
                at_least = at_least * (e.clone() / run.number(f64::from(divisor)));
            }
            let mut ratios = Vec::new();
            for _ in 0..order {
                let (place, u) = (run.number(f64::from(stratum)), run.uniform());
                let s = match self.slip {
                    Slip::WorldUnits => place * width.clone() + u,
                    _ => (place + u) * width.clone(),
                };
                ratios.push(run.look_up(s.max(least.clone()).min(most.clone())) / majorant.clone());
            }
            if self.slip == Slip::Outermost {
                ratios.reverse();
            }
            let (mut bracket, mut r) = (one.clone(), run.number(0.0));
            for ratio in ratios {
                bracket = one.clone() - r * bracket;
                r = ratio;
            }
            product = product * (one.clone() - e.clone() * (r * bracket));
        }
        Outcome::of(product)
    }
}

fn cases(cases: &mut Cases) {
    for epsilon in [1.0, 0.5, 0.3] {
        cases.draw(&format!("{}/{epsilon}", KIND.name), &JitteredRatio { epsilon }, Profile::SMOKE);
    }
    let half = JitteredRatio { epsilon: 0.5 };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    // Four strata of e = 1/2: the order is at least 2 below 1/4, and at least 3 below 1/24, which is no dyadic number.
    let rest = || [u(0.75), u(0.5), u(0.5), u(0.25), u(0.25), u(0.5)];
    let strata = |first: [Draw; 2]| first.into_iter().chain(rest()).collect::<Vec<_>>();
    cases.tie(&name("tie/order-1-at-the-border"), &half, Profile::EVEN, strata([u(0.25), u(0.5)]));
    let below = [u(0.25 - 2.0_f64.powi(-24)), u(0.5), u(0.75)].into_iter().chain(rest()).collect();
    cases.tie(&name("tie/order-2-below-the-border"), &half, Profile::EVEN, below);
    let largest = || Draw::lattice(LARGEST);
    let all = (0..8).map(|_| largest()).collect();
    cases.extreme(&name("extreme/largest-variate"), &half, Profile::EVEN, all);
}
