//! Sizes of steps that the state chooses by: the choice is in the ratio, and replicas learn from others. A chain that learns from itself is a twin in the
//! catalogue.

mod toys;

use fairflight_metropolis::laws::{Judged, Probes, Steps};
use fairflight_metropolis::{Experience, Kernels, Mutation, Plan, Primary, Proposed, Target, Which};
use fairflight_sources::{Seeded, SmallStep, UniformSource, derive_seed};
use std::cell::RefCell;
use toys::{SEED, accepted, integrand, score, verdict};

/// Steps that stay in a mode, and steps that may lead to the other one.
fn sizes() -> Vec<SmallStep> {
    vec![SmallStep::new(0.002, 0.04).unwrap(), SmallStep::new(0.1, 0.5).unwrap()]
}

/// The left half takes the first size, the right one the second; four fifths each.
fn taught(sizes: Vec<SmallStep>) -> Kernels {
    let even = Kernels::even(sizes, [2, 1]).unwrap();
    let mut experience = even.experience();
    for (pixel, size, acceptance) in [([0, 0], 0, 1.0), ([0, 0], 1, 0.0), ([1, 0], 0, 0.0), ([1, 0], 1, 1.0)]
    {
        even.count(&mut experience, (pixel, size), acceptance);
    }
    even.learn(&experience)
}

#[test]
fn replicas_whose_states_choose_their_steps() {
    let (mut integrand, kernels) = (integrand, taught(sizes()));
    assert!((kernels.shares([0, 0])[0] - 0.9).abs() < 1e-15);
    let mut target = Primary::new(&mut integrand).with_kernels(&kernels);
    let plan = Plan::new(16, 1, 20).unwrap();
    accepted("population", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
    assert_eq!(target.kinds(), ["large_step", "small_step", "small_step_2"]);
}

/// The pixel of a state.
#[derive(Default)]
struct Seen([u32; 2]);

impl Seen {
    fn of(primary: &Primary<'_, f64>, which: Which) -> Self {
        Self(primary.splats(which).brightest().unwrap_or([0, 0]))
    }
}

struct Moves<'a, 'i> {
    primary: &'a RefCell<Primary<'i, f64>>,
    kernels: &'a Kernels,
    forgets_the_choice: bool,
}

impl Mutation<Seen> for Moves<'_, '_> {
    fn propose(&mut self, x: &Seen, y: &mut Seen, source: &mut dyn UniformSource) -> Option<f64> {
        let mut primary = self.primary.borrow_mut();
        let Proposed { kind, acceptance } = primary.propose(source);
        *y = Seen::of(&primary, Which::Proposed);
        if self.forgets_the_choice {
            let ratio = primary.target(Which::Proposed) / primary.target(Which::Present);
            let choice = self.kernels.shares(y.0)[kind - 1] / self.kernels.shares(x.0)[kind - 1];
            assert!((acceptance - (ratio * choice).min(1.0)).abs() < 1e-14);
            return Some(ratio.ln());
        }
        Some(acceptance.ln())
    }
}

fn judged(forgets_the_choice: bool) -> Judged {
    // Sizes of which either crosses.
    let crossing = [0.1, 0.4].map(|least| SmallStep::new(least, 0.5).unwrap());
    let (mut integrand, kernels) = (integrand, taught(crossing.to_vec()));
    let primary = Primary::new(&mut integrand).with_kernels(&kernels).with_large_step(0.0).unwrap();
    let primary = RefCell::new(primary);
    let probes = Probes::<Seen> { moved: &[&|x| f64::from(x.0[0])], kept: &[] };
    let sample = |source: &mut Seeded, each: &mut dyn FnMut(&Seen, f64, &mut Seeded)| {
        let mut borrowed = primary.borrow_mut();
        let weight = borrowed.draw(source);
        borrowed.accept();
        let x = Seen::of(&borrowed, Which::Present);
        drop(borrowed);
        each(&x, weight, source);
    };
    let steps = Steps { samples: 800_000, seed: SEED, alpha: 1e-6 };
    steps.judge(probes, sample, &mut Moves { primary: &primary, kernels: &kernels, forgets_the_choice })
}

#[test]
fn the_choice_is_in_the_ratio() {
    let right = judged(false);
    println!("right: {:?}", right.worst());
    assert!(right.agrees_within(0.15), "{:#?}", right.drifts);
    // Expected |z| 236.
    let twin = judged(true);
    println!("mlt_no_choice_ratio: {:?}", twin.worst());
    assert!(twin.is_rejected() && twin.worst().z.abs() > 8.5, "{:?}", twin.worst());
}

#[test]
fn halves_of_a_population_teach_each_other() {
    // Two generations: the first half learns from the second's first generation, and remains unbiased.
    let even = Kernels::even(sizes(), [2, 1]).unwrap();
    let plan = Plan::new(16, 1, 40).unwrap();
    let lesson = |seed: u64| -> Experience {
        let mut integrand = integrand;
        let mut target = Primary::new(&mut integrand).with_kernels(&even);
        plan.replica(&mut target, (0, seed), &mut |_, _| {}).unwrap();
        target.take_experience().unwrap()
    };
    let mut integrand = integrand;
    let law = verdict(40_000, SEED, |seed| {
        let kernels = even.learn(&lesson(derive_seed(seed, 5)));
        let mut target = Primary::new(&mut integrand).with_kernels(&kernels);
        score(&plan, &mut target, seed).0
    });
    accepted("crosswise", &law);
}
