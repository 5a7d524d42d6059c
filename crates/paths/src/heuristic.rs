//! Weights of two sampling techniques from their densities.

/// Law of the weights of two techniques, from their intensities (veach-1995).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heuristic {
    /// λ_i/Σ λ_j.
    #[default]
    Balance,
    /// λ_i²/Σ λ_j².
    Power,
    /// 1 for the greater one, 0 for the other; one half each where they are equal.
    ///
    /// antwerpen-2011 section 3.6 breaks ties by the index, which a pair without indices cannot; any rule that sums to 1 will do.
    Maximum,
}

impl Heuristic {
    /// The MIS weight of a sample that came from a technique of intensity `own` > 0, where the other one has `other` ≥ 0. The two
    /// weights of a pair sum to 1.
    #[inline]
    #[must_use]
    pub fn mis_weight(self, own: f64, other: f64) -> f64 {
        match self {
            Self::Balance => {
                let sum = own + other;
                if sum.is_finite() { own / sum } else { 1.0 / (1.0 + other / own) }
            }
            Self::Power => {
                // The ratio first: squares of densities over- and underflow.
                if own >= other {
                    let ratio = other / own;
                    1.0 / (1.0 + ratio * ratio)
                } else {
                    let ratio = own / other;
                    ratio * ratio / (1.0 + ratio * ratio)
                }
            }
            Self::Maximum => {
                if own == other {
                    0.5
                } else {
                    f64::from(u8::from(own > other))
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one() {
        for heuristic in [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum] {
            for (a, b) in
                [(1.0, 3.0), (0.0, 2.0), (1e-200, 1e-190), (1e200, 1e180), (2.0, 2.0), (1e308, 1.5e308)]
            {
                let sum = heuristic.mis_weight(a, b) + heuristic.mis_weight(b, a);
                assert!((sum - 1.0).abs() < 1e-15, "{heuristic:?} {a} {b}: {sum}");
            }
        }
        assert!((Heuristic::Power.mis_weight(1.0, 3.0) - 0.1).abs() < 1e-16);
        assert_eq!(Heuristic::Maximum.mis_weight(1.0, 3.0), 0.0);
    }
}
