//! Free flights by Woodcock tracking, through a majorant that may have cells (raab-2008 algorithm 1).

use super::cells::Rates;
use super::{Cases, Kind, Model, given, mistakes, u};
use crate::moments::{Collision, Moments, breaks_at, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "woodcock_flight",
    outputs: &["distance", "weight"],
    notes: &[
        ("distance", "of the collision; the length where the flight escaped"),
        (
            "step",
            "by inversion of the majorant's depth D(s): the cell that D(s) + e is in, its start + the rest/its value",
        ),
        (
            "collision",
            "u * majorant(s) < sigma_t, strictly, with the majorant where the tentative collision is",
        ),
        ("variates", "an exponential, then a uniform variate at each look-up"),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Flight {
    majorant: Rates,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Included,
    Before,
    Restart,
}

const SLIPS: [(&str, Slip); 3] = [
    ("<= for < in the decision to collide", Slip::Included),
    ("the majorant of the cell where the step began", Slip::Before),
    ("a step through a border at the rate of the cell where it began", Slip::Restart),
];

/// One majorant for the whole profile.
const ONE: Rates = Rates { edges: &[0.0, 8.0], values: &[1.0] };
/// Bounds that touch the hill at 1/4 and at its node.
const CELLS: Rates = Rates { edges: &[0.0, 0.25, 1.0], values: &[1.25, 2.0] };

impl Model for Flight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (one, length) = (run.number(1.0), run.number(run.length()));
        let mut s = run.number(0.0);
        loop {
            let (before, depth) = (self.majorant.at(&s), run.exponential());
            let next = match self.slip {
                Some(Slip::Restart) => Some(s.clone() + depth / before.clone()).filter(|next| *next < length),
                _ => self.majorant.invert(&s, depth),
            };
            let Some(next) = next else { return Outcome::escaped(length, one) };
            s = next;
            let here = self.majorant.at(&s);
            let majorant = if self.slip == Some(Slip::Before) { before } else { here };
            let sigma_t = run.look_up(s.clone());
            let decides = run.uniform() * majorant;
            if decides < sigma_t || decides == sigma_t && self.slip == Some(Slip::Included) {
                return Outcome::collided(s, one);
            }
        }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let at = |s: f64, sigma_t: f64| {
            let rate = self.majorant.at(&s);
            Collision { rate, goes_on: 1.0 - sigma_t / rate, weight: 1.0 }
        };
        Some(product("escaped", profile, &breaks_at(profile, self.majorant.edges, &[]), (0.0, 0.0), at))
    }

    fn stated(&self) -> Value {
        json!({ "sampler": { "kind": KIND.name, "majorant": self.majorant.json() } })
    }
}

fn cases(cases: &mut Cases) {
    let of = |majorant| Flight { majorant, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.draw_some(20, &name("one"), &of(ONE), Profile::SMOKE);
    cases.draw_some(20, &name("cells"), &of(CELLS), Profile::HILL);
    cases.tie(&name("tie/end"), &of(ONE), Profile::SMOKE, vec![given(8.0)]);
    let draws = vec![Draw::lattice(0), u(0.25), given(8.0)];
    cases.tie(&name("tie/collision-at-the-border"), &of(ONE), Profile::SMOKE, draws);
    cases.tie(&name("tie/vacuum"), &of(ONE), Profile::SMOKE, vec![given(2.0), u(0.0), given(6.0)]);
    // At 1/4, behind 5/16 of depth, the majorant of the second cell holds: 5/8 of it is σ_t.
    let draws = vec![given(0.3125), u(0.625), given(1.5)];
    cases.tie(&name("tie/border-of-a-cell"), &of(CELLS), Profile::HILL, draws);
}
