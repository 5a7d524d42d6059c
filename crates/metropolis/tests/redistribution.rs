//! Energy redistribution has no bias, whatever its chains reach, and deposits what it was given. Other numbers of chains are twins in the catalogue.

mod toys;

use fairflight_metropolis::{
    Acceptance, Integrand, NotFinite, Primary, Proposed, Redistribution, RedistributionError,
};
use fairflight_metropolis::{Redistributed, Splats, Target};
use fairflight_sources::{SmallStep, Step, UniformSource};
use fairflight_stats::{Moments, Reference, judge};
use toys::{Altered, SEED, accepted, image, integrand, left, verdict};

const STEPS: u64 = 10;

/// Small steps alone: each chain stays in its mode.
fn primary(integrand: &mut dyn Integrand<f64>) -> Primary<'_, f64> {
    let small = SmallStep::new(0.002, 0.04).unwrap();
    Primary::new(integrand).with_small_step(small).with_large_step(0.0).unwrap()
}

/// The energy of a step for so many chains per sample on average.
fn energy(chains: f64) -> f64 {
    image().iter().sum::<f64>() / (STEPS as f64 * chains)
}

fn score(how: &Redistribution, target: &mut dyn Target<f64>, seed: u64) -> f64 {
    left(|film| {
        how.sample(target, (0, seed), &mut [Acceptance::default(); 2], film).unwrap();
    })
}

#[test]
fn energy_is_redistributed_without_bias() {
    let mut integrand = integrand;
    let mut target = primary(&mut integrand);
    for chains in [0.5, 2.0] {
        let how = Redistribution::new(STEPS, energy(chains)).unwrap();
        let law = verdict(200_000, SEED, |seed| score(&how, &mut target, seed));
        accepted(&format!("{chains} chains per sample"), &law);
        let capped = how.with_most_chains(1).unwrap();
        let law = verdict(200_000, SEED, |seed| score(&capped, &mut target, seed));
        accepted(&format!("{chains} chains per sample, one at most"), &law);
    }
}

#[test]
fn idle_chains_give_back_what_they_were_given() {
    let mut integrand = integrand;
    let idle = |target: &mut Primary<'_, f64>, source: &mut dyn UniformSource| {
        target.sample(Step::Again, source);
        Proposed { kind: 1, acceptance: 1.0 }
    };
    let mut target = Altered { inner: primary(&mut integrand), propose: idle, swapped: false };
    // Given the sample, the number of chains has two values, and the energy of either is known.
    let how = Redistribution::new(STEPS, energy(3.0)).unwrap();
    for seed in 0..200 {
        let (mut found, mut sum) = (Redistributed::default(), 0.0);
        let mut counts = [Acceptance::default(); 2];
        found =
            how.sample(&mut target, (0, seed), &mut counts, &mut |_, value| sum += value).unwrap_or(found);
        let expected = found.chains as f64 * STEPS as f64 * energy(3.0);
        assert!((sum - expected).abs() <= 1e-13 * expected.max(1e-300));
        let chains = found.weight / (STEPS as f64 * energy(3.0));
        assert!((found.chains as f64 - chains).abs() <= 1.0);
        assert_eq!(counts[1].proposed, found.chains * STEPS);
    }
    accepted("idle", &verdict(200_000, SEED, |seed| score(&how, &mut target, seed)));
}

#[test]
fn energy_in_is_energy_out() {
    let mut integrand = integrand;
    let mut target = primary(&mut integrand);
    let how = Redistribution::new(STEPS, energy(2.0)).unwrap();
    let truth: f64 = image().iter().sum();
    let moments: Moments = (0..100_000)
        .map(|index| {
            let mut sum = 0.0;
            let counts = &mut [Acceptance::default(); 2];
            how.sample(&mut target, (index, SEED), counts, &mut |_, value| sum += value).unwrap();
            sum
        })
        .collect();
    let verdict = judge(&moments, &Reference::exact(truth).with_mild_tails(), 1e-6);
    assert_eq!(verdict.sound, Some(true), "{}", verdict.reason);
}

#[test]
fn what_redistributes_nothing_is_refused() {
    assert_eq!(Redistribution::new(0, 1.0), Err(RedistributionError::NoSteps));
    for energy in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(Redistribution::new(1, energy), Err(RedistributionError::NotEnergy(energy)));
    }
    let how = Redistribution::new(1, 1.0).unwrap();
    assert_eq!(how.with_most_chains(0), Err(RedistributionError::NoChains));
    let mut broken = |splats: &mut Splats<f64>, _: &mut dyn UniformSource| splats.push([0, 0], f64::NAN);
    let found = how.sample(&mut Primary::new(&mut broken), (0, 1), &mut [], &mut |_, _| {});
    assert_eq!(found, Err(NotFinite));
}
