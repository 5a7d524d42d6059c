//! Elementary symmetric means: all powers of an expectation from one set of samples.

use smallvec::SmallVec;

/// Values that are kept in place; more of them allocate. Kettunen's roulette reaches order 16 once in 10^10 estimates.
pub(super) const IN_PLACE: usize = 16;

/// m_k = e_k(y_1 … y_N)/C(N, k), k = 0 … N: the mean over all k-tuples of different samples of their product.
///
/// **Law.** For independent y with the mean y̅, E\[m_k\] = y̅^k: the U-statistic of the k-th power (kettunen-2021).
///
/// **Cost.** O(N²): a value y_n changes the means of n − 1 values to m_k + (k/n) (m_{k−1} y_n − m_k), from the
/// highest k down, since of all k-tuples of n values the share k/n contains the last. The n counts from 1: public
/// code that counts from 0, or divides by the final N, is biased (+1.6 % on the seed ray with 8 teeth).
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricMeans {
    means: SmallVec<[f64; IN_PLACE]>,
}

impl Default for SymmetricMeans {
    fn default() -> Self {
        Self::new()
    }
}

impl SymmetricMeans {
    /// Those of no values: m_0 = 1.
    #[must_use]
    pub fn new() -> Self {
        Self { means: SmallVec::from_slice(&[1.0]) }
    }

    /// Adds a value.
    #[inline]
    pub fn push(&mut self, value: f64) {
        let n = self.means.len();
        self.means.push(0.0);
        let share = 1.0 / n as f64;
        for k in (1..=n).rev() {
            self.means[k] += k as f64 * share * (self.means[k - 1] * value - self.means[k]);
        }
    }

    /// Forgets all values, and keeps the room for them.
    pub fn clear(&mut self) {
        self.means.truncate(1);
    }

    /// m_0 … m_N.
    #[must_use]
    pub fn means(&self) -> &[f64] {
        &self.means
    }
}

impl Extend<f64> for SymmetricMeans {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn means_are_those_of_all_tuples() {
        let values = [0.3, -1.2, 2.5, 0.7, -0.4];
        let mut means = SymmetricMeans::new();
        means.extend(values);
        // All subsets by hand.
        let (mut sums, mut counts) = ([0.0; 6], [0.0; 6]);
        for subset in 0..32_usize {
            let chosen = (0..5).filter(|i| subset >> i & 1 == 1);
            let product: f64 = chosen.clone().map(|i| values[i]).product();
            sums[chosen.clone().count()] += product;
            counts[chosen.count()] += 1.0;
        }
        for k in 0..=5 {
            assert_relative_eq!(means.means()[k], sums[k] / counts[k], max_relative = 1e-13);
        }
        means.clear();
        assert_eq!(means, SymmetricMeans::default());
    }

    #[test]
    fn equal_values_have_their_powers_at_any_order() {
        let mut means = SymmetricMeans::new();
        means.extend([0.9; 60]);
        for (k, mean) in means.means().iter().enumerate() {
            assert_relative_eq!(*mean, 0.9_f64.powi(k as i32), max_relative = 1e-12);
        }
    }
}
