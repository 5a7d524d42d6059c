//! Choices of a correction, as values.

/// Pairing of compensation vertices with virtual point lights (engelhardt-2013 section 4.3, fig. 6).
///
/// With s_k(y) = connection(y, k) + w(x)·s_k(x) and s(y) = w(x)·(D(x) + s(x)) the light at y is D(y) + s(y) + Σ_k s_k(y): every strategy is a
/// way to sum this, where D is the light of emitters, x a compensation vertex and w its weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategy {
    /// 1-to-N: one compensation vertex per point, connected with all lights; it counts D(x) once (raab-2008 section 4.2).
    OneToMany,
    /// N-to-1: as many compensation vertices per point as there are lights, each connected with its own, and one more that sees emitters
    /// and counts D(x) once.
    ManyToOne,
    /// 1-to-1: each point on the eye ray has one of the M lights, which counts M times, and one compensation vertex connected with the same
    /// light, where D(x) counts once.
    OneToOne,
}

/// Law of the distance at which a compensation vertex is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// The law of a free flight, which may end beyond the bounding region and is then lost (raab-2008 section 4.2).
    FreeFlight,
    /// The law within the bounding region as if the medium were homogeneous there (engelhardt-2013 eq. 4 and 5).
    LocallyHomogeneous,
}

/// The transmittance between a point and its compensation vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransmittanceUse {
    /// Estimated without bias.
    Exact,
    /// exp(−σ̄_t · distance): biased by design where the medium is not homogeneous.
    Approximate,
}

/// Surfaces that are seen between a point and its compensation vertex (engelhardt-2013 section 4.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// Every surface.
    Full,
    /// Surfaces that come within the bounding region of the point, found once per point: what lies further away cannot matter, and nothing
    /// is lost.
    Local,
    /// No surface from points of the medium: their vertices lie in the medium only, and may lie behind a surface. Biased by design near
    /// surfaces. Points of surfaces see surfaces all the same, as in the paper's appendix.
    Ignored,
}

/// All choices of a correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompensationOptions {
    /// Pairing of vertices and lights.
    pub strategy: Strategy,
    /// Law of the distance of vertices.
    pub placement: Placement,
    /// The transmittance to them.
    pub transmittance: TransmittanceUse,
    /// The greatest number of vertices behind each other; `None`: until the recursion ends by itself. A limit is a bias by design.
    pub steps: Option<u32>,
    /// The surfaces that block the way to them.
    pub visibility: Visibility,
}

/// Choices that contradict each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OptionsError {
    /// A free flight has met the transmittance that there is.
    #[error(
        "transmittance: approximate needs placement: locally_homogeneous, a free flight knows no other transmittance"
    )]
    ApproximateFreeFlight,
}

impl CompensationOptions {
    /// raab-2008 section 4.2 as it stands.
    pub const EXACT: Self = Self {
        strategy: Strategy::OneToMany,
        placement: Placement::FreeFlight,
        transmittance: TransmittanceUse::Exact,
        steps: None,
        visibility: Visibility::Full,
    };

    /// The same choices, if they go together.
    ///
    /// # Errors
    /// If they do not.
    pub fn checked(self) -> Result<Self, OptionsError> {
        match (self.placement, self.transmittance) {
            (Placement::FreeFlight, TransmittanceUse::Approximate) => {
                Err(OptionsError::ApproximateFreeFlight)
            }
            _ => Ok(self),
        }
    }

    /// The bias by design, if there is one.
    #[must_use]
    pub fn biased_by_design(&self) -> Option<&'static str> {
        if self.steps.is_some() {
            Some("a limited number of compensation steps loses energy")
        } else if self.transmittance == TransmittanceUse::Approximate {
            Some("an approximate transmittance is that of another medium")
        } else if self.visibility == Visibility::Ignored {
            Some("ignored visibility gathers behind surfaces, and misses what they reflect")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use CompensationOptions as Options;

    #[test]
    fn an_approximate_transmittance_needs_vertices_that_it_places() {
        let approximate = Options { transmittance: TransmittanceUse::Approximate, ..Options::EXACT };
        assert_eq!(approximate.checked(), Err(OptionsError::ApproximateFreeFlight));
        let local = Options { placement: Placement::LocallyHomogeneous, ..approximate };
        assert_eq!(local.checked(), Ok(local));
        assert_eq!(Options::EXACT.checked(), Ok(Options::EXACT));
    }

    #[test]
    fn what_is_biased_by_design_says_so() {
        let unbiased = [
            Options::EXACT,
            Options { strategy: Strategy::ManyToOne, ..Options::EXACT },
            Options { strategy: Strategy::OneToOne, visibility: Visibility::Local, ..Options::EXACT },
            Options { placement: Placement::LocallyHomogeneous, ..Options::EXACT },
        ];
        assert!(unbiased.iter().all(|options| options.biased_by_design().is_none()));
        let local = unbiased[3];
        let biased = [
            (Options { steps: Some(3), ..Options::EXACT }, "steps"),
            (Options { transmittance: TransmittanceUse::Approximate, ..local }, "transmittance"),
            (Options { visibility: Visibility::Ignored, ..Options::EXACT }, "visibility"),
        ];
        for (options, word) in biased {
            assert!(options.biased_by_design().unwrap().contains(word), "{options:?}");
        }
    }
}
