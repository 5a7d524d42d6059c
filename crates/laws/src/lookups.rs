//! The law of cost: the mean number of look-ups is the expected one.

use fairflight_freeflight::HIGHEST_MOMENT;
use fairflight_stats::{ClosedMoments, Reference};

/// Law of the number of look-ups of one estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookupLaw {
    /// A Poisson variate: every particle survives every collision, and collisions are a Poisson process.
    Poisson,
    /// Always the same number.
    Fixed,
    /// E\[N^k\] of the number N of look-ups, k = 1 … 8.
    Moments([f64; HIGHEST_MOMENT]),
    /// Only its mean.
    MeanOnly,
    /// Nothing: not even its mean has a closed form. Look-ups are counted and watched, and not judged.
    Unknown,
}

/// Relative error granted to an expected number of look-ups, which is an integral by quadrature.
const QUADRATURE: f64 = 1e-8;

/// The reference that the look-ups of one estimate are judged against; `None` where nothing is known of them.
#[must_use]
pub fn reference(expected: f64, law: LookupLaw) -> Option<Reference> {
    let moments = match law {
        LookupLaw::Poisson => Some(poisson(expected)),
        LookupLaw::Fixed => Some(ClosedMoments::from_central(expected, &[Some(0.0); 7])),
        LookupLaw::Moments(raw) => Some(ClosedMoments::from_raw(&raw)),
        LookupLaw::MeanOnly => None,
        LookupLaw::Unknown => return None,
    };
    // Of walks through profiles of the catalogue's choice.
    let of_mean = Reference::exact(expected).with_mild_tails();
    Some(Reference {
        error: QUADRATURE * expected,
        moments,
        scores: crate::scores::NEVER_NEGATIVE,
        ..of_mean
    })
}

/// The reference as by [`reference()`], where E\[N^k\] of the number N of look-ups of one estimate are known, k = 1, 2, ….
#[must_use]
pub fn with_moments(raw: &[f64]) -> Reference {
    let moments = ClosedMoments::from_raw(raw);
    let mean = moments.mean;
    Reference { error: QUADRATURE * mean, moments: Some(moments), ..Reference::exact(mean) }
}

/// E\[(X + Y)^k\], k = 1 … 8, of independent X and Y: the binomial theorem.
#[must_use]
pub fn sum(x: &[f64; HIGHEST_MOMENT], y: &[f64; HIGHEST_MOMENT]) -> [f64; HIGHEST_MOMENT] {
    let moment = |raw: &[f64; HIGHEST_MOMENT], k: usize| if k == 0 { 1.0 } else { raw[k - 1] };
    std::array::from_fn(|i| {
        let (mut sum, mut binomial) = (0.0, 1.0);
        for j in 0..=i + 1 {
            sum += binomial * moment(x, j) * moment(y, i + 1 - j);
            binomial *= (i + 1 - j) as f64 / (j + 1) as f64;
        }
        sum
    })
}

/// Every cumulant of a Poisson law is its mean: m_n = Σ_{j=2..n} C(n − 1, j − 1) λ m_{n−j}.
fn poisson(mean: f64) -> ClosedMoments {
    let mut central = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for n in 2..central.len() {
        let mut binomial = 1.0;
        for j in 2..=n {
            binomial *= (n - j + 1) as f64 / (j - 1) as f64;
            central[n] += binomial * mean * central[n - j];
        }
    }
    ClosedMoments::from_central(mean, &central[2..].iter().copied().map(Some).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_number_is_judged_against_nothing() {
        assert_eq!(reference(f64::NAN, LookupLaw::Unknown), None);
        assert_eq!(reference(3.0, LookupLaw::MeanOnly).unwrap().mean, 3.0);
    }

    #[test]
    fn the_moments_of_a_sum() {
        // X is 0 or 1 with probability 1/2, Y is 2: X + Y is 2 or 3.
        let powers = |x: f64| std::array::from_fn(|i| x.powi(i as i32 + 1));
        let sums = sum(&[0.5; HIGHEST_MOMENT], &powers(2.0));
        for (i, found) in sums.into_iter().enumerate() {
            let k = i as i32 + 1;
            assert_eq!(found, 0.5 * (2.0_f64.powi(k) + 3.0_f64.powi(k)));
        }
        let law = reference(2.5, LookupLaw::Moments(sums)).unwrap().moments.unwrap();
        assert!((law.variance().unwrap() - 0.25).abs() < 1e-12, "{law:?}");
    }

    #[test]
    fn the_moments_of_a_poisson_law() {
        let law = poisson(2.0);
        let found = [2, 3, 4, 5, 6].map(|k| law.central(k));
        // λ, λ, λ + 3λ², λ + 10λ², λ + 25λ² + 15λ³
        assert_eq!(found, [2.0, 2.0, 14.0, 42.0, 222.0].map(Some));
    }
}
