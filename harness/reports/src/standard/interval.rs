//! 95 % intervals of a root mean squared error.

use fairflight_harness::comparison::bootstrap_mean;

/// The two-sided 95 % quantile of the normal law.
const Z: f64 = 1.96;

/// The interval of an RMSE that was measured over `replicas`, by the chi-square law with as many degrees of freedom as the
/// mean of squared errors really has.
///
/// For normal errors these are the replicas. For others the variance of the mean of R squared errors,
/// (E\[e⁴\] − E\[e²\]²)/R, is matched to that of σ² χ²_ν/ν, 2σ⁴/ν (Satterthwaite 1946): ν = 2R/(K − 1), K = E\[e⁴\]/E\[e²\]².
/// A heavy tail has few degrees of freedom, and an interval that says so.
pub(super) fn chi_square(rmse: f64, replicas: f64, fourth_over_square: f64) -> [f64; 2] {
    let excess = fourth_over_square - 1.0;
    if rmse == 0.0 || excess <= 0.0 {
        return [rmse, rmse];
    }
    let degrees = 2.0 * replicas / excess;
    let [low, high] = [0.025, 0.975].map(|p| chi_square_quantile(degrees, p));
    [rmse * (degrees / high).sqrt(), rmse * (degrees / low).sqrt()]
}

/// Wilson & Hilferty's cube root; its lower tail bounded from below by the leading term of the law near 0,
/// P(χ² < x) ≈ (x/2)^{ν/2}/Γ(ν/2 + 1), where the cube root fails (ν below about 3).
fn chi_square_quantile(degrees: f64, p: f64) -> f64 {
    let z = if p < 0.5 { -Z } else { Z };
    let spread = 2.0 / (9.0 * degrees);
    let cube_root = degrees * (1.0 - spread + z * spread.sqrt()).max(0.0).powi(3);
    if p > 0.5 || degrees > 6.0 {
        return cube_root;
    }
    // Γ is at least 0.8856 on (1, 4).
    cube_root.max(2.0 * (0.8856 * p).powf(2.0 / degrees))
}

/// The percentile bootstrap interval of the root of a mean of squared errors over pixels.
pub(super) fn bootstrap_rmse(squared_errors: &[f64], seed: u64) -> [f64; 2] {
    const RESAMPLES: usize = 400;
    bootstrap_mean(squared_errors, RESAMPLES, seed).map(f64::sqrt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::{Seeded, UniformSource};

    #[test]
    fn chi_square_quantiles_of_tables() {
        for (degrees, low, high) in
            [(1.0, 0.000_98, 5.02), (2.0, 0.0506, 7.38), (10.0, 3.247, 20.48), (64.0, 43.78, 88.0)]
        {
            let found = [0.025, 0.975].map(|p| chi_square_quantile(degrees, p));
            assert!((found[0] / low - 1.0).abs() < 0.25, "{degrees}: {found:?}");
            assert!((found[1] / high - 1.0).abs() < 0.02, "{degrees}: {found:?}");
        }
    }

    #[test]
    fn normal_errors_have_as_many_degrees_of_freedom_as_replicas() {
        let [low, high] = chi_square(1.0, 64.0, 3.0);
        assert!(
            (low - (64.0 / 88.0_f64).sqrt()).abs() < 1e-3 && (high - (64.0 / 43.78_f64).sqrt()).abs() < 1e-3
        );
        assert_eq!(chi_square(0.3, 64.0, 1.0), [0.3, 0.3]);
    }

    #[test]
    fn the_bootstrap_covers_the_error_of_a_mean() {
        let mut source = Seeded::new(5);
        let squares: Vec<f64> = (0..1000).map(|_| source.next_exponential()).collect();
        let [low, high] = bootstrap_rmse(&squares, 1);
        // Standard error of the mean of exponentials 1/√1000; of its root half of that.
        assert!(low < 1.0 && 1.0 < high && (high - low - 2.0 * 1.96 * 0.0158).abs() < 0.02, "{low} {high}");
    }
}
