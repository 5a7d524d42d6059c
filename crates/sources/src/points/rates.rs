//! Variances over replicas, against what is known in closed form.

use super::tests::all;
use super::{LatinHypercube, PointSet, PointSource};
use crate::{UniformSource, derive_seed};

/// Replicas of each measured variance.
const REPLICAS: u64 = 1500;

/// Mean and sample variance over replicas of the mean of `f` over the first `n` points.
fn replicated(
    n: u64,
    set: impl Fn(u64) -> Box<dyn PointSet>,
    f: impl Fn(&mut dyn UniformSource) -> f64,
) -> (f64, f64) {
    let means: Vec<f64> = (0..REPLICAS)
        .map(|replica| {
            let set = set(derive_seed(77, replica));
            (0..n).map(|index| f(&mut PointSource::new(&*set, index))).sum::<f64>() / n as f64
        })
        .collect();
    let mean = means.iter().sum::<f64>() / REPLICAS as f64;
    let squares: f64 = means.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, squares / (REPLICAS - 1) as f64)
}

/// A sample variance of kurtosis at most 3 has a relative standard error of at most √(2/R): five and a half of them.
fn tolerance() -> f64 {
    5.5 * (2.0 / REPLICAS as f64).sqrt()
}

/// f(u) = u: 1/(12 n³) where strata are filled independently, 1/(12 n²) where they share an offset, 1/(12 n) by independent
/// variates (the padding).
#[test]
fn the_rate_of_a_smooth_function_of_one_variate() {
    for n in [16_u64, 64] {
        for (k, (name, _)) in all(n, 0).iter().enumerate() {
            let set = |seed| all(n, seed).into_iter().nth(k).unwrap().1;
            let (mean, variance) = replicated(n, set, |source| source.next_uniform());
            let order = if *name == "halton" { 2 } else { 3 };
            let exact = 1.0 / (12.0 * (n as f64).powi(order));
            assert!((mean - 0.5).abs() < 6.0 * (exact / REPLICAS as f64).sqrt(), "{name}: {mean}");
            assert!((variance / exact - 1.0).abs() < tolerance(), "{name}, {n}: {variance:e} for {exact:e}");
            let padding = |source: &mut dyn UniformSource| {
                (0..4).for_each(|_| _ = source.next_uniform());
                source.next_uniform()
            };
            let (_, variance) = replicated(n, set, padding);
            let exact = 1.0 / (12.0 * n as f64);
            assert!(
                (variance / exact - 1.0).abs() < tolerance(),
                "{name}: padding {variance:e} for {exact:e}"
            );
        }
    }
}

/// A product of centered variates: a Latin hypercube has N/(N − 1) times the variance between strata of independent points,
/// to (1/144 n)(1 + O(1/n)). Nothing is gained, and nothing may be claimed.
#[test]
fn a_latin_hypercube_gains_nothing_from_a_product() {
    let set = |seed| -> Box<dyn PointSet> { Box::new(LatinHypercube::new(64, 2, seed).unwrap()) };
    let product =
        |source: &mut dyn UniformSource| (source.next_uniform() - 0.5) * (source.next_uniform() - 0.5);
    let (mean, variance) = replicated(64, set, product);
    let exact = 1.0 / (144.0 * 64.0);
    assert!(mean.abs() < 6.0 * (exact / REPLICAS as f64).sqrt());
    assert!((variance / exact - 1.0).abs() < tolerance() + 2.0 / 64.0, "{variance:e} for {exact:e}");
    // A net does gain from it.
    for k in [0, 1, 2] {
        let set = |seed| all(64, seed).into_iter().nth(k).unwrap().1;
        let (mean, variance) = replicated(64, set, product);
        assert!(variance < 0.3 * exact, "{k}: {variance:e}");
        assert!(mean.abs() < 6.0 * (variance / REPLICAS as f64).sqrt());
    }
}
