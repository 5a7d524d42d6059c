//! Targets that follow noise: the image is what it was. What must change together is told by twins in the catalogue.

mod toys;

use fairflight_metropolis::{Importance, ImportanceRule, Integrand, Plan, Primary, Splats};
use fairflight_sources::{SmallStep, UniformSource, derive_seed};
use fairflight_stats::Moments;
use toys::{SEED, accepted, half, integrand, modes, score, verdict};

/// The left half is six times as important.
fn importance() -> Importance {
    Importance::new([2, 1], vec![6.0, 1.0]).unwrap()
}

fn primary(integrand: &mut dyn Integrand<f64>) -> Primary<'_, f64> {
    Primary::new(integrand).with_small_step(SmallStep::new(0.002, 0.04).unwrap())
}

#[test]
fn any_importance_has_the_same_image() {
    let (mut integrand, importance) = (integrand, importance());
    let mut target = primary(&mut integrand).with_importance(&importance);
    let plan = Plan::new(16, 1, 20).unwrap();
    accepted("importance", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
}

#[test]
fn stages_learn_where_the_noise_is() {
    // The right pixel is noisy: replicas of a first stage say so, and a second one has less of it.
    let mut integrand = |splats: &mut Splats<f64>, source: &mut dyn UniformSource| {
        let [u, chance] = [(); 2].map(|()| source.next_uniform());
        let noise = if half(u) == [0, 0] { 1.0 } else { f64::from(u8::from(chance < 0.04)) / 0.04 };
        splats.push(half(u), modes(u) * noise);
    };
    let even = Importance::even([2, 1]).unwrap();
    let rule = ImportanceRule { radius: 0, ..ImportanceRule::default() };
    let plan = Plan::new(1000, 1, 300).unwrap();
    let mut stage = |importance: &Importance, seed: u64| {
        let mut target = primary(&mut integrand).with_importance(importance);
        let mut moments = [Moments::new(); 2];
        for index in 0..2000 {
            let mut image = [0.0; 2];
            plan.replica(&mut target, (index, seed), &mut |[column, _], value| {
                image[column as usize] += value;
            })
            .unwrap();
            for (moments, value) in moments.iter_mut().zip(image) {
                moments.push(value);
            }
        }
        moments
    };
    let of = |moments: &[Moments; 2], what: fn(&Moments) -> Option<f64>| moments.map(|m| what(&m).unwrap());
    let first = stage(&even, derive_seed(SEED, 1));
    let learnt =
        even.learn(&rule, &of(&first, Moments::mean), &of(&first, Moments::sample_variance)).unwrap();
    assert!(learnt.of([1, 0]) > 1.2 * learnt.of([0, 0]), "{learnt:?}");
    let second = stage(&learnt, derive_seed(SEED, 2));
    let relative = |moments: &Moments| moments.sample_variance().unwrap() / moments.mean().unwrap().powi(2);
    assert!(relative(&second[1]) < relative(&first[1]), "{first:?} {second:?}");
    let unbiased = |seed| {
        let mut target = primary(&mut integrand).with_importance(&learnt);
        score(&plan, &mut target, seed).0
    };
    accepted("second stage", &verdict(2000, derive_seed(SEED, 3), unbiased));
}
