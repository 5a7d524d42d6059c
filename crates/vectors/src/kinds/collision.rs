//! Collisions: what leaves one, by each model (szirmay-kalos-2017 sections 3 and 4).

use super::single_particle::Version;
use super::{Cases, Kind, Model, mistakes, u};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "collision",
    outputs: &["scattered", "transmitted"],
    notes: &[
        ("outputs", "energies of the two particles, 0 of one that does not leave"),
        ("ratio", "r = (sigma_t - control)/sigma_samp"),
        ("double_particle", "albedo r and 1 - r, always; no variate"),
        (
            "woodcock",
            "u < albedo r scatters with 1, else u < r is absorbed, else transmitted with 1; 0 <= r <= 1",
        ),
        (
            "single_particle",
            "scatter = albedo |r|, transmit = |1 - r|, sum of both. Terminating (adaptive: r >= 1 and sum <= 1): u < scatter scatters, else u < sum transmits, both with 1; else u sum < scatter, or transmit = 0, scatters, else transmits, with sum; signs of r and of 1 - r",
        ),
    ],
    cases,
};

#[derive(Clone, Copy, PartialEq)]
enum Sort {
    Double,
    Woodcock,
    Single(Version),
}

#[derive(Clone, Copy)]
struct Collision {
    sort: Sort,
    albedo: f64,
    r: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Sign,
    NoAlbedo,
    NotScaled,
    Included,
}

const SLIPS: [(&str, Slip); 4] = [
    ("the sign of 1 - r lost", Slip::Sign),
    ("the albedo left out", Slip::NoAlbedo),
    ("an energy of 1 where probabilities are divided by their sum", Slip::NotScaled),
    ("<= for < in the decision to scatter", Slip::Included),
];

impl Model for Collision {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one] = [0.0, 1.0].map(A::Number::of);
        let albedo = run.input(if self.slip == Some(Slip::NoAlbedo) { 1.0 } else { self.albedo });
        let r = run.input(self.r);
        let rest = one.clone() - r.clone();
        let (scatter, transmit) = (albedo.clone() * r.clone().abs(), rest.clone().abs());
        let below = |x: &A::Number, y: &A::Number| *x < *y || *x == *y && self.slip == Some(Slip::Included);
        let of_rest = |size: A::Number| {
            if rest < zero && self.slip != Some(Slip::Sign) { -size } else { size }
        };
        let version = match self.sort {
            Sort::Double => {
                let scattered = if r < zero { -scatter } else { scatter };
                return Outcome::all([scattered, of_rest(transmit)]);
            }
            Sort::Woodcock => {
                let decides = run.uniform();
                return Outcome::all(if run.decided(below(&decides, &scatter)) {
                    [one, zero]
                } else if run.decided(decides < r) {
                    [zero.clone(), zero]
                } else {
                    [zero, one]
                });
            }
            Sort::Single(version) => version,
        };
        let sum = scatter.clone() + transmit.clone();
        let decides = run.uniform();
        let terminates = version.terminates(&r, &sum);
        let scatters = match terminates {
            true => below(&decides, &scatter),
            false => below(&(decides.clone() * sum.clone()), &scatter) || transmit == zero,
        };
        run.decided(scatters);
        let transmits = !scatters && (!terminates || decides < sum);
        run.decided(transmits);
        let size = if terminates || self.slip == Some(Slip::NotScaled) { one } else { sum };
        Outcome::all(if scatters {
            [if r < zero { -size } else { size }, zero]
        } else if transmits {
            [zero.clone(), of_rest(size)]
        } else {
            [zero.clone(), zero]
        })
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        let model = match self.sort {
            Sort::Double => json!({ "kind": "double_particle", "albedo": self.albedo }),
            Sort::Woodcock => json!({ "kind": "woodcock", "albedo": self.albedo }),
            Sort::Single(version) => {
                json!({ "kind": "single_particle", "version": version.name(), "albedo": self.albedo })
            }
        };
        json!({ "collision": model, "ratio": self.r })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let of = |sort, albedo, r| Collision { sort, albedo, r, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    for r in [-0.5, 0.25, 1.0, 1.75] {
        cases.draw_some(1, &name(&format!("double-{r}")), &of(Sort::Double, 0.75, r), Profile::EVEN);
    }
    cases.draw_some(8, &name("woodcock"), &of(Sort::Woodcock, 0.5, 0.75), Profile::EVEN);
    for (version, ratios) in [
        (Version::Terminating, [0.25, 0.75, 1.0, 1.25]),
        (Version::NonTerminating, [-0.5, 0.25, 1.0, 1.75]),
        (Version::Adaptive, [-0.5, 0.25, 1.25, 1.75]),
    ] {
        for r in ratios {
            let model = of(Sort::Single(version), 0.5, r);
            cases.draw_some(4, &name(&format!("{}-{r}", version.name())), &model, Profile::EVEN);
        }
    }
    let woodcock = of(Sort::Woodcock, 0.5, 0.5);
    cases.tie(&name("tie/woodcock-absorbed"), &woodcock, Profile::EVEN, vec![u(0.25)]);
    cases.tie(&name("tie/woodcock-transmitted"), &woodcock, Profile::EVEN, vec![u(0.5)]);
    let terminating = of(Sort::Single(Version::Terminating), 0.5, 1.25);
    cases.tie(&name("tie/transmitted"), &terminating, Profile::EVEN, vec![u(0.625)]);
    let nothing = of(Sort::Single(Version::NonTerminating), 0.0, 1.0);
    cases.tie(&name("tie/nothing-left"), &nothing, Profile::EVEN, vec![u(0.0)]);
}
