//! Experience with earlier rays.

use super::pilot::Pilot;

/// Rays that are remembered.
const MEMORY: usize = 16;

/// The pilots of the last sixteen rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Experience {
    pilots: [Pilot; MEMORY],
    rays: u64,
}

impl Experience {
    /// Adds a ray; a ray of length 0 teaches nothing.
    pub fn observe(&mut self, pilot: &Pilot) {
        if pilot.length > 0.0 {
            self.pilots[self.rays as usize % MEMORY] = *pilot;
            self.rays += 1;
        }
    }

    /// The number of rays looked at.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// The pilots that are remembered.
    pub(super) fn pilots(&self) -> &[Pilot] {
        &self.pilots[..MEMORY.min(self.rays as usize)]
    }

    /// The mean over what is remembered of a variance that is proportional to the length of a ray, on one of this length; `None` before
    /// the first ray.
    fn mean(&self, length: f64, of: impl Fn(&Pilot) -> f64) -> Option<f64> {
        let pilots = self.pilots();
        let sum: f64 = pilots.iter().map(|pilot| of(pilot) * length / pilot.length).sum();
        (!pilots.is_empty()).then(|| sum / pilots.len() as f64)
    }

    /// Variance of the optical thickness by a comb of the rule's size with matched ends, on a ray of this length.
    #[must_use]
    pub fn matched_variance(&self, length: f64) -> Option<f64> {
        self.mean(length, |pilot| pilot.matched[0])
    }

    /// Variance of the optical thickness by as many teeth with an offset each, on a ray of this length.
    #[must_use]
    pub fn apart_variance(&self, length: f64) -> Option<f64> {
        self.mean(length, |pilot| pilot.apart[0])
    }
}
