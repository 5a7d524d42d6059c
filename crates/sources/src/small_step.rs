//! Small steps of one variate (kelemen-2002).

use crate::LARGEST_VARIATE;
use fairflight_elementary::log2;

/// A small step on the circle [0, 1): as often forwards as backwards, by a distance between the least and the largest one, s_1 and s_2, of
/// which every octave is as probable.
///
/// ```text
/// v = u ± s_2 2^(−k) (1 − f/2) mod 1,      k + f = U log2(s_2/s_1), k whole
/// ```
///
/// Within an octave the distance is uniform, where kelemen-2002 has its logarithm uniform, v = u ± s_2 exp(−U ln(s_2/s_1)): any symmetric step
/// will do, and this one costs no exponential.
///
/// **Law.** v is as probable from u as u from v, exactly: steps are whole numbers on the lattice k · 2^-53, added modulo 2^53, so that v is on
/// the lattice, too. A uniform u makes a uniform v.
///
/// ```
/// use fairflight_sources::SmallStep;
///
/// let step = SmallStep::default();
/// // Forwards by the largest step, and over the end of the circle.
/// assert_eq!(step.from(0.25, 0.0), 0.3125);
/// assert_eq!(step.from(0.96875, 0.0), 0.03125);
/// // Backwards by the same.
/// assert_eq!(step.from(0.3125, 0.5), 0.25);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallStep {
    least: f64,
    largest: f64,
    log2_ratio: f64,
}

/// Error of sizes that are none of small steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SmallStepError {
    /// Steps must satisfy 2^-53 ≤ least ≤ largest ≤ 1/2: no less than the lattice, and no more than half of the circle.
    NotOrdered {
        /// The least step given.
        least: f64,
        /// The largest step given.
        largest: f64,
    },
}

impl std::fmt::Display for SmallStepError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::NotOrdered { least, largest } = self;
        write!(f, "steps must satisfy 2^-53 <= least <= largest <= 1/2, found {least} and {largest}")
    }
}

impl std::error::Error for SmallStepError {}

/// 2^53: points of the lattice.
const POINTS: i64 = 1 << 53;

const HALF: i64 = POINTS / 2;

impl SmallStep {
    /// Steps between `least` and `largest` \[1\].
    ///
    /// # Errors
    /// If they are not ordered: 2^-53 ≤ least ≤ largest ≤ 1/2.
    pub fn new(least: f64, largest: f64) -> Result<Self, SmallStepError> {
        if 1.0 <= least * POINTS as f64 && least <= largest && largest <= 0.5 {
            Ok(Self { least, largest, log2_ratio: log2(largest / least) })
        } else {
            Err(SmallStepError::NotOrdered { least, largest })
        }
    }

    /// The least step \[1\].
    #[must_use]
    pub fn least(self) -> f64 {
        self.least
    }

    /// The largest step \[1\].
    #[must_use]
    pub fn largest(self) -> f64 {
        self.largest
    }

    /// The step from the variate `u`, chosen by the variate `chance`: forwards in its first half.
    #[inline]
    #[must_use]
    pub fn from(self, u: f64, chance: f64) -> f64 {
        // Whole numbers, and no branch on chance. The first digit is the direction, 0 or −1 forwards and backwards, the others the distance.
        let digits = (chance * POINTS as f64) as i64;
        let backwards = -(digits >> 52);
        let octaves = (digits & (HALF - 1)) as f64 * (1.0 / HALF as f64) * self.log2_ratio;
        let whole = octaves as i64;
        let halved = f64::from_bits(((1023 - whole) << 52) as u64);
        let by = (self.largest * halved * (1.0 - 0.5 * (octaves - whole as f64)) * POINTS as f64) as i64;
        let at = (u * POINTS as f64) as i64;
        let to = at + ((by ^ backwards) - backwards);
        (to & (POINTS - 1)) as f64 * (1.0 / POINTS as f64)
    }
}

/// Between 1/1024 and 1/16, as Kelemen has them.
impl Default for SmallStep {
    fn default() -> Self {
        Self { least: 1.0 / 1024.0, largest: 1.0 / 16.0, log2_ratio: 6.0 }
    }
}

const _: () = assert!(LARGEST_VARIATE * POINTS as f64 == (POINTS - 1) as f64);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Seeded, UniformSource};

    #[test]
    fn steps_stay_on_the_lattice_and_lead_back() {
        let step = SmallStep::default();
        let mut source = Seeded::new(3);
        for _ in 0..10_000 {
            // Few digits, so that half of the circle more is exact.
            let (u, chance) = (source.next_uniform(), (1024.0 * source.next_uniform()).floor() / 2048.0);
            let v = step.from(u, chance);
            assert!((0.0..1.0).contains(&v) && (v * POINTS as f64).fract() == 0.0);
            let distance = (v - u).rem_euclid(1.0);
            assert!((1.0 / 1025.0..=1.0 / 16.0).contains(&distance), "{distance}");
            // The same distance backwards, to the last bit.
            assert_eq!(step.from(v, chance + 0.5), u);
        }
        for end in [0.0, LARGEST_VARIATE] {
            for chance in [0.0, 0.25, 0.5, LARGEST_VARIATE] {
                assert!((0.0..1.0).contains(&step.from(end, chance)));
            }
        }
    }

    #[test]
    fn the_sizes_are_those_of_kelemen() {
        let step = SmallStep::new(1.0 / 1024.0, 1.0 / 16.0).unwrap();
        assert_eq!(step, SmallStep::default());
        assert_eq!(step.largest(), 1.0 / 16.0);
        // Half of the way between the logarithms, and half an octave further.
        assert!((step.from(0.5, 0.25) - 0.5 - 1.0 / 128.0).abs() < 1e-15);
        assert!((step.from(0.5, 0.25 + 1.0 / 24.0) - 0.5 - 0.75 / 128.0).abs() < 1e-15);
        assert!((step.from(0.5, LARGEST_VARIATE) - 0.5 + 1.0 / 1024.0).abs() < 1e-15);
        for (least, largest) in [(0.0, 0.1), (0.2, 0.1), (0.1, 0.6), (f64::NAN, 0.1)] {
            let error = SmallStep::new(least, largest).unwrap_err();
            assert!(error.to_string().contains("2^-53 <= least <= largest <= 1/2"));
        }
    }
}
