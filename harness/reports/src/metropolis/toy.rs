//! A target of two modes whose chains are known in closed form.

use fairflight_metropolis::{
    Acceptance, Bootstrap, Chain, Film, Integrand, Plan, Primary, Proposed, Redistribution, Splats, Target,
    Which,
};
use fairflight_sources::{Seeded, SmallStep, Step, UniformSource, named_seed};

/// Ends and heights of two modes in [0, 1); all else is dark. Small steps of at most [`REACH`] lead from neither to the other.
const MODES: [([f64; 2], f64); 2] = [([0.1, 0.4], 3.0), ([0.6, 0.9], 1.0)];
const REACH: f64 = 0.04;
/// Extent of either mode: the probability that a large step finds it.
const WIDTH: f64 = 0.3;
/// Probability of a large step.
const LARGE: f64 = 0.1;
/// b = ∫ f.
const BRIGHTNESS: f64 = WIDTH * (MODES[0].1 + MODES[1].1);
/// The light of the first mode, which is measured.
pub(super) const TRUTH: f64 = WIDTH * MODES[0].1;
/// Independent samples of which a start is chosen.
pub(super) const SET: u64 = 16;

/// Second eigenvalue of the chain of modes: what is left, behind each step, of a deviation from the stationary law.
///
/// Within a mode f is constant, and a small step proposes a place there or in the dark. So the mode of a state is a reversible chain of its own, of two
/// states: from the first to the second with the probability LARGE · WIDTH · f_2/f_1, and back with LARGE · WIDTH. The eigenvalues of two states are 1 and
/// 1 less both.
pub(super) fn eigenvalue() -> f64 {
    1.0 - LARGE * WIDTH * (1.0 + MODES[1].1 / MODES[0].1)
}

/// The relative bias of the first mode's light, of chains of so many steps whose scores are multiplied with b, where a start lies in that mode with
/// the probability `first`.
///
/// A step scores the probability of being in the mode behind it. That of step t is π + λ^t (first − π), π = TRUTH/b, so that the mean of steps 1 to
/// N is off by (first − π) λ (1 − λ^N)/(N (1 − λ)).
pub(super) fn bias(first: f64, steps: f64) -> f64 {
    let (stationary, eigenvalue) = (TRUTH / BRIGHTNESS, eigenvalue());
    let decay = eigenvalue * (1.0 - eigenvalue.powf(steps)) / (steps * (1.0 - eigenvalue));
    (first - stationary) / stationary * decay
}

/// Start of a chain, and what its scores are multiplied with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// The first sample that found light, and b itself.
    FirstLit,
    /// One of [`SET`] samples by its weight, and b itself.
    Chosen,
    /// One of [`SET`] samples by its weight, and their own estimate of b.
    WithItsSet,
}

impl Start {
    /// The probability that the start lies in the first mode, on average weighted as its scores are.
    pub(super) fn first(self) -> f64 {
        match self {
            // Both are equally wide.
            Self::FirstLit => 0.5,
            // E[3 n_1/(3 n_1 + n_2)] over n_1, n_2 of a multinomial law: first whether a sample is lit, then where.
            Self::Chosen => {
                let lit = |n: u64| binomial(SET, n, 2.0 * WIDTH);
                let share = |of: u64, n: u64| {
                    let [first, second] = [n, of - n].map(|count| count as f64);
                    MODES[0].1 * first / (MODES[0].1 * first + MODES[1].1 * second)
                };
                (1..=SET)
                    .map(|of| lit(of) * (0..=of).map(|n| binomial(of, n, 0.5) * share(of, n)).sum::<f64>())
                    .sum()
            }
            Self::WithItsSet => TRUTH / BRIGHTNESS,
        }
    }

    /// Score in the first mode, of a chain of so many steps.
    pub(super) fn score(self, kernel: &mut Kernel<'_>, steps: u64, seed: u64) -> f64 {
        let mut source = Seeded::new(named_seed(seed, "steps"));
        match self {
            Self::FirstLit => {
                while kernel.draw(&mut source) == 0.0 {}
                kernel.accept();
                chain(kernel, steps, &mut source)
            }
            Self::Chosen => {
                let set = Bootstrap::draw(kernel, SET, seed).expect("f is finite");
                let Some(start) = set.choose(&mut source) else { return 0.0 };
                set.start(kernel, start);
                chain(kernel, steps, &mut source)
            }
            Self::WithItsSet => first_mode(|film| {
                let plan = Plan::new(SET, 1, steps).expect("a replica of a sample and a step");
                plan.replica(kernel, (0, seed), film).expect("f is finite");
            }),
        }
    }
}

fn binomial(of: u64, n: u64, probability: f64) -> f64 {
    let choices: f64 = (0..n).map(|k| (of - k) as f64 / (k + 1) as f64).product();
    choices * probability.powi(n as i32) * (1.0 - probability).powi((of - n) as i32)
}

/// Deposit of a run in the first mode.
fn first_mode(run: impl FnOnce(&mut Film<'_, f64>)) -> f64 {
    let mut sum = 0.0;
    run(&mut |pixel, value| sum += if pixel == [0, 0] { value } else { 0.0 });
    sum
}

/// The score of a chain from the present state, multiplied with b itself.
fn chain(kernel: &mut Kernel<'_>, steps: u64, source: &mut Seeded) -> f64 {
    first_mode(|film| {
        let mut chain = Chain::new(kernel, BRIGHTNESS / steps as f64);
        for _ in 0..steps {
            chain.step(film, &mut [Acceptance::default(); 2], source).expect("f is finite");
        }
        chain.finish(film);
    })
}

/// Score in the first mode, of a sample and the chains that it starts: so many on average, at most `most`.
pub(super) fn redistributed(
    kernel: &mut Kernel<'_>,
    (steps, chains, most): (u64, f64, Option<u64>),
    seed: u64,
) -> f64 {
    let rule = Redistribution::new(steps, BRIGHTNESS / (steps as f64 * chains)).expect("steps, and energy");
    let rule = most.map_or(rule, |most| rule.with_most_chains(most).expect("a chain at most"));
    first_mode(|film| {
        rule.sample(kernel, (0, seed), &mut [Acceptance::default(); 2], film).expect("f is finite");
    })
}

/// The modes as an image of two pixels, and as a function of one variate.
pub(super) fn integrand(splats: &mut Splats<f64>, source: &mut dyn UniformSource) {
    let u = source.next_uniform();
    let lit = (0..).zip(MODES).find(|(_, ([from, to], _))| (*from..*to).contains(&u));
    if let Some((column, (_, height))) = lit {
        splats.push([column, 0], height);
    }
}

/// Steps of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Steps {
    /// None: each state is proposed again, and accepted.
    Idle,
    /// Small ones: a chain stays in the mode where it starts.
    Small,
    /// Small ones, and large ones of the probability [`LARGE`].
    Both,
}

/// Variates of the modes, moved by steps.
pub(super) struct Kernel<'i> {
    inner: Primary<'i, f64>,
    is_idle: bool,
}

impl<'i> Kernel<'i> {
    pub(super) fn new(integrand: &'i mut dyn Integrand<f64>, steps: Steps) -> Self {
        let large = if steps == Steps::Both { LARGE } else { 0.0 };
        let small = SmallStep::new(REACH / 20.0, REACH).expect("ordered steps");
        let inner =
            Primary::new(integrand).with_small_step(small).with_large_step(large).expect("a probability");
        Self { inner, is_idle: steps == Steps::Idle }
    }
}

impl Target<f64> for Kernel<'_> {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        self.inner.draw(source)
    }
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        if !self.is_idle {
            return self.inner.propose(source);
        }
        self.inner.sample(Step::Again, source);
        Proposed { kind: 1, acceptance: 1.0 }
    }
    fn accept(&mut self) {
        self.inner.accept();
    }
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, f64>) {
        self.inner.deposit(which, energy, film);
    }
    fn kinds(&self) -> &[&'static str] {
        self.inner.kinds()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bias_decays_as_the_law_of_the_mode_does() {
        // The law of two states, step by step.
        let [there, back] = [LARGE * WIDTH / 3.0, LARGE * WIDTH];
        for start in [Start::FirstLit, Start::Chosen, Start::WithItsSet] {
            let (mut first, mut sum) = (start.first(), 0.0);
            for steps in 1..=50_u32 {
                first = first * (1.0 - there) + (1.0 - first) * back;
                sum += first;
                let found = sum / f64::from(steps) * BRIGHTNESS / TRUTH - 1.0;
                assert!((found - bias(start.first(), steps.into())).abs() < 1e-14, "{start:?} {steps}");
            }
        }
        assert_eq!(bias(Start::WithItsSet.first(), 7.0), 0.0);
    }

    #[test]
    fn a_start_that_is_chosen_is_too_seldom_in_the_brighter_mode() {
        // Counts of both modes and of the dark together: M!/(n_1! n_2! n_0!) · 0.3^(n_1 + n_2) · 0.4^n_0.
        let factorial = |n: u64| (1..=n).map(|k| k as f64).product::<f64>();
        let (mut first, mut lit) = (0.0, 0.0);
        for one in 0..=SET {
            for two in 0..=SET - one {
                let dark = SET - one - two;
                let choices = factorial(SET) / (factorial(one) * factorial(two) * factorial(dark));
                let probability = choices * 0.3_f64.powi((one + two) as i32) * 0.4_f64.powi(dark as i32);
                let [one, two] = [one, two].map(|count| count as f64);
                if one + two > 0.0 {
                    first += probability * 3.0 * one / (3.0 * one + two);
                    lit += probability;
                }
            }
        }
        assert!((lit - 1.0 + 0.4_f64.powi(16)).abs() < 1e-14);
        assert!((Start::Chosen.first() - first).abs() < 1e-14 && first < 0.75, "{first}");
    }
}
