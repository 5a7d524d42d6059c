//! Moments of a law in closed form, and the shape numbers that the tests of its mean and variance need.

/// Mean and central moments mu_k = E[(X - mean)^k], k = 2 to 8, of the law of one sample.
///
/// Each is `None` where it is not known (a NaN counts as not known) and may be infinite where it does not exist.
/// The test of a mean wants k up to 4, the test of a variance k = 4, 6, 8.
///
/// ```
/// use fairflight_stats::ClosedMoments;
/// let exponential = ClosedMoments::from_raw(&[1.0, 2.0, 6.0, 24.0]);
/// assert_eq!(exponential.variance(), Some(1.0));
/// assert_eq!(exponential.skewness(), Some(2.0));
/// assert_eq!(exponential.excess_kurtosis(), Some(6.0));
/// assert_eq!(exponential.central(6), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedMoments {
    /// E\[X\].
    pub mean: f64,
    /// mu_2 to mu_8.
    central: [Option<f64>; 7],
}

impl ClosedMoments {
    /// A law of which only the mean is known.
    #[must_use]
    pub const fn with_mean(mean: f64) -> Self {
        Self { mean, central: [None; 7] }
    }

    /// The moments by the mean and mu_2, mu_3, ... in order; missing ones are not known, those beyond mu_8 are ignored.
    #[must_use]
    pub fn from_central(mean: f64, central: &[Option<f64>]) -> Self {
        let moment = |i: usize| central.get(i).copied().flatten().filter(|value| !value.is_nan());
        Self { mean, central: std::array::from_fn(moment) }
    }

    /// The moments by the raw moments E\[X\], E\[X^2\], ... in order; NaN for an unknown one. An empty slice gives the mean NaN.
    ///
    /// mu_k = sum over j of C(k,j) (-mean)^(k-j) E\[X^j\] cancels where the standard deviation is small against the mean:
    /// a result below the rounding of its terms is noise, and reported as not known.
    #[must_use]
    pub fn from_raw(raw: &[f64]) -> Self {
        /// Raw moments are taken to be right to some tens of roundings.
        const NOISE: f64 = 64.0 * f64::EPSILON;
        let mean = raw.first().copied().unwrap_or(f64::NAN);
        let central = |k: usize| -> Option<f64> {
            let top = *raw.get(k - 1)?;
            if top.is_infinite() {
                return Some(top);
            }
            let (mut sum, mut size, mut binomial) = (0.0, 0.0, 1.0);
            for j in (0..=k).rev() {
                let moment = if j == 0 { 1.0 } else { raw[j - 1] };
                let term = binomial * (-mean).powi((k - j) as i32) * moment;
                sum += term;
                size += term.abs();
                binomial *= j as f64 / (k - j + 1) as f64;
            }
            (sum.abs() > NOISE * size && (k % 2 == 1 || sum > 0.0)).then_some(sum)
        };
        Self::from_central(mean, &[2, 3, 4, 5, 6, 7, 8].map(central))
    }

    /// The law of a sample that is `high` with probability p, else 0:
    /// mu_k = high^k p q (q^(k-1) + (-1)^k p^(k-1)), q = 1-p.
    #[must_use]
    pub fn two_valued(high: f64, p: f64) -> Self {
        let q = 1.0 - p;
        let central = |k: i32| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            Some(high.powi(k) * p * q * (q.powi(k - 1) + sign * p.powi(k - 1)))
        };
        Self::from_central(high * p, &[2, 3, 4, 5, 6, 7, 8].map(central))
    }

    /// mu_k, k = 2 to 8; `None` where it is not known.
    #[must_use]
    pub fn central(&self, k: usize) -> Option<f64> {
        self.central[k - 2]
    }

    /// mu_2 = Var(X).
    #[must_use]
    pub fn variance(&self) -> Option<f64> {
        self.central(2)
    }

    /// mu_3/mu_2^(3/2); `None` where unknown or undefined (variance zero or infinite).
    #[must_use]
    pub fn skewness(&self) -> Option<f64> {
        let variance = self.positive_variance()?;
        self.central(3).map(|third| third / variance / variance.sqrt())
    }

    /// mu_4/mu_2^2 - 3; `None` where unknown or undefined (variance zero or infinite, mu_4 underflown).
    #[must_use]
    pub fn excess_kurtosis(&self) -> Option<f64> {
        self.standardised_fourth().map(|fourth| fourth - 3.0)
    }

    /// Skewness of (X - mean)^2, with a_k = mu_k/mu_2^(k/2): (a_6 - 3 a_4 + 2)/(a_4 - 1)^(3/2).
    ///
    /// `None` where unknown or where (X - mean)^2 is constant or has no finite variance.
    #[must_use]
    pub fn squares_skewness(&self) -> Option<f64> {
        let (variance, fourth, spread) = self.squares()?;
        let sixth = self.central(6)? / variance / variance / variance;
        Some((sixth - 3.0 * fourth + 2.0) / spread / spread.sqrt())
    }

    /// Excess kurtosis of (X - mean)^2: (a_8 - 4 a_6 + 6 a_4 - 3)/(a_4 - 1)^2 - 3; `None` as for the skewness.
    #[must_use]
    pub fn squares_excess_kurtosis(&self) -> Option<f64> {
        let (variance, fourth, spread) = self.squares()?;
        let sixth = self.central(6)? / variance / variance / variance;
        let eighth = self.central(8)? / variance / variance / variance / variance;
        if eighth.is_infinite() {
            return Some(f64::INFINITY);
        }
        Some((eighth - 4.0 * sixth + 6.0 * fourth - 3.0) / spread / spread - 3.0)
    }

    /// Standard error of the mean of n values, sqrt(mu_2/n); may be infinite, `None` where mu_2 is unknown.
    #[must_use]
    pub fn standard_error(&self, n: f64) -> Option<f64> {
        self.variance().map(|variance| (variance / n).sqrt())
    }

    /// Standard error of the sample variance of n >= 2 values: Var(s^2) = (mu_4 - mu_2^2 (n-3)/(n-1))/n.
    ///
    /// `None` where unknown or underflown, zero for zero variance; may be infinite.
    #[must_use]
    pub fn variance_standard_error(&self, n: f64) -> Option<f64> {
        if self.variance() == Some(0.0) {
            return Some(0.0);
        }
        let fourth = self.standardised_fourth()?;
        Some(self.variance()? * ((fourth - (n - 3.0) / (n - 1.0)).max(0.0) / n).sqrt())
    }

    fn positive_variance(&self) -> Option<f64> {
        self.variance().filter(|&variance| variance > 0.0 && variance.is_finite())
    }

    /// a_4 = mu_4/mu_2^2, which is at least 1 unless mu_4 underflowed.
    fn standardised_fourth(&self) -> Option<f64> {
        const ROUNDING: f64 = 1e-6;
        let variance = self.positive_variance()?;
        self.central(4).map(|fourth| fourth / variance / variance).filter(|&fourth| fourth >= 1.0 - ROUNDING)
    }

    /// Variance of X, a_4, and a_4 - 1 where that is finite and above the rounding of a_4.
    fn squares(&self) -> Option<(f64, f64, f64)> {
        const ROUNDING: f64 = 1e-9;
        let fourth = self.standardised_fourth()?;
        let spread = fourth - 1.0;
        (spread > ROUNDING && spread.is_finite()).then_some((self.positive_variance()?, fourth, spread))
    }
}

#[cfg(test)]
mod tests {
    use super::ClosedMoments;
    use approx::assert_relative_eq;

    /// E[X^k] = k! of the unit exponential law: mean 1, mu = 1, 2, 9, 44, 265, 1854, 14833.
    const EXPONENTIAL: [f64; 8] = [1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0];

    #[test]
    fn exponential_law_from_raw_moments() {
        let law = ClosedMoments::from_raw(&EXPONENTIAL);
        assert_eq!(law.central, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0].map(Some));
        // (X-1)^2 has mean 1 and variance 8; its third central moment is 265 - 27 + 2 = 240, its fourth 13824.
        assert_relative_eq!(law.squares_skewness().unwrap(), 240.0 / 8f64.powf(1.5), max_relative = 1e-14);
        assert_relative_eq!(
            law.squares_excess_kurtosis().unwrap(),
            13824.0 / 64.0 - 3.0,
            max_relative = 1e-14
        );
        assert_relative_eq!(law.standard_error(100.0).unwrap(), 0.1);
        assert_relative_eq!(law.variance_standard_error(1e6).unwrap(), 8e-6f64.sqrt(), max_relative = 1e-6);
    }

    #[test]
    fn normal_law() {
        let raw = [0.0, 1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0];
        let law = ClosedMoments::from_central(0.0, &raw[1..].iter().copied().map(Some).collect::<Vec<_>>());
        assert_eq!((law.skewness(), law.excess_kurtosis()), (Some(0.0), Some(0.0)));
        // The square is chi-square with one degree of freedom; Var(s^2) = 2/(n-1).
        assert_relative_eq!(law.squares_skewness().unwrap(), 8f64.sqrt(), max_relative = 1e-14);
        assert_relative_eq!(law.squares_excess_kurtosis().unwrap(), 12.0, max_relative = 1e-14);
        assert_relative_eq!(law.variance_standard_error(11.0).unwrap(), 0.2f64.sqrt(), max_relative = 1e-14);
    }

    #[test]
    fn two_valued_law_agrees_with_its_raw_moments() {
        let (high, p) = (2.5f64, 0.2);
        let raw: Vec<f64> = (1..=8).map(|k| p * high.powi(k)).collect();
        let (law, other) = (ClosedMoments::two_valued(high, p), ClosedMoments::from_raw(&raw));
        for k in [2, 5, 8] {
            assert_relative_eq!(law.central(k).unwrap(), other.central(k).unwrap(), max_relative = 1e-12);
        }
        assert_relative_eq!(law.skewness().unwrap(), 0.6 / 0.4, max_relative = 1e-14);
        // A fair coin is always half a unit from its mean: its squares have no shape.
        let fair = ClosedMoments::two_valued(1.0, 0.5);
        assert_eq!((fair.squares_skewness(), fair.squares_excess_kurtosis()), (None, None));
        assert_relative_eq!(fair.variance_standard_error(101.0).unwrap(), (0.125f64 / 10100.0).sqrt());
    }

    #[test]
    fn infinite_unknown_and_vanishing_moments() {
        let heavy = ClosedMoments::from_raw(&[1.0, 2.0, f64::INFINITY, f64::INFINITY]);
        assert_eq!((heavy.skewness(), heavy.excess_kurtosis()), (Some(f64::INFINITY), Some(f64::INFINITY)));
        assert_eq!(
            (heavy.variance_standard_error(9.0), heavy.squares_skewness()),
            (Some(f64::INFINITY), None)
        );
        let heavier = ClosedMoments::from_raw(&[1.0, f64::INFINITY]);
        assert_eq!((heavier.standard_error(9.0), heavier.skewness()), (Some(f64::INFINITY), None));
        let unknown = ClosedMoments::from_central(1.0, &[Some(f64::NAN), None]);
        assert_eq!(unknown, ClosedMoments::with_mean(1.0));
        assert_eq!(unknown.standard_error(9.0), None);
        // A spread of 1e-9 around 1 drowns in the rounding of E[X^2].
        assert_eq!(ClosedMoments::from_raw(&[1.0, 1.0 + 4.0 * f64::EPSILON]).variance(), None);
        let constant = ClosedMoments::from_central(1.0, &[Some(0.0), Some(0.0), Some(0.0)]);
        assert_eq!(
            (constant.standard_error(9.0), constant.variance_standard_error(9.0)),
            (Some(0.0), Some(0.0))
        );
        assert_eq!((constant.skewness(), constant.excess_kurtosis()), (None, None));
        let underflown = ClosedMoments::from_central(0.0, &[Some(1e-200), Some(0.0), Some(0.0)]);
        assert_eq!((underflown.excess_kurtosis(), underflown.variance_standard_error(9.0)), (None, None));
    }
}
