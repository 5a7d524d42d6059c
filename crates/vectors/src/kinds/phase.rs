//! Phase functions beside henyey-1941's, and the direction that one leads to.

use super::{Cases, Kind, LARGEST, Model, mistakes, u};
use crate::moments::{Moments, integrate};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "phase",
    outputs: &["cosine", "phase_function"],
    notes: &[
        ("cosine", "of the angle between the direction of propagation before and behind: 1 is forward"),
        ("phase function", "per steradian, at the cosine that was drawn"),
        ("isotropic", "1 - 2u: forward at u = 0; 1/(4 pi)"),
        (
            "rayleigh",
            "the root of m^3 + 3m = 2z, z = 4u - 2: Newton from a start for |z|, with the sign of z; 3/(16 pi) (1 + cosine^2)",
        ),
        (
            "schlick",
            "1 - cosine = 2 (1 - u) (1 - k)/d, 1 + cosine = 2u (1 + k)/d, d = (1 - k)(1 - u) + (1 + k) u: the smaller of the two first; (1 - k^2)/(4 pi (1 - k cosine)^2), 1 - k cosine = ((1 - k)(1 + cosine) + (1 + k)(1 - cosine))/2",
        ),
        (
            "tabulated",
            "linear between nodes. In the piece of the first node with a distribution above u, from its thinner end: t = 2c/(a + sqrt(a^2 + 2 (b - a) c)), c the probability left over the width, a <= b the densities per cosine at the ends",
        ),
        (
            "deflection",
            "`incident` and a second variate v, the azimuth: then the first output is incident . direction of the direction that was made, whatever the frame, and the third its length",
        ),
    ],
    cases,
};

#[derive(Clone, Copy, PartialEq)]
enum Function {
    Isotropic,
    Rayleigh,
    Schlick { k: f64 },
    Tabulated,
}

#[derive(Clone, Copy)]
struct Phase {
    function: Function,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Backward,
    NotPerSteradian,
    Linear,
    NotNormalised,
}

const SLIPS: [(&str, Slip); 4] = [
    ("1 is backward", Slip::Backward),
    ("per unit of cosine, not per steradian", Slip::NotPerSteradian),
    ("tabulated: the middle of the piece", Slip::Linear),
    ("tabulated: the table not normalised", Slip::NotNormalised),
];

/// Nodes of the table: cosines, values, and the integral up to each, 5/2 in all.
const COSINES: [f64; 4] = [-1.0, 0.0, 0.5, 1.0];
const VALUES: [f64; 4] = [0.5, 0.5, 1.5, 4.5];
const INTEGRALS: [f64; 4] = [0.0, 0.5, 1.0, 2.5];

/// The cosine by the table, and the density there per unit of cosine.
fn tabulated<N: Number>(u: &N, slip: Option<Slip>) -> (N, N) {
    let [total, two] = [INTEGRALS[3], 2.0].map(N::of);
    let reached = |i: usize| N::of(INTEGRALS[i]) / total.clone();
    let end = (1..3).find(|&i| reached(i) > *u).unwrap_or(3);
    let [from, to, width] = [COSINES[end - 1], COSINES[end], COSINES[end] - COSINES[end - 1]].map(N::of);
    let [a, b] = [end - 1, end].map(|i| N::of(VALUES[i]) / total.clone());
    // All pieces rise: from the thinner end, the lower one.
    let mass = (u.clone() - reached(end - 1)) / width.clone();
    let square = a.clone() * a.clone() + two.clone() * (b.clone() - a.clone()) * mass.clone();
    let fraction = match slip {
        Some(Slip::Linear) => N::of(0.5),
        _ => two * mass / (a.clone() + square.sqrt()),
    };
    let cosine = from.clone() + width.clone() * fraction;
    let density = (a * (to - cosine.clone()) + b * (cosine.clone() - from)) / width;
    (cosine, if slip == Some(Slip::NotNormalised) { density * total } else { density })
}

/// The root of m³ + 3m = 2|z| with the sign of z.
fn rayleigh<N: Number>(u: &N) -> N {
    let [one, two, three] = [1.0, 2.0, 3.0].map(N::of);
    let z = N::of(4.0) * u.clone() - two.clone();
    let size = z.clone().abs();
    // Starts within a tenth, and each step squares the error.
    let mut root = N::of(0.6) * size.clone();
    for _ in 0..9 {
        let square = root.clone() * root.clone();
        let value = root.clone() * (square.clone() + three.clone()) - two.clone() * size.clone();
        root = root - value / (three.clone() * (square + one.clone()));
    }
    let root = root.min(one);
    if z < N::of(0.0) { -root } else { root }
}

impl Model for Phase {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let u = run.uniform();
        let [zero, one, two] = [0.0, 1.0, 2.0].map(A::Number::of);
        let pi = zero.atan2(&run.input(-1.0));
        let (cosine, value) = match self.function {
            Function::Isotropic => (one.clone() - two.clone() * u, one / (run.number(4.0) * pi.clone())),
            Function::Rayleigh => {
                let cosine = rayleigh(&u);
                let square = one + cosine.clone() * cosine.clone();
                (cosine, run.number(3.0) / (run.number(16.0) * pi.clone()) * square)
            }
            Function::Schlick { k } => {
                let k = run.input(k);
                let [back, front] = [one.clone() - k.clone(), one.clone() + k];
                let [far, near] = [back.clone() * (one.clone() - u.clone()), front.clone() * u];
                let d = far.clone() + near.clone();
                let below = two.clone() * (far / d.clone());
                let cosine =
                    if below < one { one.clone() - below } else { two.clone() * (near / d) - one.clone() };
                let root = run.number(0.5)
                    * (back.clone() * (one.clone() + cosine.clone())
                        + front.clone() * (one.clone() - cosine.clone()));
                (cosine, back * front / (run.number(4.0) * pi.clone() * root.clone() * root))
            }
            Function::Tabulated => {
                let (cosine, density) = tabulated(&u, self.slip);
                (cosine, density / (two.clone() * pi.clone()))
            }
        };
        let value = if self.slip == Some(Slip::NotPerSteradian) { two * pi * value } else { value };
        let cosine = if self.slip == Some(Slip::Backward) { -cosine } else { cosine };
        Outcome::all([cosine, value])
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, _profile: Profile) -> Option<Moments> {
        let density = |cosine: f64| match self.function {
            Function::Isotropic => 0.5,
            Function::Rayleigh => 0.375 * (1.0 + cosine * cosine),
            Function::Schlick { k } => 0.5 * (1.0 - k * k) / ((1.0 - k * cosine) * (1.0 - k * cosine)),
            Function::Tabulated => {
                let end = (1..3).find(|&i| cosine < COSINES[i]).unwrap_or(3);
                let t = (cosine - COSINES[end - 1]) / (COSINES[end] - COSINES[end - 1]);
                ((1.0 - t) * VALUES[end - 1] + t * VALUES[end]) / INTEGRALS[3]
            }
        };
        // Panels that shrink towards the peak.
        let breaks = [-1.0, 0.0, 0.5, 0.75, 0.875, 0.9375, 1.0];
        let raw =
            std::array::from_fn(|i| integrate(&breaks, |cosine| density(cosine) * cosine.powi(i as i32 + 1)));
        Some(Moments::of_raw("cosine", raw, None))
    }

    fn stated(&self) -> Value {
        json!({ "phase": match self.function {
            Function::Isotropic => json!({ "kind": "isotropic" }),
            Function::Rayleigh => json!({ "kind": "rayleigh" }),
            Function::Schlick { k } => json!({ "kind": "schlick", "k": k }),
            Function::Tabulated => json!({ "kind": "tabulated", "cosines": COSINES, "values": VALUES }),
        } })
    }

    fn looks_up(&self) -> bool {
        false
    }
}

fn cases(cases: &mut Cases) {
    let of = |function| Phase { function, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let tiny = 2.0_f64.powi(-20);
    for (parameters, function, count) in [
        ("isotropic", Function::Isotropic, 4),
        ("rayleigh", Function::Rayleigh, 24),
        ("schlick-0.75", Function::Schlick { k: 0.75 }, 16),
        ("schlick-tiny", Function::Schlick { k: -tiny }, 8),
        ("tabulated", Function::Tabulated, 24),
    ] {
        cases.draw_some(count, &name(parameters), &of(function), Profile::EVEN);
    }
    for (end, k) in [("smallest", 0), ("largest", LARGEST)] {
        for (parameters, function) in [
            ("rayleigh", Function::Rayleigh),
            ("schlick", Function::Schlick { k: 0.75 }),
            ("tabulated", Function::Tabulated),
        ] {
            let name = name(&format!("extreme/{parameters}-{end}-variate"));
            cases.extreme(&name, &of(function), Profile::EVEN, vec![Draw::lattice(k)]);
        }
    }
    let middle = vec![u(0.5)];
    cases.extreme(&name("extreme/rayleigh-middle"), &of(Function::Rayleigh), Profile::EVEN, middle);
}
