//! Free flights for several wavelengths at once, beside the history-aware average (kutz-2017, wilkie-2014, raab-2008 section 3.2).

use super::{Cases, Kind, Model, given, mistakes, u};
use crate::moments::Moments;
use crate::run::Event;
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "spectral_flight",
    outputs: &["distance", "weight_0", "weight_1", "weight_2"],
    notes: &[
        ("distance", "of the collision; the length where the flight escaped"),
        (
            "step",
            "s += e * (1/sigma_samp); sigma_samp is the majorant of all wavelengths for hero_wavelength, of each by itself for separate_solve",
        ),
        (
            "spectral_tracking, scheme max",
            "C = max |r_l|, N = max |1 - r_l| whatever the weights; u < C/(C + N) collides with w_l (r_l/(C/(C + N))), else w_l *= (1 - r_l)/(N/(C + N))",
        ),
        (
            "with a control",
            "a flight e * (1/control) is drawn first; r_l = (sigma_l - control)/sigma_samp; a tentative collision at or behind its end collides there with the weights as they are",
        ),
        (
            "hero_wavelength",
            "left = u * 3, then left -= w_l until left < 0: the hero l. v < r_hero collides. w_l = (w_l e_l)/(S'/S), e_l = r_l or 1 - r_l, with the sums S of w and S' of w e",
        ),
        (
            "separate_solve",
            "the hero flies alone: v * majorant_hero < sigma_hero collides; its weight is 3, the others 0",
        ),
        (
            "shared_distance",
            "one exponential; w_l = exp(sigma_samp s - tau_l(s)) sigma_l(s)/sigma_samp, at the end exp(sigma_samp length - tau_l(length)); looks up at a collision only",
        ),
    ],
    cases,
};

/// σ_t of each wavelength over that of the profile.
const COEFFICIENTS: [f64; 3] = [1.0, 0.5, 0.125];

#[derive(Clone, Copy, PartialEq)]
enum Sampler {
    Max { control: f64 },
    Hero,
    Separate { majorants: [f64; 3] },
    Shared,
}

#[derive(Clone, Copy)]
struct Flight {
    sampler: Sampler,
    sigma_samp: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    WithoutSum,
    OtherEvent,
    ForgetsCollision,
    NotThree,
    OneThickness,
}

const SLIPS: [(&str, Slip); 5] = [
    ("max: an event weighs r/max r, without the sum", Slip::WithoutSum),
    ("max: an event weighed by the probability of the other", Slip::OtherEvent),
    ("hero: a collision weighs what it did before it", Slip::ForgetsCollision),
    ("separate: a weight of 1, not of the number of wavelengths", Slip::NotThree),
    ("shared: the optical thickness of the first wavelength for all", Slip::OneThickness),
];

type Weights<N> = [N; 3];

fn sum<N: Number>(weights: &Weights<N>) -> N {
    weights.iter().cloned().fold(N::of(0.0), |sum, weight| sum + weight.abs())
}

/// The products of two by wavelength.
fn each<N: Number>(a: &Weights<N>, b: &Weights<N>, of: impl Fn(N, N) -> N) -> Weights<N> {
    std::array::from_fn(|l| of(a[l].clone(), b[l].clone()))
}

fn end<N: Number>(event: Event, s: N, weights: Weights<N>) -> Outcome<N> {
    let mut values = vec![s];
    values.extend(weights);
    Outcome { event: Some(event), values }
}

/// The weights after an event, by the balance heuristic.
fn balanced<N: Number>(weights: &Weights<N>, events: &Weights<N>) -> Weights<N> {
    let after = each(weights, events, |weight, event| weight * event);
    let probability = sum(&after) / sum(weights);
    after.map(|weight| weight / probability.clone())
}

impl Flight {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }

    fn max<A: Arithmetic>(&self, run: &mut Run<'_, A>, control: f64) -> Outcome<A::Number> {
        let [zero, one, sigma_samp, length] = [0.0, 1.0, self.sigma_samp, run.length()].map(A::Number::of);
        let mut at = None;
        if control > 0.0 {
            let s = run.exponential() * (one.clone() / run.number(control));
            at = Some(s).filter(|s| *s < length);
        }
        let mean_free_path = one.clone() / sigma_samp.clone();
        let (mut s, mut weights) = (zero.clone(), [(); 3].map(|()| one.clone()));
        loop {
            s = s + run.exponential() * mean_free_path.clone();
            if s >= length || at.as_ref().is_some_and(|at| s >= *at) {
                return match at {
                    Some(at) => end(Event::Collided, at, weights),
                    None => end(Event::Escaped, length, weights),
                };
            }
            let gray = run.look_up(s.clone());
            let ratios = COEFFICIENTS.map(|c| {
                let sigma = run.number(c) * gray.clone();
                if control > 0.0 {
                    (sigma - run.number(control)) / sigma_samp.clone()
                } else {
                    sigma / sigma_samp.clone()
                }
            });
            let passed = ratios.clone().map(|r| one.clone() - r);
            let greatest = |all: &Weights<A::Number>| {
                all.iter().cloned().fold(zero.clone(), |most, x| most.max(x.abs()))
            };
            let (collides, passes) = (greatest(&ratios), greatest(&passed));
            let all = collides.clone() + passes.clone();
            let divisor = |own: &A::Number, other: &A::Number| match self.slip {
                Some(Slip::WithoutSum) => own.clone(),
                Some(Slip::OtherEvent) => other.clone() / all.clone(),
                _ => own.clone() / all.clone(),
            };
            if run.uniform() < collides.clone() / all.clone() {
                let by = divisor(&collides, &passes);
                let weights = each(&weights, &ratios, |weight, r| weight * (r / by.clone()));
                return end(Event::Collided, s, weights);
            }
            let by = divisor(&passes, &collides);
            weights = each(&weights, &passed, |weight, r| weight * (r / by.clone()));
            run.weighs(&weights[0]);
        }
    }

    /// The wavelength that decides.
    fn hero<A: Arithmetic>(run: &mut Run<'_, A>) -> usize {
        let mut left = run.uniform() * run.number(3.0);
        for l in 0..2 {
            left = left - run.number(1.0);
            if left < run.number(0.0) {
                return l;
            }
        }
        2
    }

    fn by_hero<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [mut s, one, sigma_samp, length] = [0.0, 1.0, self.sigma_samp, run.length()].map(A::Number::of);
        let (hero, mut weights) = (Self::hero(run), [(); 3].map(|()| one.clone()));
        loop {
            s = s + run.exponential() * (one.clone() / sigma_samp.clone());
            if s >= length {
                return end(Event::Escaped, length, weights);
            }
            let gray = run.look_up(s.clone());
            let ratios = COEFFICIENTS.map(|c| run.number(c) * gray.clone() / sigma_samp.clone());
            if run.uniform() < ratios[hero] {
                let weights =
                    if self.has(Slip::ForgetsCollision) { weights } else { balanced(&weights, &ratios) };
                return end(Event::Collided, s, weights);
            }
            weights = balanced(&weights, &ratios.map(|r| one.clone() - r));
            run.weighs(&weights[0]);
        }
    }

    fn separate<A: Arithmetic>(&self, run: &mut Run<'_, A>, majorants: [f64; 3]) -> Outcome<A::Number> {
        let [zero, one, length] = [0.0, 1.0, run.length()].map(A::Number::of);
        let hero = Self::hero(run);
        let majorant = run.number(majorants[hero]);
        let mut weights = [(); 3].map(|()| zero.clone());
        weights[hero] = run.number(if self.has(Slip::NotThree) { 1.0 } else { 3.0 });
        let mut s = zero;
        loop {
            s = s + run.exponential() * (one.clone() / majorant.clone());
            if s >= length {
                return end(Event::Escaped, length, weights);
            }
            let sigma = run.number(COEFFICIENTS[hero]) * run.look_up(s.clone());
            if run.uniform() * majorant.clone() < sigma {
                return end(Event::Collided, s, weights);
            }
        }
    }

    fn shared<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [one, sigma_samp, length] = [1.0, self.sigma_samp, run.length()].map(A::Number::of);
        let mut s = run.exponential() * (one / sigma_samp.clone());
        let mut gray = None;
        if s >= length {
            s = run.input(run.length());
        } else {
            gray = Some(run.look_up(s.clone()));
        }
        let thickness = run.profile().thickness(&s);
        let weights = COEFFICIENTS.map(|c| {
            let of = if self.has(Slip::OneThickness) { COEFFICIENTS[0] } else { c };
            let grown = (sigma_samp.clone() * s.clone() - run.number(of) * thickness.clone()).exp();
            match &gray {
                Some(gray) => grown * (run.number(c) * gray.clone() / sigma_samp.clone()),
                None => grown,
            }
        });
        end(if gray.is_some() { Event::Collided } else { Event::Escaped }, s, weights)
    }
}

impl Model for Flight {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        match self.sampler {
            Sampler::Max { control } => self.max(run, control),
            Sampler::Hero => self.by_hero(run),
            Sampler::Separate { majorants } => self.separate(run, majorants),
            Sampler::Shared => self.shared(run),
        }
    }

    fn takes_functions(&self) -> bool {
        self.sampler == Sampler::Shared
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        Some(Moments::unbiased("escaped", profile))
    }

    fn stated(&self) -> Value {
        let sampler = match self.sampler {
            Sampler::Max { control } => {
                let mut sampler =
                    json!({ "kind": "spectral_tracking", "scheme": "max", "sigma_samp": self.sigma_samp });
                if control > 0.0 {
                    sampler["control"] = json!(control);
                }
                sampler
            }
            Sampler::Hero => json!({ "kind": "hero_wavelength", "majorant": self.sigma_samp }),
            Sampler::Separate { majorants } => json!({ "kind": "separate_solve", "majorants": majorants }),
            Sampler::Shared => json!({ "kind": "shared_distance", "sigma_samp": self.sigma_samp }),
        };
        json!({ "sampler": sampler, "coefficients": COEFFICIENTS })
    }
}

fn cases(cases: &mut Cases) {
    let of = |sampler, sigma_samp| Flight { sampler, sigma_samp, slip: None };
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let separate = Sampler::Separate { majorants: [1.0, 0.5, 0.25] };
    for (parameters, model) in [
        ("max", of(Sampler::Max { control: 0.0 }, 1.0)),
        ("max-controlled", of(Sampler::Max { control: 0.0625 }, 1.0)),
        ("hero", of(Sampler::Hero, 1.0)),
        ("separate", of(separate, 1.0)),
        ("shared", of(Sampler::Shared, 0.5)),
    ] {
        cases.draw_some(12, &name(parameters), &model, Profile::SMOKE);
    }
    let hero = of(Sampler::Hero, 1.0);
    // r = (1/4, 1/8, 1/32) at the start.
    let draws = vec![u(0.0), crate::Draw::lattice(0), u(0.25), given(8.0)];
    cases.tie(&name("tie/hero-at-the-border"), &hero, Profile::SMOKE, draws);
    cases.tie(&name("tie/end"), &of(separate, 1.0), Profile::SMOKE, vec![u(0.0), given(8.0)]);
}
