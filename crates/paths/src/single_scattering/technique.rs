//! Where scattering is evaluated along the camera ray, and how techniques are combined.

/// A way to choose distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// The interaction points of the walk that estimates transmittance: intensity σ_samp.
    Attenuation,
    /// The Cauchy distribution around the light: intensity n · pdf.
    Source,
    /// The first collision in a fitted extinction: intensity n · pdf.
    Scattering,
}

/// How the weights of two techniques follow from their intensities (veach-1995).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heuristic {
    /// λ_i/Σ λ_j.
    #[default]
    Balance,
    /// λ_i²/Σ λ_j².
    Power,
}

impl Heuristic {
    /// The MIS weight of a sample that came from a technique of intensity `own`, where the other one has `other`. The two
    /// weights of a pair sum to 1.
    #[inline]
    #[must_use]
    pub fn mis_weight(self, own: f64, other: f64) -> f64 {
        match self {
            Self::Balance => own / (own + other),
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
        }
    }
}

/// What is done with a camera ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// One technique.
    One(Technique),
    /// Of all interaction points as many as there are samples are chosen in proportion to their scores without the shadow ray
    /// (sampling importance resampling, talbot-2005).
    AttenuationResampled,
    /// Two techniques with MIS weights.
    Two(Technique, Technique, Heuristic),
}

impl Sampling {
    /// Whether a technique takes part.
    #[must_use]
    pub fn uses(self, technique: Technique) -> bool {
        match self {
            Self::One(one) => one == technique,
            Self::AttenuationResampled => technique == Technique::Attenuation,
            Self::Two(first, second, _) => first == technique || second == technique,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one() {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            for (a, b) in [(1.0, 3.0), (0.0, 2.0), (1e-200, 1e-190), (1e200, 1e180)] {
                let sum = heuristic.mis_weight(a, b) + heuristic.mis_weight(b, a);
                assert!((sum - 1.0).abs() < 1e-15, "{heuristic:?} {a} {b}: {sum}");
            }
        }
        assert!((Heuristic::Power.mis_weight(1.0, 3.0) - 0.1).abs() < 1e-16);
    }
}
