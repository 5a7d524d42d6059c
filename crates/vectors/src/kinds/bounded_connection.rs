//! The geometry term of a connection, bounded, and what the bound leaves to compensation (raab-2008 eq. 8, 14 and 15).

use super::{Cases, Kind, Model, mistakes};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "bounded_connection",
    outputs: &["geometry", "bounded", "compensation"],
    notes: &[
        (
            "points",
            "(0, 0, 0), with `normal` or in the medium, and 2^a (u + 1/4, v + 1/4, w + 1/4) in the medium",
        ),
        ("geometry", "G = |cos|/r^2 with the cosine at the surface, 1/r^2 between two points of the medium"),
        ("bounded", "min(G, bound)"),
        (
            "compensation",
            "max(G - bound, 0)/G: the weight of what is found by scattering; 0 outside the bounding region",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct Connection {
    normal: Option<[f64; 3]>,
    exponent: i32,
    bound: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    NoCosine,
    OverBound,
    Negative,
    Everything,
}

const SLIPS: [(&str, Slip); 4] = [
    ("the cosine at the surface left out", Slip::NoCosine),
    ("compensation over the bound, not over G", Slip::OverBound),
    ("compensation below 0 outside the bounding region", Slip::Negative),
    ("a compensation of 1 wherever the bound holds back", Slip::Everything),
];

impl Model for Connection {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, quarter] = [0.0, 1.0, 0.25].map(A::Number::of);
        let scale = run.number(2.0_f64.powi(self.exponent));
        let [x, y, z] = [(); 3].map(|()| scale.clone() * (run.uniform() + quarter.clone()));
        let squared = x.clone() * x.clone() + y.clone() * y.clone() + z.clone() * z.clone();
        let mut geometry = one.clone() / squared.clone();
        if let Some(normal) = self.normal.filter(|_| self.slip != Some(Slip::NoCosine)) {
            let [a, b, c] = normal.map(A::Number::of);
            let along = (a * x + b * y + c * z).abs();
            geometry = along / squared.sqrt() * geometry;
        }
        let bound = run.number(self.bound);
        let bounded = geometry.clone().min(bound.clone());
        let mut over = geometry.clone() - bound.clone();
        if self.slip != Some(Slip::Negative) {
            over = over.max(zero.clone());
        }
        let compensation = match self.slip {
            Some(Slip::OverBound) => over / bound,
            Some(Slip::Everything) => {
                if over > zero {
                    one
                } else {
                    zero
                }
            }
            _ => over / geometry.clone(),
        };
        Outcome::all([geometry, bounded, compensation])
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn stated(&self) -> Value {
        let mut connection = json!({ "bound": self.bound, "exponent": self.exponent });
        if let Some(normal) = self.normal {
            connection["normal"] = json!(normal);
        }
        json!({ "connection": connection })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    for (name, normal, exponent) in [
        ("medium", None, 0),
        ("medium-near", None, -3),
        ("surface", Some([0.0, 0.0, 1.0]), -1),
        ("surface-near", Some([1.0, 0.0, 0.0]), -4),
    ] {
        let model = Connection { normal, exponent, bound: 2.0, slip: None };
        cases.draw_some(10, &format!("{}/{name}", KIND.name), &model, Profile::EVEN);
    }
}
