//! The phase function of henyey-1941, from backward to forward, without a division by g.

use super::{Cases, Kind, LARGEST, Model, mistake, u};
use crate::moments::Moments;
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "henyey_greenstein",
    outputs: &["cosine", "phase_function"],
    notes: &[
        ("cosine", "of the angle between the direction of propagation before and behind: 1 is forward"),
        (
            "usual inversion",
            "(1 + g^2 - ((1 - g^2)/(1 - g + 2 g u))^2)/(2 g) loses all digits near g = 0, and is 0/0 at it",
        ),
        (
            "stable",
            "d = (1 - g)(1 - u) + (1 + g) u; 1 - cosine = 2 (1 - u) ((1 - g)/d)^2 ((1 - u) + (1 + g) u); 1 + cosine = 2 u ((1 + g)/d)^2 ((1 - g)(1 - u) + u)",
        ),
        (
            "phase function",
            "per steradian, at the cosine that was drawn; 1 + g^2 - 2 g cosine = ((1 - g)^2 (1 + cosine) + (1 + g)^2 (1 - cosine))/2",
        ),
    ],
    cases,
};

struct HenyeyGreenstein {
    g: f64,
}

impl Model for HenyeyGreenstein {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (one, two, g, u) = (run.number(1.0), run.number(2.0), run.input(self.g), run.uniform());
        let (back, front, rest) = (one.clone() - g.clone(), one.clone() + g, one.clone() - u.clone());
        let d = back.clone() * rest.clone() + front.clone() * u.clone();
        let [near, far] = [&back, &front].map(|side| side.clone() / d.clone());
        let below =
            two.clone() * rest.clone() * near.clone() * near * (rest.clone() + front.clone() * u.clone());
        let cosine = if below < one {
            one.clone() - below
        } else {
            two * u.clone() * far.clone() * far * (back.clone() * rest + u) - one.clone()
        };
        let square = run.number(0.5)
            * (back.clone() * back.clone() * (one.clone() + cosine.clone())
                + front.clone() * front.clone() * (one - cosine.clone()));
        let pi = run.number(0.0).atan2(&run.number(-1.0));
        let value = back * front / (run.number(4.0) * pi * square.clone() * square.sqrt());
        Outcome { event: None, values: vec![cosine, value] }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let g = self.g;
        let all = [
            ("the usual inversion, which divides by g", Slip::Divides),
            ("g of the other sign: 1 is backward", Slip::Backward),
            ("not divided by 4 pi", Slip::NotPerSteradian),
        ];
        all.map(|(name, slip)| mistake(name, &Wrong { g, slip }, script, profile)).into()
    }

    fn moments(&self, _profile: Profile) -> Option<Moments> {
        let (g, variance) = (self.g, (1.0 + 2.0 * self.g * self.g) / 3.0 - self.g * self.g);
        // Nearer to 1 a mean of cosines is far from normal at any usual number of them.
        let moments =
            Moments { of: "cosine", mean: g, variance: Some(variance), fourth: None, lookups: None };
        (g.abs() < 0.9).then_some(moments)
    }

    fn stated(&self) -> Value {
        json!({ "phase": { "kind": KIND.name, "g": self.g } })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Divides,
    Backward,
    NotPerSteradian,
}

/// The phase function with a mistake.
struct Wrong {
    g: f64,
    slip: Slip,
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let side = if self.slip == Slip::Backward { -1.0 } else { 1.0 };
        let Outcome { event, mut values } = HenyeyGreenstein { g: side * self.g }.run(run);
        match self.slip {
            Slip::Backward => {}
            Slip::NotPerSteradian => values[1] = values[1].clone() * run.number(4.0 * std::f64::consts::PI),
            Slip::Divides if self.g != 0.0 => {
                let u = run.drawn(0);
                let [one, two, g] = [1.0, 2.0, self.g].map(A::Number::of);
                let square = g.clone() * g.clone();
                let d = one.clone() - g.clone() + two.clone() * g.clone() * u;
                let inner = (one.clone() - square.clone()) / d;
                values[0] = (one + square - inner.clone() * inner) / (two * g);
            }
            Slip::Divides => {}
        }
        Outcome { event, values }
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let (tiny, far) = (2.0_f64.powi(-20), 1.0 - 2.0_f64.powi(-12));
    for g in [0.75, -0.5, tiny, -tiny, far] {
        cases.draw(&format!("{}/{g}", KIND.name), &HenyeyGreenstein { g }, Profile::EVEN);
    }
    cases.tie(
        &format!("{}/tie/isotropic", KIND.name),
        &HenyeyGreenstein { g: 0.0 },
        Profile::EVEN,
        vec![u(0.75)],
    );
    for (name, g, k) in [("smallest", 0.75, 0), ("largest", far, LARGEST), ("largest-back", -far, LARGEST)] {
        let name = format!("{}/extreme/{name}-variate", KIND.name);
        cases.extreme(&name, &HenyeyGreenstein { g }, Profile::EVEN, vec![Draw::lattice(k)]);
    }
}
