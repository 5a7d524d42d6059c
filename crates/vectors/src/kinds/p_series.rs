//! The power series of transmittance about a pivot, truncated at a random order (georgiev-2019).

use super::{Cases, Kind, LARGEST, Model, mistakes, u};
use crate::moments::{Collision, Moments, product};
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Number, Outcome, Precise, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "p_series",
    outputs: &["transmittance"],
    notes: &[
        ("point", "X = length * sigma_t(length * u), u uniform"),
        (
            "cmf",
            "term = exp(-pivot), the sum so far; order k multiplies it by (pivot - X) * (1/k). Orders above `sure` are reached with q = min(1, pivot * (1/k)), and multiply it by (1/k)/q",
        ),
        (
            "sure",
            "one more than the least k at which the Poisson law of mean pivot has P(N <= k) >= 0.99; stated with each case",
        ),
        (
            "cumulative",
            "term *= (pivot - X)/k; with q = |term|/exp(-pivot) < 1 it is kept with the probability q and then divided by q",
        ),
        ("ratio", "product of 1 - X/pivot over K points"),
        (
            "next_flight",
            "r_k = sum over j of pivot^j k!/(k + j)!; sum = 1/r_K, then for k = K down to 1: r_(k-1) = 1 + pivot/k r_k, sum = sum (1 - X/pivot) + 1/r_(k-1)",
        ),
        (
            "K",
            "exponentials are added as long as their sum is below the pivot, strictly; all before the points",
        ),
        (
            "variates",
            "a decision that is sure costs none; the point of an order is drawn behind its decision (cumulative: before)",
        ),
    ],
    cases,
};

#[derive(Clone, Copy, PartialEq)]
enum Version {
    Cmf,
    Cumulative,
    Ratio,
    NextFlight,
}

#[derive(Clone, Copy)]
struct PSeries {
    version: Version,
    pivot: f64,
    slip: Option<Slip>,
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Sign,
    NoFactorial,
    NotDivided,
    OneFewer,
}

const SLIPS: [(&str, Slip); 4] = [
    ("X - pivot for pivot - X", Slip::Sign),
    ("the 1/k of order k left out", Slip::NoFactorial),
    ("terms not divided by the probability of their order", Slip::NotDivided),
    ("cmf: one order fewer for sure", Slip::OneFewer),
];

/// Orders up to the one at which P(N ≤ k) reaches 0.99, and one more.
fn surely_drawn(pivot: f64) -> u32 {
    let (mut mass, mut sum) = (Precise::of(-pivot).exp(), Precise::of(0.0));
    for k in 1_u32.. {
        sum = sum + mass.clone();
        if sum >= Precise::of(99.0) / Precise::of(100.0) {
            return k;
        }
        mass = mass * Precise::of(pivot) / Precise::of(f64::from(k));
    }
    unreachable!("a Poisson law ends")
}

/// A Poisson number: the exponentials that fit into its mean.
pub(super) fn poisson<A: Arithmetic>(run: &mut Run<'_, A>, mean: f64) -> u32 {
    let (mut count, mut sum, mean) = (0, run.exponential(), run.number(mean));
    while sum < mean {
        count += 1;
        sum = sum + run.exponential();
    }
    count
}

/// X, the optical thickness that one point stands for.
pub(super) fn point<A: Arithmetic>(run: &mut Run<'_, A>) -> A::Number {
    let length = run.number(run.length());
    let s = length.clone() * run.uniform();
    length * run.look_up(s)
}

impl PSeries {
    fn has(&self, slip: Slip) -> bool {
        self.slip == Some(slip)
    }

    fn happens<A: Arithmetic>(run: &mut Run<'_, A>, probability: &A::Number) -> bool {
        *probability >= run.number(1.0) || run.uniform() < *probability
    }

    /// Y = t_c − X.
    fn deviation<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> A::Number {
        let pivot = run.number(self.pivot);
        let y = pivot - point(run);
        if self.has(Slip::Sign) { -y } else { y }
    }

    fn cmf<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> A::Number {
        let (one, pivot) = (run.number(1.0), run.number(self.pivot));
        let sure = surely_drawn(self.pivot) - u32::from(self.has(Slip::OneFewer));
        let mut term = (-run.input(self.pivot)).exp();
        let mut sum = term.clone();
        for k in 1_u32.. {
            let mut scale = one.clone() / run.number(f64::from(k));
            if k > sure {
                let goes_on = (pivot.clone() * scale.clone()).min(one.clone());
                if !Self::happens(run, &goes_on) {
                    break;
                }
                if !self.has(Slip::NotDivided) {
                    scale = scale / goes_on;
                }
            }
            let factor = if self.has(Slip::NoFactorial) { one.clone() } else { scale };
            term = term * (self.deviation(run) * factor);
            sum = sum + term.clone();
        }
        sum
    }

    fn cumulative<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> A::Number {
        let one = run.number(1.0);
        let first = (-run.input(self.pivot)).exp();
        let (mut term, mut sum) = (first.clone(), first.clone());
        for k in 1_u32.. {
            let k = if self.has(Slip::NoFactorial) { one.clone() } else { run.number(f64::from(k)) };
            term = term * (self.deviation(run) / k);
            let goes_on = (term.clone() / first.clone()).abs();
            if goes_on < one {
                if !Self::happens(run, &goes_on) {
                    break;
                }
                if !self.has(Slip::NotDivided) {
                    term = term * (one.clone() / goes_on);
                }
            }
            sum = sum + term.clone();
            // What is not divided by k ends for no reason.
            if self.slip.is_some() && run.drawn_so_far() > super::MOST_DRAWS {
                break;
            }
        }
        sum
    }

    fn next_flight<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> A::Number {
        let last = poisson(run, self.pivot);
        let (one, pivot) = (run.number(1.0), run.input(self.pivot));
        let (mut reciprocal, mut term, mut next) = (one.clone(), one.clone(), f64::from(last));
        // The rest is below 160 bits.
        let least = A::Number::of(2.0_f64.powi(-170));
        while term > least.clone() * reciprocal.clone() {
            next += 1.0;
            term = term * (pivot.clone() / run.number(next));
            reciprocal = reciprocal + term.clone();
        }
        let inverse = |r: &A::Number| {
            if self.has(Slip::NotDivided) { one.clone() } else { one.clone() / r.clone() }
        };
        let mut sum = inverse(&reciprocal);
        for k in (1..=last).rev() {
            reciprocal = one.clone() + pivot.clone() / run.number(f64::from(k)) * reciprocal;
            sum = sum * (one.clone() - point(run) / pivot.clone());
            sum = sum + inverse(&reciprocal);
        }
        sum
    }
}

impl Model for PSeries {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        Outcome::of(match self.version {
            Version::Cmf => self.cmf(run),
            Version::Cumulative => self.cumulative(run),
            Version::NextFlight => self.next_flight(run),
            Version::Ratio => {
                let (one, mut product) = (run.number(1.0), run.number(1.0));
                for _ in 0..poisson(run, self.pivot) {
                    let ratio = point(run) / run.number(self.pivot);
                    product = product
                        * if self.has(Slip::Sign) { ratio - one.clone() } else { one.clone() - ratio };
                }
                product
            }
        })
    }

    fn takes_functions(&self) -> bool {
        self.version != Version::Ratio
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        mistakes(&SLIPS, |slip| Self { slip: Some(slip), ..*self }, script, profile)
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let pivot = self.pivot;
        if self.version != Version::Ratio {
            return Some(Moments::unbiased("transmittance", profile));
        }
        let length = profile.length();
        let at = |_: f64, sigma_t: f64| Collision::always(pivot / length, 1.0 - length * sigma_t / pivot);
        Some(product("transmittance", profile, profile.s, (0.0, 0.0), at))
    }

    fn stated(&self) -> Value {
        let version = match self.version {
            Version::Cmf => "cmf",
            Version::Cumulative => "cumulative",
            Version::Ratio => "ratio",
            Version::NextFlight => "next_flight",
        };
        let mut stated =
            json!({ "estimator": { "kind": KIND.name, "version": version, "pivot": self.pivot } });
        if self.version == Version::Cmf {
            stated["sure"] = json!(surely_drawn(self.pivot));
        }
        stated
    }
}

fn cases(cases: &mut Cases) {
    let name = |name: &str| format!("{}/{name}", KIND.name);
    let of = |version, pivot| PSeries { version, pivot, slip: None };
    for (parameters, model) in [
        ("cmf", of(Version::Cmf, 4.5)),
        ("cumulative", of(Version::Cumulative, 5.0)),
        ("ratio", of(Version::Ratio, 8.0)),
        ("next-flight", of(Version::NextFlight, 8.0)),
    ] {
        cases.draw_some(12, &name(parameters), &model, Profile::SMOKE);
    }
    // Every X is 2 on the even profile: about 1 terms are ∓1/k!, and |w| = 1/2 at order 2.
    let one = of(Version::Cumulative, 1.0);
    cases.extreme(&name("tie/order-2-at-the-border"), &one, Profile::EVEN, vec![u(0.5), u(0.25), u(0.5)]);
    let draws = vec![Draw::lattice(LARGEST), Draw::lattice(0), Draw::lattice(LARGEST)];
    cases.extreme(&name("extreme/largest-variate"), &one, Profile::EVEN, draws);
}
