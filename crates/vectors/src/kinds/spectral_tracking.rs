//! Spectral tracking with the history-aware average (kutz-2017): one flight for three wavelengths.

use super::{Cases, Kind, Model, given, mistake, u};
use crate::moments::Moments;
use crate::run::Event;
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "spectral_tracking",
    outputs: &["weight_0", "weight_1", "weight_2"],
    notes: &[
        ("step", "s += e * (1/sigma_samp)"),
        ("ratios", "r_l = coefficient_l sigma_t/sigma_samp; one look-up for all wavelengths"),
        ("collision", "u < C/(C + N), strictly, with C = sum |w_l r_l| and N = sum |w_l (1 - r_l)|"),
        (
            "weights",
            "at a collision w_l *= r_l/(C/(C + N)), at a null collision w_l *= (1 - r_l)/(N/(C + N)); they start at 1",
        ),
        ("distance", "of a collision is that of the last look-up"),
        ("variates", "an exponential, then a uniform variate at each look-up"),
    ],
    cases,
};

/// σ_t of each wavelength over that of the profile.
const COEFFICIENTS: [f64; 3] = [1.0, 0.5, 0.125];

struct SpectralTracking {
    sigma_samp: f64,
}

impl Model for SpectralTracking {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let (one, sigma_samp, length) =
            (run.number(1.0), run.number(self.sigma_samp), run.number(run.length()));
        let mean_free_path = one.clone() / sigma_samp.clone();
        let (mut s, mut weights) = (run.number(0.0), [1.0; 3].map(|weight| run.number(weight)));
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length {
                return Outcome { event: Some(Event::Escaped), values: weights.into() };
            }
            let gray = run.look_up(s.clone());
            let ratios = COEFFICIENTS.map(|c| run.number(c) * gray.clone() / sigma_samp.clone());
            let passed = ratios.clone().map(|r| one.clone() - r);
            let [collides, passes] = [&ratios, &passed].map(|events| size(&weights, events));
            let all = collides.clone() + passes.clone();
            let probability = collides / all.clone();
            if run.uniform() < probability {
                weights = times(weights, ratios, &probability);
                return Outcome { event: Some(Event::Collided), values: weights.into() };
            }
            weights = times(weights, passed, &(passes / all));
            run.weighs(&weights[0]);
        }
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let sigma_samp = self.sigma_samp;
        let all = [
            ("the history left out: all weights 1 in the decision", Slip::Forgets),
            ("weights not divided by the probability of the event", Slip::NotDivided),
            ("the first wavelength decides", Slip::First),
        ];
        all.map(|(name, slip)| mistake(name, &Wrong { sigma_samp, slip }, script, profile)).into()
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        Some(Moments::unbiased("escaped", profile))
    }

    fn stated(&self) -> Value {
        json!({
            "sampler": { "kind": KIND.name, "scheme": "average", "sigma_samp": self.sigma_samp },
            "coefficients": COEFFICIENTS,
        })
    }
}

/// Σ |w_l e_l|.
fn size<N: Number>(weights: &[N; 3], events: &[N; 3]) -> N {
    let terms = weights.iter().zip(events).map(|(weight, event)| (weight.clone() * event.clone()).abs());
    terms.fold(N::of(0.0), |sum, term| sum + term)
}

/// w_l (e_l/P).
fn times<N: Number>(weights: [N; 3], events: [N; 3], probability: &N) -> [N; 3] {
    let mut products =
        weights.into_iter().zip(events).map(|(weight, event)| weight * (event / probability.clone()));
    std::array::from_fn(|_| products.next().expect("three wavelengths"))
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Forgets,
    NotDivided,
    First,
}

/// Spectral tracking with a mistake.
struct Wrong {
    sigma_samp: f64,
    slip: Slip,
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [one, sigma_samp, length] = [1.0, self.sigma_samp, run.length()].map(A::Number::of);
        let (mut s, mut weights) = (run.number(0.0), [1.0; 3].map(|weight| run.number(weight)));
        loop {
            s = s + run.exponential() * (one.clone() / sigma_samp.clone());
            if s >= length {
                return Outcome { event: Some(Event::Escaped), values: weights.into() };
            }
            let gray = run.look_up(s.clone());
            let ratios = COEFFICIENTS.map(|c| run.number(c) * gray.clone() / sigma_samp.clone());
            let passed = ratios.clone().map(|r| one.clone() - r);
            let history =
                if self.slip == Slip::Forgets { [1.0; 3].map(A::Number::of) } else { weights.clone() };
            let [collides, passes] = match self.slip {
                Slip::First => [ratios[0].clone(), passed[0].clone()],
                _ => [&ratios, &passed].map(|events| size(&history, events)),
            };
            let all = collides.clone() + passes.clone();
            let divisor = |size: A::Number| {
                if self.slip == Slip::NotDivided { one.clone() } else { size / all.clone() }
            };
            if run.uniform() < collides.clone() / all.clone() {
                let weights = times(weights, ratios, &divisor(collides));
                return Outcome { event: Some(Event::Collided), values: weights.into() };
            }
            weights = times(weights, passed, &divisor(passes));
        }
    }
}

fn cases(cases: &mut Cases) {
    for sigma_samp in [1.0, 1.5] {
        let name = format!("{}/{sigma_samp}", KIND.name);
        cases.draw(&name, &SpectralTracking { sigma_samp }, Profile::SMOKE);
    }
    // At s = 1, σ_t = 1: r = (1, 1/2, 1/8); C = 13/8, N = 11/8, so that no border is dyadic. At s = 0 of the even profile r is half of that.
    let one = SpectralTracking { sigma_samp: 1.0 };
    let name = |name: &str| format!("{}/tie/{name}", KIND.name);
    cases.tie(&name("end"), &one, Profile::SMOKE, vec![given(8.0)]);
    cases.tie(&name("vacuum"), &one, Profile::SMOKE, vec![given(2.0), u(0.0), given(6.0)]);
}
