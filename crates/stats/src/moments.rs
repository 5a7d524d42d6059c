//! Streaming, mergeable moments of a sample: count, mean, central sums up to the fourth power, extremes.

/// Count, mean, central sums M_k = sum (x - mean)^k for k = 2, 3, 4, minimum and maximum of a stream of numbers.
///
/// Source: Pébay, "Formulas for robust, one-pass parallel computation of covariances and arbitrary-order statistical
/// moments", Sandia report SAND2008-6212 (2008), to the fourth order; the single-value form is Terriberry's.
///
/// The sums are central, so that a large mean costs no digits: values of mean 1e6 and variance 1e-3 keep about eight.
/// A constant stream has central sums of exactly zero, pushed, merged or taken from a slice.
///
/// Values must be finite (asserted in debug builds); otherwise every result is NaN or infinite. Beyond magnitudes of
/// about 1e77 or below 1e-77 the fourth power leaves the range of f64: skewness and kurtosis are then `None` or infinite.
///
/// Speed: `push` costs one division, about 10 ns. A caller that has a block of values at hand should use
/// [`Moments::from_slice`], two passes that vectorise, four times faster and slightly more accurate, and merge the
/// blocks.
///
/// ```
/// use fairflight_stats::Moments;
/// let mut left: Moments = [1.0, 2.0].into_iter().collect();
/// let right: Moments = [3.0, 4.0].into_iter().collect();
/// left.merge(&right);
/// assert_eq!(left.mean(), Some(2.5));
/// assert_eq!(left.population_variance(), Some(1.25));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    m2: f64,
    m3: f64,
    m4: f64,
    minimum: f64,
    maximum: f64,
}

/// Independent partial sums of [`Moments::from_slice`]; fixed, because the order of summation is part of the result.
const LANES: usize = 8;

impl Moments {
    /// The moments of no values.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            count: 0,
            mean: 0.0,
            m2: 0.0,
            m3: 0.0,
            m4: 0.0,
            minimum: f64::INFINITY,
            maximum: f64::NEG_INFINITY,
        }
    }

    /// Adds one value.
    #[inline]
    pub fn push(&mut self, x: f64) {
        debug_assert!(x.is_finite(), "a sample must be finite, found {x}");
        let before = self.count as f64;
        self.count += 1;
        self.minimum = self.minimum.min(x);
        self.maximum = self.maximum.max(x);
        if before == 0.0 {
            // Apart, so that the mean of one value is that value and no overflow of x^2 meets a factor of zero.
            self.mean = x;
            return;
        }
        let n = before + 1.0;
        let delta = x - self.mean;
        let delta_n = delta / n;
        let delta_n2 = delta_n * delta_n;
        let term = delta * delta_n * before;
        self.mean += delta_n;
        self.m4 +=
            term * delta_n2 * (n * n - 3.0 * n + 3.0) + 6.0 * delta_n2 * self.m2 - 4.0 * delta_n * self.m3;
        self.m3 += term * delta_n * (n - 2.0) - 3.0 * delta_n * self.m2;
        self.m2 += term;
    }

    /// The moments of a block of values: two passes, the second around the mean that the first found.
    ///
    /// Deterministic, but not bit-identical to pushing the values one by one.
    #[must_use]
    pub fn from_slice(values: &[f64]) -> Self {
        let Some(&origin) = values.first() else { return Self::new() };
        // Sums relative to the first value: a constant block has differences of exactly zero.
        let (mut sums, mut low, mut high) = ([0.0; LANES], [origin; LANES], [origin; LANES]);
        for_each_in_lanes(values, |lane, x| {
            sums[lane] += x - origin;
            low[lane] = if x < low[lane] { x } else { low[lane] };
            high[lane] = if x > high[lane] { x } else { high[lane] };
        });
        let n = values.len() as f64;
        let centre = origin + sums.iter().sum::<f64>() / n;
        debug_assert!(centre.is_finite(), "samples must be finite, their mean is {centre}");
        let (mut s1, mut s2, mut s3, mut s4) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for_each_in_lanes(values, |lane, x| {
            let d = x - centre;
            let d2 = d * d;
            s1[lane] += d;
            s2[lane] += d2;
            s3[lane] += d2 * d;
            s4[lane] += d2 * d2;
        });
        // `centre` is off the mean by a rounding error, shift = s1/n. Moving the origin there corrects it to first
        // order in the higher sums, whose remaining error is of the order of shift^2.
        let [s1, s2, s3, s4] = [s1, s2, s3, s4].map(|lanes| lanes.iter().sum::<f64>());
        let shift = s1 / n;
        Self {
            count: values.len() as u64,
            mean: centre + shift,
            m2: s2 - shift * s1,
            m3: s3 - 3.0 * shift * s2,
            m4: s4 - 4.0 * shift * s3,
            minimum: low.into_iter().fold(origin, f64::min),
            maximum: high.into_iter().fold(origin, f64::max),
        }
    }

    /// The moments of the same values in another unit: each multiplied by `factor` > 0.
    ///
    /// The factor enters one power at a time, so that a moment under- or overflows only where the scaled one does.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let times = |moment: f64, power: u32| (0..power).fold(moment, |moment, _| moment * factor);
        Self {
            count: self.count,
            mean: times(self.mean, 1),
            m2: times(self.m2, 2),
            m3: times(self.m3, 3),
            m4: times(self.m4, 4),
            minimum: times(self.minimum, 1),
            maximum: times(self.maximum, 1),
        }
    }

    /// Adds all values behind `other`, as if they had been pushed after those of `self`.
    ///
    /// The result depends on the order of merges in its last bits, on nothing else. Merging with the moments of no
    /// values, on either side, is the identity bit for bit.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *other;
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let n = a + b;
        let delta = other.mean - self.mean;
        let (wa, wb) = (a / n, b / n);
        let d2 = delta * delta;
        let m2 = self.m2 + other.m2 + d2 * a * wb;
        let m3 = self.m3
            + other.m3
            + d2 * delta * a * wb * (wa - wb)
            + 3.0 * delta * (wa * other.m2 - wb * self.m2);
        let m4 = self.m4
            + other.m4
            + d2 * d2 * a * wb * (wa * wa - wa * wb + wb * wb)
            + 6.0 * d2 * (wa * wa * other.m2 + wb * wb * self.m2)
            + 4.0 * delta * (wa * other.m3 - wb * self.m3);
        self.count += other.count;
        self.mean += delta * wb;
        (self.m2, self.m3, self.m4) = (m2, m3, m4);
        self.minimum = self.minimum.min(other.minimum);
        self.maximum = self.maximum.max(other.maximum);
    }

    /// The moments of these values and of `count` zeros: of scores that most samples miss.
    #[must_use]
    pub fn with_zeros(&self, count: u64) -> Self {
        let mut all = *self;
        if count > 0 {
            all.merge(&Self { count, minimum: 0.0, maximum: 0.0, ..Self::new() });
        }
        all
    }

    /// Number of values, N.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// Mean of the values; `None` if there are none.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// M2/N, the variance of the values as a population; `None` if there are none.
    #[must_use]
    pub fn population_variance(&self) -> Option<f64> {
        (self.count > 0).then(|| self.m2 / self.count as f64)
    }

    /// M2/(N-1), the unbiased estimate of the variance of the law behind the values; `None` below two values.
    #[must_use]
    pub fn sample_variance(&self) -> Option<f64> {
        (self.count > 1).then(|| self.m2 / (self.count - 1) as f64)
    }

    /// Estimated variance of the mean, sample_variance/N; `None` below two values.
    #[must_use]
    pub fn variance_of_mean(&self) -> Option<f64> {
        self.sample_variance().map(|variance| variance / self.count as f64)
    }

    /// Estimated standard error of the mean, sqrt(variance_of_mean); `None` below two values.
    #[must_use]
    pub fn standard_error(&self) -> Option<f64> {
        self.variance_of_mean().map(f64::sqrt)
    }

    /// Estimated standard error of the sample variance s^2; `None` below two values.
    ///
    /// Var(s^2) = (mu4 - mu2^2 (N-3)/(N-1)) / N, with mu4 = M4/N and mu2 = M2/N put in. Never negative: mu4 >= mu2^2.
    #[must_use]
    pub fn variance_standard_error(&self) -> Option<f64> {
        let n = self.count as f64;
        let (mu2, mu4) = (self.m2 / n, self.m4 / n);
        (self.count > 1).then(|| ((mu4 - mu2 * mu2 * (n - 3.0) / (n - 1.0)) / n).max(0.0).sqrt())
    }

    /// sqrt(N) M3 / M2^(3/2), the skewness of the values; `None` for none, for equal values, or out of f64's range.
    #[must_use]
    pub fn skewness(&self) -> Option<f64> {
        self.shape_exists().then(|| self.m3 / self.m2 * (self.count as f64 / self.m2).sqrt())
    }

    /// N M4 / M2^2 - 3, the excess kurtosis of the values; `None` as for the skewness.
    #[must_use]
    pub fn excess_kurtosis(&self) -> Option<f64> {
        self.shape_exists().then(|| self.count as f64 * (self.m4 / self.m2) / self.m2 - 3.0)
    }

    /// Sums of (x - c)^k over the values, k = 2, 3, 4; `None` if there are none.
    #[must_use]
    pub fn sums_about(&self, c: f64) -> Option<[f64; 3]> {
        let (n, d) = (self.count as f64, self.mean - c);
        (self.count > 0).then_some([
            self.m2 + n * d * d,
            self.m3 + d * (3.0 * self.m2 + n * d * d),
            self.m4 + d * (4.0 * self.m3 + d * (6.0 * self.m2 + n * d * d)),
        ])
    }

    /// Least value; `None` if there are none.
    #[must_use]
    pub fn minimum(&self) -> Option<f64> {
        (self.count > 0).then_some(self.minimum)
    }

    /// Greatest value; `None` if there are none.
    #[must_use]
    pub fn maximum(&self) -> Option<f64> {
        (self.count > 0).then_some(self.maximum)
    }

    /// True if M4 and M2 can be trusted: N M4 >= M2^2 by Cauchy-Schwarz, unless the fourth powers underflowed.
    fn shape_exists(&self) -> bool {
        const ROUNDING: f64 = 1e-6;
        self.m2 > 0.0 && self.count as f64 * (self.m4 / self.m2) >= self.m2 * (1.0 - ROUNDING)
    }
}

/// Calls the function with every value and its lane, in whole rows, so that the compiler can take a row at once.
#[inline]
fn for_each_in_lanes(values: &[f64], mut function: impl FnMut(usize, f64)) {
    let rows = values.chunks_exact(LANES);
    let rest = rows.remainder();
    for row in rows {
        for (lane, &x) in row.iter().enumerate() {
            function(lane, x);
        }
    }
    for (lane, &x) in rest.iter().enumerate() {
        function(lane, x);
    }
}

impl Default for Moments {
    fn default() -> Self {
        Self::new()
    }
}

impl FromIterator<f64> for Moments {
    /// Pushes the values in order.
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::new();
        for x in values {
            moments.push(x);
        }
        moments
    }
}

#[cfg(test)]
#[path = "moments_tests.rs"]
mod tests;
