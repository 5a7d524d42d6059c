//! A measured or computed phase function, linear between its nodes.

use super::{PhaseError, PhaseFunction};
use crate::FieldError;
use crate::interpolation::between;
use std::f64::consts::TAU;

/// Linear in the cosine between `cosines[i]` and the next node, normalised by the constructor.
///
/// The density per unit of cosine p = 2π eval is linear in a piece of width h, from a to b. With the probability c from
/// the end where it is smaller, say a, the fraction t of the piece solves (b − a)t²/2 + at = c/h, whose root
/// t = 2(c/h)/(a + √(a² + 2(b − a)c/h)) has terms of one sign only.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    cosines: Vec<f64>,
    /// 2π eval at the nodes.
    densities: Vec<f64>,
    /// The distribution function at the nodes; the last is exactly 1.
    distribution: Vec<f64>,
    mean_cosine: f64,
}

impl Tabulated {
    /// Nodes at `cosines`, increasing from −1 to 1, with values in any unit, as only their ratios count.
    ///
    /// # Errors
    /// If there are fewer than two nodes, the cosines do not increase from −1 to 1, the values do not fit their number, one
    /// is negative or not finite, or all are zero.
    pub fn new(cosines: Vec<f64>, values: Vec<f64>) -> Result<Self, PhaseError> {
        FieldError::check_nodes("cosines", &cosines)?;
        FieldError::check_len("values", cosines.len(), values.len())?;
        FieldError::check_all_finite("values", &values)?;
        values.iter().try_for_each(|&value| FieldError::check_at_least("values", 0.0, value))?;
        let (first, last) = (cosines[0], cosines[cosines.len() - 1]);
        if (first, last) != (-1.0, 1.0) {
            return Err(PhaseError::NotFromBackToFront { first, last });
        }
        let greatest = values.iter().copied().fold(0.0, f64::max);
        if greatest == 0.0 {
            return Err(PhaseError::NowherePositive);
        }
        // Relative to the greatest value, so that no sum leaves the range of numbers.
        let mut densities = values;
        densities.iter_mut().for_each(|value| *value /= greatest);
        let mut distribution = vec![0.0; cosines.len()];
        let mut first_moment = 0.0;
        for i in 1..cosines.len() {
            let (width, middle) = (cosines[i] - cosines[i - 1], 0.5 * (cosines[i] + cosines[i - 1]));
            let mass = 0.5 * width * (densities[i] + densities[i - 1]);
            distribution[i] = distribution[i - 1] + mass;
            // ∫ μ p over a piece: its mass at the middle, and the slope times ∫ (μ − middle)² = h³/12.
            first_moment += middle * mass + (densities[i] - densities[i - 1]) * width * width / 12.0;
        }
        let total = distribution[cosines.len() - 1];
        densities.iter_mut().chain(&mut distribution).for_each(|number| *number /= total);
        Ok(Self { cosines, densities, distribution, mean_cosine: first_moment / total })
    }

    /// The hazy atmosphere of nishita-1987: (1 + 9 cos¹⁶(θ/2))/(8π), an approximation of Mie's theory, at `nodes`
    /// equidistant cosines.
    ///
    /// The function is normalised itself, and its mean cosine is 2/5. Interpolated at a distance h of the nodes it is too
    /// large by 63h²/8 at most, in units of 1/(4π), where its peak is 5, and normalisation divides by at most
    /// 1 + 3h²/4 (the trapezoidal rule with p' = 9 at the peak): 33 nodes are right to 0.6 % of the peak, 257 to 1e-4.
    ///
    /// # Errors
    /// If there are fewer than two nodes.
    pub fn hazy_mie(nodes: usize) -> Result<Self, PhaseError> {
        if nodes < 2 {
            return Err(FieldError::TooFew { what: "cosines", least: 2, found: nodes }.into());
        }
        let last = (nodes - 1) as f64;
        let cosines: Vec<f64> = (0..nodes).map(|i| (2.0 * i as f64 - last) / last).collect();
        let values = cosines.iter().map(|cosine| 1.0 + 9.0 * (0.5 * (1.0 + cosine)).powi(8)).collect();
        Self::new(cosines, values)
    }

    /// The cosines of the nodes, between which the function is smooth.
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }
}

impl PhaseFunction for Tabulated {
    #[inline]
    fn eval(&self, cosine: f64) -> f64 {
        let cosine = cosine.clamp(-1.0, 1.0);
        let inner = &self.cosines[1..self.cosines.len() - 1];
        let i = inner.partition_point(|&node| node <= cosine);
        let (from, to) = (self.cosines[i], self.cosines[i + 1]);
        let (a, b) = (self.densities[i], self.densities[i + 1]);
        let mass = a * (to - cosine) + b * (cosine - from);
        between(mass / (TAU * (to - from)), a / TAU, b / TAU)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        // The first node beyond u ends a piece of positive probability; the last node, at 1, is beyond every variate.
        let end = self.distribution.partition_point(|&below| below <= u).clamp(1, self.cosines.len() - 1);
        let (from, to) = (self.cosines[end - 1], self.cosines[end]);
        let (a, b) = (self.densities[end - 1], self.densities[end]);
        let width = to - from;
        let cosine = if a <= b {
            from + width * fraction(a, b, (u - self.distribution[end - 1]) / width)
        } else {
            to - width * fraction(b, a, (self.distribution[end] - u) / width)
        };
        cosine.clamp(from, to)
    }
    fn mean_cosine(&self) -> f64 {
        self.mean_cosine
    }
}

/// The t with (high − low)t²/2 + low t = `mass`.
#[inline]
fn fraction(low: f64, high: f64, mass: f64) -> f64 {
    debug_assert!(low <= high && mass >= 0.0, "{low}, {high}, {mass}");
    if mass <= 0.0 {
        return 0.0;
    }
    2.0 * mass / (low + (low * low + 2.0 * (high - low) * mass).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Tolerance, adaptive_integral};

    const LARGEST_VARIATE: f64 = 1.0 - f64::EPSILON / 2.0;

    fn ragged() -> Tabulated {
        let cosines = vec![-1.0, -0.8, -0.5, 0.0, 0.1, 0.9, 1.0];
        Tabulated::new(cosines, vec![2.0, 0.0, 0.0, 3.0, 0.5, 0.5, 4e300 * 1e-299]).unwrap()
    }

    /// ∫ 2π eval · (1, μ) up to a cosine.
    fn integrals(phase: &Tabulated, cosine: f64) -> [f64; 2] {
        let breaks: Vec<f64> = phase.cosines().iter().map(|node| node + 1.0).collect();
        let integrand = |s: f64| [TAU * phase.eval(s - 1.0), TAU * phase.eval(s - 1.0) * (s - 1.0)];
        adaptive_integral(1.0 + cosine, &breaks, Tolerance::TIGHT, integrand).value
    }

    #[test]
    fn it_is_normalised_and_has_the_mean_cosine_of_its_pieces() {
        for phase in [ragged(), Tabulated::hazy_mie(33).unwrap(), Tabulated::hazy_mie(2).unwrap()] {
            let [one, mean] = integrals(&phase, 1.0);
            assert!((one - 1.0).abs() < 1e-14, "{one}");
            assert!((mean - phase.mean_cosine()).abs() < 1e-14, "{mean}");
        }
    }

    #[test]
    fn it_keeps_to_the_values_of_its_nodes() {
        let flat = Tabulated::new(vec![-1.0, -0.3, 0.1, 1.0], vec![0.7, 0.7, 0.7, 0.1]).unwrap();
        let node = flat.eval(-1.0);
        for i in 0..10_000 {
            let cosine = f64::from(i) * 1.1e-4 - 1.0;
            assert_eq!(flat.eval(cosine), node, "{cosine}");
        }
        assert!((0..10_000).all(|i| flat.eval(0.1 + f64::from(i) * 9e-5) <= node));
    }

    #[test]
    fn inversion_solves_the_distribution_and_never_lands_in_a_gap() {
        let phase = ragged();
        for i in 0..1000 {
            let u = f64::from(i) / 1000.0;
            let cosine = phase.sample_cosine(u);
            assert!((integrals(&phase, cosine)[0] - u).abs() < 1e-14, "u = {u}");
            assert!(!(-0.8 + 1e-9..-0.5).contains(&cosine), "u = {u}: {cosine}");
        }
    }

    #[test]
    fn both_ends_of_the_variates_are_cosines() {
        let tent = Tabulated::new(vec![-1.0, 0.0, 1.0], vec![0.0, 1.0, 0.0]).unwrap();
        assert_eq!((tent.sample_cosine(0.0), tent.sample_cosine(0.5)), (-1.0, 0.0));
        // The probability 2^-53 is left: μ = 1 − √(2 · 2^-53).
        let rest = 1.0 - tent.sample_cosine(LARGEST_VARIATE);
        assert!((rest / f64::EPSILON.sqrt() - 1.0).abs() < 1e-7, "{rest:e}");
        let gap_in_front = Tabulated::new(vec![-1.0, 0.5, 1.0], vec![1.0, 0.0, 0.0]).unwrap();
        assert!(gap_in_front.sample_cosine(LARGEST_VARIATE) <= 0.5);
        assert!(ragged().sample_cosine(LARGEST_VARIATE) <= 1.0);
    }

    #[test]
    fn hazy_mie_nears_the_function_that_it_interpolates() {
        for nodes in [33, 257] {
            let phase = Tabulated::hazy_mie(nodes).unwrap();
            let h = 2.0 / (nodes - 1) as f64;
            for i in 0..=1000 {
                let cosine = f64::from(i) / 500.0 - 1.0;
                let exact = 0.5 + 4.5 * (0.5 * (1.0 + cosine)).powi(8);
                let found = 2.0 * TAU * phase.eval(cosine);
                assert!(found - exact < 63.0 / 8.0 * h * h + 1e-14, "{cosine}");
                assert!(found * (1.0 + 0.75 * h * h) >= exact * (1.0 - 1e-14), "{cosine}: convex");
            }
            assert!((phase.mean_cosine() - 0.4).abs() < h * h, "{}", phase.mean_cosine());
        }
    }

    #[test]
    fn bad_tables_are_refused() {
        let new =
            |cosines: &[f64], values: &[f64]| Tabulated::new(cosines.to_vec(), values.to_vec()).unwrap_err();
        assert!(matches!(new(&[-1.0], &[1.0]), PhaseError::Table(FieldError::TooFew { .. })));
        assert!(matches!(new(&[-1.0, 1.0], &[1.0]), PhaseError::Table(FieldError::LengthMismatch { .. })));
        assert!(matches!(
            new(&[1.0, -1.0], &[1.0, 1.0]),
            PhaseError::Table(FieldError::NotIncreasing { .. })
        ));
        assert!(matches!(new(&[-1.0, 1.0], &[1.0, -1.0]), PhaseError::Table(FieldError::TooSmall { .. })));
        assert!(matches!(
            new(&[-1.0, 1.0], &[1.0, f64::NAN]),
            PhaseError::Table(FieldError::NotFinite { .. })
        ));
        assert!(matches!(new(&[-1.0, 0.9], &[1.0, 1.0]), PhaseError::NotFromBackToFront { .. }));
        assert_eq!(new(&[-1.0, 1.0], &[0.0, 0.0]), PhaseError::NowherePositive);
        assert!(Tabulated::hazy_mie(1).is_err());
    }
}
