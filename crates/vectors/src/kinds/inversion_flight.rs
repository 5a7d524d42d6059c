//! Free flights by inversion of the optical thickness (szirmay-kalos-2017 eq. 3 and 4), or by regular tracking through cells.

use super::{Cases, Kind, LARGEST, Model, given, mistakes};
use crate::moments::{Moments, coin};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "inversion_flight",
    outputs: &["distance", "weight"],
    notes: &[
        (
            "distance",
            "where the optical thickness reaches e; the length where it does not: tau <= e has escaped",
        ),
        (
            "piece",
            "of a width w with a and b at its ends, D = w (a + b)/2 and q = (e - tau(start))/D < 1: start + w q (a + b)/(a + sqrt((1 - q) a^2 + q b^2)), where nothing cancels",
        ),
        (
            "newton_flight",
            "the same distance by Newton's method within a bracket; look-ups are not compared there",
        ),
        (
            "regular_flight",
            "cell by cell, two look-ups in each at middle -+ half/sqrt(3), which sum to the thickness of a cubic; at the collision two more at middle -+ half sqrt(5/6). A cell is passed if the rest of the depth is not below its thickness",
        ),
        ("weight", "1"),
        ("variates", "one exponential"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Flight {
    /// Regular tracking, whose look-ups are the two-point rule's.
    is_regular: bool,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Linear,
    OtherRoot,
    EndIncluded,
}

const SLIPS: [(&str, Slip); 3] = [
    ("the depth's share of its piece taken for the distance's", Slip::Linear),
    ("a and b exchanged", Slip::OtherRoot),
    ("a depth that is reached at the end collides there", Slip::EndIncluded),
];

impl Model for Flight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let Profile { s, sigma_t } = run.profile();
        let [one, half, three] = [1.0, 0.5, 3.0].map(A::Number::of);
        let mut depth = run.exponential();
        for i in 1..s.len() {
            let [from, width] = [s[i - 1], s[i] - s[i - 1]].map(A::Number::of);
            let middle = from.clone() + half.clone() * width.clone();
            let reach = half.clone() * width.clone();
            let [mut a, mut b] = [sigma_t[i - 1], sigma_t[i]].map(|value| run.input(value));
            let mut thickness = half.clone() * width.clone() * (a.clone() + b.clone());
            if self.is_regular {
                let node = reach.clone() / three.sqrt();
                let inner = [middle.clone() - node.clone(), middle.clone() + node].map(|s| run.look_up(s));
                thickness = reach.clone() * (inner[0].clone() + inner[1].clone());
            }
            let is_last = i + 1 == s.len() && depth == thickness && self.slip == Some(Slip::EndIncluded);
            if depth >= thickness && !is_last {
                depth = depth - thickness;
                continue;
            }
            if self.is_regular {
                let outer = reach.clone() * (run.number(5.0) / run.number(6.0)).sqrt();
                let ends = [middle.clone() - outer.clone(), middle + outer.clone()].map(|s| run.look_up(s));
                // The cell is linear: through the outer two to its ends.
                let (sum, apart) =
                    (half.clone() * (ends[0].clone() + ends[1].clone()), ends[1].clone() - ends[0].clone());
                let slope = half.clone() * apart * (reach / outer);
                a = sum.clone() - slope.clone();
                b = sum + slope;
            }
            if self.slip == Some(Slip::OtherRoot) {
                (a, b) = (b, a);
            }
            let share = depth / thickness;
            let square =
                (one.clone() - share.clone()) * a.clone() * a.clone() + share.clone() * b.clone() * b.clone();
            let root = square.max(run.number(0.0)).sqrt();
            let fraction = if share == run.number(0.0) || self.slip == Some(Slip::Linear) {
                share
            } else {
                share * ((a.clone() + b) / (a + root))
            };
            return Outcome::collided(from + width * fraction, one);
        }
        Outcome::escaped(run.number(run.length()), one)
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        if !self.is_regular {
            return Some(coin("escaped", profile).looking_up(0.0));
        }
        let reached = |s: &f64| libm::exp(-profile.thickness(s));
        let cells: f64 = profile.s[..profile.s.len() - 1].iter().map(reached).sum();
        Some(coin("escaped", profile).looking_up(2.0 * cells + 2.0 * (1.0 - reached(&profile.length()))))
    }

    fn stated(&self) -> Value {
        json!({ "sampler": { "kind": if self.is_regular { "regular_flight" } else { KIND.name } } })
    }
}

fn cases(cases: &mut Cases) {
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let of = |is_regular| Flight { is_regular, slip: None };
    cases.draw_some(24, &name("smoke"), &of(false), Profile::SMOKE);
    cases.draw_some(12, &name("ramp"), &of(false), Profile::RAMP);
    cases.draw_some(20, &name("regular"), &of(true), Profile::SMOKE);
    cases.tie(&name("tie/end"), &of(false), Profile::EVEN, vec![given(2.0)]);
    cases.tie(&name("tie/vacuum-behind"), &of(false), Profile::SMOKE, vec![given(0.625)]);
    for (end, k) in [("smallest", 0), ("largest", LARGEST)] {
        let draws = vec![Draw::lattice(k)];
        cases.extreme(&name(&format!("extreme/{end}-variate")), &of(false), Profile::RAMP, draws);
    }
}
