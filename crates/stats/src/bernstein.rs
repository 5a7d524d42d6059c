//! Bernstein's inequality: a bound on the mean of bounded values that holds for every N and every skewness.
//!
//! For N independent values with mean mu, variance V and |x - mu| <= b,
//! P(|mean_N - mu| >= t) <= 2 exp(-N t^2 / (2 (V + b t/3))).
//! Source: Bernstein 1924; Boucheron, Lugosi and Massart, "Concentration Inequalities" (2013), corollary 2.11. It also
//! holds with any upper bound of V in the place of V.

/// Facts about one value: enough for Bernstein's inequality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bernstein {
    /// Variance V of one value, or an upper bound of it; the square of the unit of a value.
    pub variance: f64,
    /// Greatest distance b of a value from its mean; the unit of a value.
    pub bound: f64,
}

impl Bernstein {
    /// Upper bound of the two-sided p-value of a deviation |mean_N - mu| = t of the mean of n values; at most 1.
    ///
    /// 1 for n = 0 and for t = 0; 0 for t > 0 where variance and bound are both zero.
    #[must_use]
    pub fn p_value(&self, deviation: f64, n: f64) -> f64 {
        debug_assert!(
            self.variance >= 0.0 && self.bound >= 0.0,
            "variance and bound are at least zero: {self:?}"
        );
        let t = deviation.abs();
        if t == 0.0 || n == 0.0 {
            return 1.0;
        }
        // Divided by t once, so that a tiny t does not underflow.
        (2.0 * (-n * t / (2.0 * (self.variance / t + self.bound / 3.0))).exp()).min(1.0)
    }

    /// The deviation t of the mean of n values whose p-value bound equals `level`, in (0, 1].
    ///
    /// With L = ln(2/level), the positive root of N t^2 = 2 L (V + b t/3):
    /// t = bL/(3N) + sqrt((bL/(3N))^2 + 2VL/N). Infinite for n = 0.
    #[must_use]
    pub fn deviation(&self, level: f64, n: f64) -> f64 {
        debug_assert!(level > 0.0 && level <= 1.0, "a level lies in (0, 1], found {level}");
        let log = (2.0 / level).ln();
        let linear = self.bound * log / (3.0 * n);
        linear + (linear * linear + 2.0 * self.variance * log / n).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::Bernstein;
    use crate::binomial::Binomial;
    use approx::assert_relative_eq;

    #[test]
    fn deviation_inverts_the_p_value() {
        for (variance, bound, n) in [(0.25, 0.5, 100.0), (1e-9, 1.0, 1e6), (0.0, 2.0, 50.0), (1.0, 0.0, 10.0)]
        {
            let law = Bernstein { variance, bound };
            for level in [0.5, 0.01, 1e-6, 1e-30] {
                assert_relative_eq!(law.p_value(law.deviation(level, n), n), level, max_relative = 1e-10);
            }
        }
    }

    #[test]
    fn limiting_cases() {
        let law = Bernstein { variance: 0.25, bound: 0.5 };
        assert_eq!(
            (law.p_value(0.0, 100.0), law.p_value(0.3, 0.0), law.p_value(1e-9, 100.0)),
            (1.0, 1.0, 1.0)
        );
        assert_eq!(law.deviation(1e-6, 0.0), f64::INFINITY);
        let constant = Bernstein { variance: 0.0, bound: 0.0 };
        assert_eq!((constant.p_value(0.0, 9.0), constant.p_value(1e-300, 9.0)), (1.0, 0.0));
        // Without a bound it is the sub-Gaussian bound 2 exp(-N t^2 / 2V).
        let free = Bernstein { variance: 4.0, bound: 0.0 };
        assert_relative_eq!(free.p_value(0.8, 100.0), 2.0 * (-8.0f64).exp(), max_relative = 1e-14);
    }

    #[test]
    fn bounds_the_exact_tails_of_the_binomial_law() {
        for (n, p) in [(50u64, 0.5), (1000, 0.01), (100_000, 1e-5), (200, 0.9)] {
            let (law, size) = (Binomial::new(n, p).unwrap(), n as f64);
            let bernstein = Bernstein { variance: p * (1.0 - p), bound: p.max(1.0 - p) };
            for step in 0..=200 {
                let t = f64::from(step) / 200.0 * bernstein.deviation(1e-9, size);
                let (low, high) = ((size * (p - t)).floor(), (size * (p + t)).ceil());
                let below = if low < 0.0 { 0.0 } else { law.lower_tail(low as u64) };
                let exact = below + law.upper_tail(high as u64);
                assert!(exact.min(1.0) <= bernstein.p_value(t, size), "N {n}, p {p}, t {t}: {exact}");
            }
        }
    }
}
