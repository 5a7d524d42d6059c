//! Steps of several sizes, chosen by where a state is seen: population Monte Carlo.

use crate::Acceptance;
use fairflight_elementary::pow;
use fairflight_sources::{SmallStep, UniformSource};

/// Small steps of several sizes K_1 … K_m, of which the pixel of a state chooses by probabilities of its own (lai-2007, antwerpen-2011 section 6.9).
///
/// **Law.** A choice by the state enters the ratio of acceptance: α_Y(k)/α_X(k) for the size k that was chosen at X. Without it bright and dark
/// pixels exchange more than they should.
///
/// **Adaptation.** Probabilities that a chain learns from its own acceptance while it runs break its stationarity. Here they are the same for a whole
/// replica, and [learnt](Self::learn) from others: of two half populations of replicas each teaches the other for its next generation, so that every replica
/// is unbiased given what it was taught, and each generation has bootstrap sets of its own. Of a population that is thinned out and
/// filled up again only the energy must be kept, which [`Redistribution`](crate::Redistribution) does.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernels {
    sizes: Vec<SmallStep>,
    columns: u32,
    /// Pixel by pixel, m each.
    shares: Vec<f64>,
}

/// Acceptance of each size in each pixel: what one half of a population tells the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Experience {
    counts: Vec<Acceptance>,
}

/// Error of kernels that are none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KernelsError {
    /// At least one size, and no more than there are names for.
    #[error("there must be between 1 and {most} sizes of steps, found {found}")]
    Sizes {
        /// Sizes given.
        found: usize,
        /// The most.
        most: usize,
    },
    /// An image of no pixels.
    #[error("an image must have pixels")]
    NoPixels,
}

impl Kernels {
    /// The greatest number of sizes.
    pub const MOST: usize = 8;

    /// The share below which no size falls that is learnt, as a part of an equal one.
    pub const FLOOR: f64 = 0.2;

    /// Sizes that are equally probable in each pixel of an image.
    ///
    /// # Errors
    /// If there are none or more than [`MOST`](Self::MOST), or no pixels.
    pub fn even(sizes: Vec<SmallStep>, [columns, rows]: [u32; 2]) -> Result<Self, KernelsError> {
        let found = sizes.len();
        if found == 0 || found > Self::MOST {
            return Err(KernelsError::Sizes { found, most: Self::MOST });
        }
        if columns == 0 || rows == 0 {
            return Err(KernelsError::NoPixels);
        }
        let shares = vec![1.0 / found as f64; columns as usize * rows as usize * found];
        Ok(Self { sizes, columns, shares })
    }

    /// Sizes that part the steps of `step` by their logarithm, equally probable in each pixel: where a part holds whole octaves, all together are that step.
    ///
    /// # Errors
    /// The errors of [`even`](Self::even).
    pub fn parting(step: SmallStep, parts: u32, resolution: [u32; 2]) -> Result<Self, KernelsError> {
        let ratio = step.largest() / step.least();
        let edge = |part: u32| match part {
            0 => step.least(),
            _ if part == parts => step.largest(),
            _ => step.least() * pow(ratio, f64::from(part) / f64::from(parts)),
        };
        let size = |part| SmallStep::new(edge(part), edge(part + 1)).unwrap_or(step);
        Self::even((0..parts.min(1 + Self::MOST as u32)).map(size).collect(), resolution)
    }

    /// The sizes.
    #[must_use]
    pub fn sizes(&self) -> &[SmallStep] {
        &self.sizes
    }

    fn start(&self, [column, row]: [u32; 2]) -> usize {
        (row as usize * self.columns as usize + column as usize) * self.sizes.len()
    }

    /// Probabilities of the sizes in a pixel (column, row).
    #[must_use]
    pub fn shares(&self, pixel: [u32; 2]) -> &[f64] {
        let start = self.start(pixel);
        &self.shares[start..start + self.sizes.len()]
    }

    /// The index of a size, chosen by the probabilities of a pixel.
    pub fn choose(&self, pixel: [u32; 2], source: &mut dyn UniformSource) -> usize {
        let mut left = source.next_uniform();
        let shares = self.shares(pixel);
        for (index, share) in shares.iter().enumerate() {
            if left < *share {
                return index;
            }
            left -= share;
        }
        // Probabilities that sum to less than 1 by rounding.
        shares.len() - 1
    }

    /// Nothing counted yet.
    #[must_use]
    pub fn experience(&self) -> Experience {
        Experience { counts: vec![Acceptance::default(); self.shares.len()] }
    }

    /// Counts a proposal of size `index` from a state in a pixel.
    pub fn count(&self, experience: &mut Experience, (pixel, index): ([u32; 2], usize), acceptance: f64) {
        let counts = &mut experience.counts[self.start(pixel) + index];
        counts.proposed += 1;
        counts.accepted += acceptance;
    }

    /// The same sizes with probabilities in proportion to acceptance · size, which is how far a step leads on average, raised to
    /// [`FLOOR`](Self::FLOOR)/m. A pixel in which a size was never tried keeps what it had.
    ///
    /// lai-2007 has the acceptance alone, by which the least size always wins: it is accepted most, and leads nowhere.
    #[must_use]
    pub fn learn(&self, experience: &Experience) -> Self {
        let m = self.sizes.len();
        let mut shares = self.shares.clone();
        for (shares, counts) in shares.chunks_exact_mut(m).zip(experience.counts.chunks_exact(m)) {
            let reach: Option<Vec<f64>> = counts
                .iter()
                .zip(&self.sizes)
                .map(|(count, size)| Some(count.mean()? * size.largest()))
                .collect();
            let Some(reach) = reach else { continue };
            let sum: f64 = reach.iter().sum();
            if sum > 0.0 {
                let floor = Self::FLOOR / m as f64;
                for (share, reach) in shares.iter_mut().zip(reach) {
                    *share = floor + (1.0 - Self::FLOOR) * reach / sum;
                }
            }
        }
        Self { shares, ..self.clone() }
    }
}

impl Experience {
    /// Adds what another replica of the same half saw.
    pub fn merge(&mut self, other: &Self) {
        for (count, other) in self.counts.iter_mut().zip(&other.counts) {
            count.merge(other);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::Scripted;

    fn sizes() -> Vec<SmallStep> {
        [0.01, 0.1].map(|largest| SmallStep::new(0.001, largest).unwrap()).to_vec()
    }

    #[test]
    fn a_pixel_chooses_by_what_was_learnt_there() {
        let even = Kernels::even(sizes(), [2, 1]).unwrap();
        assert_eq!(even.shares([1, 0]), [0.5, 0.5]);
        let (mut experience, mut other) = (even.experience(), even.experience());
        even.count(&mut experience, ([1, 0], 0), 1.0);
        even.count(&mut experience, ([1, 0], 1), 0.5);
        even.count(&mut other, ([1, 0], 1), 0.1);
        even.count(&mut other, ([0, 0], 1), 1.0);
        experience.merge(&other);
        // Means 1 and 0.3, sizes 0.01 and 0.1: 1 to 3, of the four fifths that are not floor.
        let learnt = even.learn(&experience);
        let [least, largest] = [0, 1].map(|index| learnt.shares([1, 0])[index]);
        assert!((least - 0.3).abs() < 1e-15 && (largest - 0.7).abs() < 1e-15, "{least} {largest}");
        assert_eq!(learnt.shares([0, 0]), [0.5, 0.5]);
        for (u, expected) in [(0.0, 0), (0.299, 0), (0.301, 1), (1.0 - f64::EPSILON / 2.0, 1)] {
            assert_eq!(learnt.choose([1, 0], &mut Scripted::new([u])), expected);
        }
    }

    #[test]
    fn a_step_is_parted_by_octaves() {
        let three = Kernels::parting(SmallStep::default(), 3, [1, 1]).unwrap();
        let ends: Vec<_> =
            three.sizes().iter().map(|size| [1.0 / size.least(), 1.0 / size.largest()]).collect();
        for (found, expected) in ends.iter().flatten().zip([1024.0, 256.0, 256.0, 64.0, 64.0, 16.0]) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{ends:?}");
        }
        assert_eq!(
            Kernels::parting(SmallStep::default(), 0, [1, 1]),
            Err(KernelsError::Sizes { found: 0, most: 8 })
        );
        assert!(Kernels::parting(SmallStep::default(), 99, [1, 1]).is_err());
    }

    #[test]
    fn kernels_that_are_none_are_refused() {
        assert_eq!(Kernels::even(vec![], [1, 1]), Err(KernelsError::Sizes { found: 0, most: 8 }));
        let many = vec![SmallStep::default(); 9];
        assert_eq!(Kernels::even(many, [1, 1]), Err(KernelsError::Sizes { found: 9, most: 8 }));
        assert_eq!(Kernels::even(sizes(), [3, 0]), Err(KernelsError::NoPixels));
    }
}
