//! The line integral of raab-2008 algorithm 2: Woodcock flights whose first steps are stratified.

use super::{Cases, Kind, Model, mistakes};
use crate::moments::{Moments, integrate};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "line_integral",
    outputs: &["transmittance"],
    notes: &[
        ("certain", "p = 1 - exp(-majorant * length), as -expm1: a collision with the majorant's medium"),
        (
            "first step",
            "flight k begins with the depth -ln(1 - (k + u)/splits * p), as -log1p, of one u for all",
        ),
        ("step", "s += depth * (1/majorant); depths behind the first are exponentials"),
        ("end", "s >= length is outside: no look-up there, and the flight has escaped"),
        ("collision", "v * majorant < sigma_t, strictly"),
        ("sum", "exp(-majorant * length) + escaped * (p/splits)"),
        (
            "variates",
            "u; then of each flight a uniform variate at each look-up, and an exponential behind it",
        ),
    ],
    cases,
};

#[derive(Clone, Copy)]
struct LineIntegral {
    majorant: f64,
    splits: u32,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Logarithm,
    NotConditioned,
    NotScaled,
    WithoutStraight,
}

const SLIPS: [(&str, Slip); 4] = [
    ("-ln(u) for -ln(1 - u) in the first step, as printed", Slip::Logarithm),
    ("first variates in [0, 1), not below p", Slip::NotConditioned),
    ("escapes not times p", Slip::NotScaled),
    ("what passes the majorant's medium left out", Slip::WithoutStraight),
];

impl LineIntegral {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }
}

impl Model for LineIntegral {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [zero, one, majorant, length, splits] =
            [0.0, 1.0, self.majorant, run.length(), f64::from(self.splits)].map(A::Number::of);
        // An input, so that p errs: −expm1(−μL) of two constants would be exact.
        let depth = run.input(self.majorant * run.length());
        let (p, straight) = (-(-depth.clone()).exp_m1(), (-depth).exp());
        let mean_free_path = one.clone() / majorant.clone();
        let (shift, mut escaped) = (run.uniform(), zero.clone());
        for k in 0..self.splits {
            let share = (run.number(f64::from(k)) + shift.clone()) / splits.clone();
            let variate = if self.has(Slip::NotConditioned) { share } else { share * p.clone() };
            // Of 0 the printed logarithm is infinite: such a flight escapes.
            let mut depth = match self.has(Slip::Logarithm) {
                true if variate == zero => length.clone() * majorant.clone(),
                true => -(variate - one.clone()).ln_1p(),
                false => -(-variate).ln_1p(),
            };
            let mut s = zero.clone();
            loop {
                s = s + depth * mean_free_path.clone();
                if s >= length {
                    escaped = escaped + one.clone();
                    break;
                }
                let sigma_t = run.look_up(s.clone());
                if run.uniform() * majorant.clone() < sigma_t {
                    break;
                }
                depth = run.exponential();
            }
        }
        let share = if self.has(Slip::NotScaled) { one / splits } else { p / splits };
        let straight = if self.has(Slip::WithoutStraight) { zero } else { straight };
        Outcome::of(straight + escaped * share)
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let (majorant, length, n) = (self.majorant, profile.length(), f64::from(self.splits));
        let (p, tau) = (-libm::expm1(-majorant * length), |s: f64| profile.thickness(&s));
        // The probability that a flight escapes whose first variate is u p.
        let escapes = |u: f64| {
            let s = (-libm::log1p(-u * p) / majorant).min(length);
            (1.0 - profile.at(&s) / majorant) * libm::exp(tau(s) - tau(length))
        };
        let mut breaks = vec![0.0, 1.0];
        breaks.extend(profile.s.iter().map(|s| (-libm::expm1(-majorant * s) / p * n).fract()));
        breaks.sort_by(f64::total_cmp);
        // Given the shift, flights are independent coins: E[count^2] = E[sum g (1 - g) + (sum g)^2].
        let sum = |shift: f64, f: &dyn Fn(f64) -> f64| -> f64 {
            (0..self.splits).map(|k| f(escapes((f64::from(k) + shift) / n))).sum()
        };
        let mean = integrate(&breaks, |shift| sum(shift, &|g| g));
        let second = integrate(&breaks, |shift| sum(shift, &|g| g * (1.0 - g)) + sum(shift, &|g| g).powi(2));
        let variance = Some((second - mean * mean) * (p / n) * (p / n));
        // Woodcock's look-ups, of flights that collide with the majorant's medium.
        let lookups = n * integrate(profile.s, |s| majorant * libm::exp(-tau(s))) / p;
        Some(Moments { variance, ..Moments::unbiased("transmittance", profile) }.looking_up(lookups))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": { "kind": KIND.name, "majorant": self.majorant, "splits": self.splits } })
    }
}

fn cases(cases: &mut Cases) {
    for (name, majorant, splits, profile) in [
        ("hill-2", 2.0, 2, Profile::HILL),
        ("smoke-4", 1.25, 4, Profile::SMOKE),
        ("hill-5", 2.5, 5, Profile::HILL),
    ] {
        let model = LineIntegral { majorant, splits, slip: None };
        cases.draw_some(16, &format!("{}/{name}", KIND.name), &model, profile);
    }
}
