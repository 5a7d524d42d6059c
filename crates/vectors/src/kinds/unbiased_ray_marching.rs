//! Unbiased ray marching (kettunen-2021): a power series in the differences of independent combs.

use super::{Cases, Kind, Model, mistake, u};
use crate::moments::{Moments, Shifts, second_moment};
use crate::tolerance::Finished;
use crate::{Arithmetic, Number, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

pub(super) static KIND: Kind = Kind {
    name: "unbiased_ray_marching",
    outputs: &["transmittance"],
    notes: &[
        ("roulette", "in `estimator` it is the probability of STOPPING at order 0; P = 1 - roulette goes on"),
        ("order", "0 if u >= P; else 2, and one more as long as a new u has u * (order + 1) < 2, strictly"),
        ("weights", "w_1 = 1/P, w_k = w_(k-1)/2: 1/(k! P(N >= k))"),
        (
            "means",
            "m_k of n values: m_k += k * (1/n) * (m_(k-1) y - m_k) from the highest k down, with n counted from 1 and including the new value",
        ),
        ("symmetry", "every comb is the pivot once, and the mean is over all N + 1"),
        ("endpoints", "endpoint_matching looks up s = 0 and s = length before any variate is drawn"),
        ("teeth", "tooth j of M at min(u h + j h, length) with h = length/M"),
        ("variates", "the order, then one for each comb"),
    ],
    cases,
};

struct UnbiasedRayMarching {
    teeth: u32,
    endpoint_matching: bool,
    /// The probability of stopping at order 0.
    roulette: f64,
}

/// h, and h \[σ_t\] over the ray.
struct Comb<N> {
    teeth: u32,
    step: N,
    jump: N,
}

impl<N: Number> Comb<N> {
    /// X(u) = h Σ σ_t − h \[σ_t\] (u − 1/2).
    fn thickness<A: Arithmetic<Number = N>>(&self, run: &mut Run<'_, A>) -> N {
        let (u, end) = (run.uniform(), run.number(run.length()));
        let first = u.clone() * self.step.clone();
        let mut sum = run.number(0.0);
        for tooth in 0..self.teeth {
            let s = first.clone() + run.number(f64::from(tooth)) * self.step.clone();
            sum = sum + run.look_up(s.min(end.clone()));
        }
        self.step.clone() * sum - self.jump.clone() * (u - run.number(0.5))
    }
}

impl Model for UnbiasedRayMarching {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let length = run.number(run.length());
        let step = length.clone() / run.number(f64::from(self.teeth));
        let jump = if self.endpoint_matching {
            let (start, end) = (run.look_up(run.number(0.0)), run.look_up(length));
            step.clone() * (end - start)
        } else {
            run.number(0.0)
        };
        let comb = Comb { teeth: self.teeth, step, jump };
        let going_on = run.number(1.0 - self.roulette);
        let order = order(run, &going_on);
        let first = comb.thickness(run);
        let mut deviations = vec![run.number(0.0)];
        for _ in 0..order {
            deviations.push(first.clone() - comb.thickness(run));
        }
        Outcome::of(series(&going_on, &deviations) * (-first).exp())
    }

    fn takes_functions(&self) -> bool {
        true
    }

    fn mistakes(&self, script: &Script, profile: Profile) -> Vec<(&'static str, Finished)> {
        let Self { teeth, endpoint_matching, roulette } = *self;
        let all = [
            ("symmetric means divided by the final N", Slip::FinalCount),
            ("symmetric means with n counted from 0", Slip::FromZero),
            ("the roulette scaled: terms not divided by P", Slip::Roulette),
            ("P and 1 - P exchanged", Slip::Exchanged),
            ("the comb in world units: u not times h", Slip::WorldUnits),
            ("one pivot only", Slip::OnePivot),
            ("endpoint matching of the other sign", Slip::Sign),
            ("<= for < in the decision to go on", Slip::GoesOn),
            ("<= for < in the decision of a further order", Slip::Further),
        ];
        let wrong = |(name, slip)| {
            mistake(name, &Wrong { teeth, endpoint_matching, roulette, slip }, script, profile)
        };
        all.map(wrong).into()
    }

    fn moments(&self, profile: Profile) -> Option<Moments> {
        let comb = Shifts::new(profile, self.teeth, self.endpoint_matching);
        Some(second_moment(&comb, 1.0 - self.roulette))
    }

    fn stated(&self) -> Value {
        json!({ "estimator": {
            "kind": KIND.name,
            "teeth": self.teeth,
            "endpoint_matching": self.endpoint_matching,
            "roulette": self.roulette,
        } })
    }
}

/// The order of the roulette: 0, or 2 and more.
pub(super) fn order<A: Arithmetic>(run: &mut Run<'_, A>, going_on: &A::Number) -> u32 {
    let mut order = 0;
    if run.uniform() < *going_on {
        order = 2_u32;
        while run.uniform() * run.number(f64::from(order + 1)) < run.number(2.0) {
            order += 1;
        }
    }
    order
}

/// exp(X_0) times the estimate, from X_0 − X_i of all draws, the first included.
pub(super) fn series<N: Number>(going_on: &N, deviations: &[N]) -> N {
    if deviations.len() == 1 {
        return N::of(1.0);
    }
    let mut sum = N::of(0.0);
    for (pivot, own) in deviations.iter().enumerate() {
        let others = deviations.iter().enumerate().filter(|(i, _)| *i != pivot);
        let means = symmetric_means(others.map(|(_, other)| other.clone() - own.clone()));
        let (mut series, mut weight) = (N::of(1.0), N::of(1.0) / going_on.clone());
        for mean in &means[1..] {
            series = series + weight.clone() * mean.clone();
            weight = weight * N::of(0.5);
        }
        sum = sum + own.exp() * series;
    }
    sum / N::of(deviations.len() as f64)
}

/// m_0 … m_N: elementary symmetric means.
fn symmetric_means<N: Number>(values: impl Iterator<Item = N>) -> Vec<N> {
    let mut means = vec![N::of(1.0)];
    for value in values {
        let n = means.len();
        means.push(N::of(0.0));
        let share = N::of(1.0) / N::of(n as f64);
        for k in (1..=n).rev() {
            let change = means[k - 1].clone() * value.clone() - means[k].clone();
            means[k] = means[k].clone() + N::of(k as f64) * share.clone() * change;
        }
    }
    means
}

/// A mistake of ports.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    FinalCount,
    FromZero,
    Roulette,
    Exchanged,
    WorldUnits,
    OnePivot,
    Sign,
    GoesOn,
    Further,
}

/// Unbiased ray marching with a mistake.
struct Wrong {
    teeth: u32,
    endpoint_matching: bool,
    roulette: f64,
    slip: Slip,
}

impl Wrong {
    fn comb<A: Arithmetic>(&self, run: &mut Run<'_, A>, step: &A::Number, jump: &A::Number) -> A::Number {
        let (u, [start, end]) = (run.uniform(), [0.0, run.length()].map(A::Number::of));
        let shift = if self.slip == Slip::WorldUnits { u.clone() } else { u.clone() * step.clone() };
        let mut sum = run.number(0.0);
        for tooth in 0..self.teeth {
            let s = shift.clone() + run.number(f64::from(tooth)) * step.clone();
            sum = sum + run.look_up(s.max(start.clone()).min(end.clone()));
        }
        step.clone() * sum - jump.clone() * (u - run.number(0.5))
    }

    /// The symmetric means of N values, with the count n replaced.
    fn means<N: Number>(&self, values: &[N]) -> Vec<N> {
        let mut means = vec![N::of(1.0)];
        for value in values {
            let n = means.len();
            means.push(N::of(0.0));
            let count = match self.slip {
                Slip::FinalCount => values.len(),
                Slip::FromZero => (n - 1).max(1),
                _ => n,
            };
            let share = N::of(1.0) / N::of(count as f64);
            for k in (1..=n).rev() {
                let change = means[k - 1].clone() * value.clone() - means[k].clone();
                means[k] = means[k].clone() + N::of(k as f64) * share.clone() * change;
            }
        }
        means
    }
}

impl Model for Wrong {
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number> {
        let [one, zero, length] = [1.0, 0.0, run.length()].map(A::Number::of);
        let step = length.clone() / run.number(f64::from(self.teeth));
        let mut jump = zero.clone();
        if self.endpoint_matching {
            let (start, end) = (run.look_up(zero.clone()), run.look_up(length));
            jump = step.clone() * (end - start);
            jump = if self.slip == Slip::Sign { -jump } else { jump };
        }
        let stop = if self.slip == Slip::Exchanged { 1.0 - self.roulette } else { self.roulette };
        let going_on = run.number(1.0 - stop);
        let below = |slip, x: A::Number, y: A::Number| x < y || x == y && self.slip == slip;
        let mut order = 0;
        if below(Slip::GoesOn, run.uniform(), going_on.clone()) {
            order = 2_u32;
            while below(Slip::Further, run.uniform() * run.number(f64::from(order + 1)), run.number(2.0)) {
                order += 1;
            }
        }
        let first = self.comb(run, &step, &jump);
        let mut deviations = vec![zero.clone()];
        for _ in 0..order {
            deviations.push(first.clone() - self.comb(run, &step, &jump));
        }
        let pivots = if self.slip == Slip::OnePivot { 1 } else { deviations.len() };
        let mut sum = zero;
        for pivot in 0..pivots {
            let own = deviations[pivot].clone();
            let mut others: Vec<A::Number> =
                deviations.iter().map(|other| other.clone() - own.clone()).collect();
            others.remove(pivot);
            let mut weight =
                if self.slip == Slip::Roulette { one.clone() } else { one.clone() / going_on.clone() };
            let mut series = one.clone();
            for mean in &self.means(&others)[1..] {
                series = series + weight.clone() * mean.clone();
                weight = weight * run.number(0.5);
            }
            sum = sum + own.exp() * series;
        }
        Outcome::of(sum / run.number(pivots as f64) * (-first).exp())
    }
}

fn cases(cases: &mut Cases) {
    let of = |teeth, endpoint_matching, roulette| UnbiasedRayMarching { teeth, endpoint_matching, roulette };
    for (name, model) in [
        ("8", of(8, false, 0.9)),
        ("8-matched", of(8, true, 0.9)),
        ("3-often", of(3, false, 0.25)),
        ("5-often-matched", of(5, true, 0.25)),
    ] {
        cases.draw(&format!("{}/{name}", KIND.name), &model, Profile::SMOKE);
    }
    // P = 1/2: the border of the order 0, and that of order 3 at u = 2/3, which no binary number is: 4 u < 2 at 1/2 is.
    let half = of(2, true, 0.5);
    let name = |name: &str| format!("{}/{name}", KIND.name);
    cases.tie(&name("tie/order-0-at-the-border"), &half, Profile::EVEN, vec![u(0.5), u(0.25)]);
    cases.tie(
        &name("tie/order-3-at-the-border"),
        &half,
        Profile::EVEN,
        vec![u(0.25), u(0.25), u(0.5), u(0.0), u(0.25), u(0.5), u(0.75)],
    );
}
