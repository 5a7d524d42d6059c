//! The moments of one pixel.

use fairflight_scene::Spectrum;
use glam::DVec3;

/// Mean and squared deviations of the estimates of a pixel, updated one by one (Welford's recurrence).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pixel<C> {
    count: u64,
    mean: C,
    /// Σ (x − mean)² per channel.
    squared: C,
    /// The same of the mean of the channels, which is what the error of the image's mean is made of.
    squared_gray: f64,
}

impl<C: Spectrum> Pixel<C> {
    pub(super) fn new() -> Self {
        Self { count: 0, mean: C::ZERO, squared: C::ZERO, squared_gray: 0.0 }
    }

    #[inline]
    pub(super) fn push(&mut self, sample: C) {
        self.push_mean(sample, 1);
    }

    /// Adds an estimate that is a mean over so many samples, as many as all others: n Σ (x − mean)²/(K − 1) over K of them is the variance of one sample
    /// that independent ones of the same error would have.
    #[inline]
    pub(super) fn push_mean(&mut self, estimate: C, samples: u32) {
        self.count += 1;
        let before = estimate + self.mean * -1.0;
        self.mean += before * (1.0 / self.count as f64);
        let after = estimate + self.mean * -1.0;
        self.squared += before * after * f64::from(samples);
        self.squared_gray += before.mean() * after.mean();
    }

    /// Adds an independent estimate of another part of the radiance, of which one sample has this variance. It does not enter
    /// [`mean_variance_gray`](Self::mean_variance_gray): what pixels share is not for one pixel to tell.
    pub(super) fn add_independent(&mut self, mean: C, variance: C) {
        self.mean += mean;
        self.squared += variance * (self.count.max(1) - 1) as f64;
    }

    /// The mean of the estimates.
    pub(super) fn mean(&self) -> C {
        self.mean
    }

    /// The sample variance of one estimate per channel; `None` for fewer than two.
    pub(super) fn variance(&self) -> Option<C> {
        (self.count > 1).then(|| self.squared * (1.0 / (self.count - 1) as f64))
    }

    /// The variance of the mean of the channels of all estimates; `None` for fewer than two.
    pub(super) fn mean_variance_gray(&self) -> Option<f64> {
        (self.count > 1).then(|| self.squared_gray / ((self.count - 1) * self.count) as f64)
    }
}

impl Pixel<DVec3> {
    /// A pixel of three channels that were estimated independently of each other, by as many estimates.
    pub(super) fn of_channels(channels: [Pixel<f64>; 3]) -> Self {
        let squared = DVec3::from_array(channels.map(|channel| channel.squared));
        Self {
            count: channels[0].count,
            mean: DVec3::from_array(channels.map(|channel| channel.mean)),
            squared,
            // The variance of a mean of three independent numbers.
            squared_gray: squared.element_sum() / 9.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn moments_of_a_few_numbers() {
        let mut pixel = Pixel::new();
        pixel.push(dvec3(1.0, 2.0, 0.0));
        assert_eq!((pixel.mean(), pixel.variance()), (dvec3(1.0, 2.0, 0.0), None));
        pixel.push(dvec3(3.0, 2.0, 1.0));
        pixel.push(dvec3(5.0, 2.0, -1.0));
        assert_eq!(pixel.mean(), dvec3(3.0, 2.0, 0.0));
        assert!((pixel.variance().unwrap() - dvec3(4.0, 0.0, 1.0)).length() < 1e-15);
        // Of 1, 2, 2.
        assert!((pixel.mean_variance_gray().unwrap() - 1.0 / 9.0).abs() < 1e-15);
    }

    #[test]
    fn means_over_points_are_as_independent_samples_of_their_error() {
        let mut pixel = Pixel::new();
        [1.0, 3.0].into_iter().for_each(|mean| pixel.push_mean(mean, 4));
        // The mean of all varies by 2/2: one of eight samples by 8.
        assert_eq!((pixel.mean(), pixel.mean_variance_gray(), pixel.variance()), (2.0, Some(1.0), Some(8.0)));
    }
}
