//! Balance of the power of light paths.

use fairflight_scene::Spectrum;

/// Sums over light paths. On average `emitted` is the sum of `escaped`, `unseen` and `absorbed`, and of what a medium of albedo 0 absorbs, which
/// is not scored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger<C> {
    /// Light paths.
    pub paths: u64,
    /// Power that light paths started with.
    pub emitted: C,
    /// Power that left the scene.
    pub escaped: C,
    /// Power that points and directions sent straight into smooth surfaces, behind which nobody else sees them.
    pub unseen: C,
    /// Power that virtual point lights scatter, before any of them is dropped for being far.
    pub scattered: C,
    /// Power that vertices absorbed, as far as it is scored there and not by chance: (1/ρ − 1) of that scattered.
    pub absorbed: C,
    /// Paths that were cut at the greatest number of vertices: each is a bias.
    pub truncated: u64,
}

impl<C: Spectrum> Ledger<C> {
    /// The ledger of no paths.
    #[must_use]
    pub fn empty() -> Self {
        let zero = C::ZERO;
        Self {
            paths: 0,
            emitted: zero,
            escaped: zero,
            unseen: zero,
            scattered: zero,
            absorbed: zero,
            truncated: 0,
        }
    }

    /// The ledger of these and other paths.
    #[must_use]
    pub fn and(self, other: &Self) -> Self {
        Self {
            paths: self.paths + other.paths,
            emitted: self.emitted + other.emitted,
            escaped: self.escaped + other.escaped,
            unseen: self.unseen + other.unseen,
            scattered: self.scattered + other.scattered,
            absorbed: self.absorbed + other.absorbed,
            truncated: self.truncated + other.truncated,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, dvec3};

    #[test]
    fn ledgers_are_added_field_by_field() {
        let powers = [1.0, 0.5, 0.25, 0.125, 0.0625].map(|x| x * dvec3(1.0, 2.0, 4.0));
        let [emitted, escaped, unseen, scattered, absorbed] = powers;
        let one = Ledger { paths: 3, emitted, escaped, unseen, scattered, absorbed, truncated: 2 };
        assert_eq!(one.and(&Ledger::empty()), one);
        let three = one.and(&one).and(&one);
        assert_eq!((three.paths, three.truncated), (9, 6));
        let found = [three.emitted, three.escaped, three.unseen, three.scattered, three.absorbed];
        assert_eq!(found, powers.map(|power: DVec3| 3.0 * power));
    }
}
