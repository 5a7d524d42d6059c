//! The start of chains: replicas have no start-up bias, whatever their kernel, length and number of samples. Other starts are twins in the catalogue.

mod toys;

use fairflight_metropolis::{Bootstrap, Phase, Plan, Primary, Proposed, Refused, Splats, Target};
use fairflight_sources::{Scripted, Seeded, SmallStep, Step, UniformSource, derive_seed};
use toys::{Altered, SEED, accepted, half, integrand, modes, rejected, score, verdict};

/// Small steps of at most 0.04, which stay in their mode, and large ones of a probability.
fn primary<'i>(
    integrand: &'i mut dyn fairflight_metropolis::Integrand<f64>,
    large_step: f64,
) -> Primary<'i, f64> {
    let small = SmallStep::new(0.002, 0.04).unwrap();
    Primary::new(integrand).with_small_step(small).with_large_step(large_step).unwrap()
}

/// Stays where it is, by a proposal that is accepted.
fn idle(target: &mut Primary<'_, f64>, source: &mut dyn UniformSource) -> Proposed {
    target.sample(Step::Again, source);
    Proposed { kind: 0, acceptance: 1.0 }
}

#[test]
fn an_idle_chain_scores_the_sample_that_it_started_from() {
    // M = 1: b̂ F/f* = F, for every sample, whatever is proposed and refused, and black ones score nothing.
    let mut integrand = integrand;
    let mut again = Altered { inner: primary(&mut integrand, 0.0), propose: idle, swapped: false };
    let plan = Plan::new(1, 1, 7).unwrap();
    for seed in 0..100 {
        let mut sample = Seeded::new(derive_seed(derive_seed(derive_seed(seed, 0), 0), 0));
        let u = sample.next_uniform();
        let expected = if half(u) == [0, 0] { modes(u) } else { 0.0 };
        let (found, brightness) = score(&plan, &mut again, seed);
        assert!((found - expected).abs() <= 1e-14 * expected, "{found} {expected}");
        assert_eq!(brightness, modes(u));
    }
}

#[test]
fn an_idle_chain_from_several_samples_is_their_mean() {
    let mut integrand = integrand;
    let mut again = Altered { inner: primary(&mut integrand, 0.0), propose: idle, swapped: false };
    let plan = Plan::new(16, 3, 5).unwrap();
    accepted("idle", &verdict(4000, SEED, |seed| score(&plan, &mut again, seed).0));
}

/// Sizes of the laws below.
const STEPS: u64 = 20;

#[test]
fn replicas_have_no_start_up_bias() {
    // A bias of a twentieth would be 8 standard errors.
    for (samples, large_step, replicas) in [(1, 0.0, 200_000), (16, 0.0, 20_000), (16, 0.3, 20_000)] {
        let mut integrand = integrand;
        let mut target = primary(&mut integrand, large_step);
        let plan = Plan::new(samples, 1, STEPS).unwrap();
        let law = verdict(replicas, SEED, |seed| score(&plan, &mut target, seed).0);
        accepted(&format!("M = {samples}, large steps {large_step}"), &law);
    }
}

#[test]
fn chains_of_one_set_share_it_without_bias() {
    let mut integrand = integrand;
    let mut target = primary(&mut integrand, 0.1);
    let plan = Plan::new(4, 3, 10).unwrap();
    accepted("three chains", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
}

#[test]
fn scores_of_the_wrong_state_are_found() {
    // mlt_swapped: what is refused is scored as if accepted, as algorithm 5 of antwerpen-2011 prints it. Large steps alone, of which most are
    // refused: half of the energy goes where there is little light. Expected |z| 54.
    let mut integrand = integrand;
    let propose = |target: &mut Primary<'_, f64>, source: &mut dyn UniformSource| target.propose(source);
    let inner = primary(&mut integrand, 1.0);
    let mut target = Altered { inner, propose, swapped: false };
    let plan = Plan::new(16, 1, 4).unwrap();
    accepted("as it should be", &verdict(20_000, SEED, |seed| score(&plan, &mut target, seed).0));
    target.swapped = true;
    rejected("mlt_swapped", &verdict(20_000, SEED, |seed| score(&plan, &mut target, seed).0));
}

#[test]
fn a_black_replica_scores_nothing_and_says_so() {
    let mut dark = |_: &mut Splats<f64>, source: &mut dyn UniformSource| {
        source.next_uniform();
    };
    let mut target = Primary::new(&mut dark);
    let replica =
        Plan::new(5, 2, 6).unwrap().replica(&mut target, (3, 1), &mut |_, _| panic!("nothing shines"));
    let replica = replica.unwrap();
    assert!(replica.is_black && replica.bootstrap.mean() == Some(0.0));
    assert!(replica.acceptance.iter().all(|kind| kind.mean().is_none()));
}

#[test]
fn what_is_not_finite_is_refused_with_its_place() {
    for (bad, from) in [(f64::NAN, 3), (f64::INFINITY, 12), (f64::NEG_INFINITY, 11), (f64::NAN, 17)] {
        let mut drawn = 0;
        let mut broken = |splats: &mut Splats<f64>, source: &mut dyn UniformSource| {
            source.next_uniform();
            splats.push([0, 0], if drawn == from { bad } else { -1.0 });
            drawn += 1;
        };
        let mut target = Primary::new(&mut broken);
        let found = Plan::new(10, 1, 20).unwrap().replica(&mut target, (4, 1), &mut |_, _| {});
        // The eleventh sample is that of the start, drawn again.
        let expected = match from {
            0..10 => Refused { replica: 4, phase: Phase::Bootstrap, index: from },
            _ => Refused { replica: 4, phase: Phase::Steps, index: from - 11 },
        };
        assert_eq!(found.unwrap_err(), expected);
        assert!(expected.to_string().starts_with("a contribution is not finite: replica 4, s"));
    }
}

#[test]
fn the_start_is_chosen_in_proportion_to_the_weights() {
    // Weights 0, 1, 0, 3: a variate below 1/4 chooses the second, any other the last.
    let mut drawn = 0;
    let mut weights = |splats: &mut Splats<f64>, _: &mut dyn UniformSource| {
        splats.push([0, 0], [0.0, 1.0, 0.0, 3.0][drawn]);
        drawn += 1;
    };
    let set = Bootstrap::draw(&mut Primary::new(&mut weights), 4, 1).unwrap();
    assert_eq!(set.brightness(), 1.0);
    for (u, expected) in [(0.0, 1), (0.249, 1), (0.25, 3), (1.0 - f64::EPSILON / 2.0, 3)] {
        assert_eq!(set.choose(&mut Scripted::new([u])), Some(expected));
    }
    let mut dark = |_: &mut Splats<f64>, _: &mut dyn UniformSource| {};
    let none = Bootstrap::draw(&mut Primary::new(&mut dark), 4, 1).unwrap();
    assert_eq!(none.choose(&mut Scripted::new([])), None);
}
