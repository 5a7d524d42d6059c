//! The estimators by the names that an experiment gives them.

/// An estimator of an experiment, whatever its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 1 if a flight escapes, else 0.
    Woodcock,
    /// Tracking with the double particle model.
    DoubleParticle,
    /// Tracking with the single particle model.
    SingleParticle,
    /// raab-2008 algorithm 2.
    LineIntegral,
    /// The biased baseline.
    RayMarching,
    /// Next flight, after delta or ratio tracking, or combined with it.
    NextFlight,
    /// The power series about a pivot.
    PSeries,
    /// A single term of the power series.
    GeneralisedPoisson,
    /// Ratio tracking whose rate follows what it found last.
    AdaptiveRatio,
    /// U-statistics of combs.
    UnbiasedRayMarching,
    /// Debiasing by levels of combs.
    Telescoping,
    /// Strata with a random alternating series each.
    JitteredRatio,
    /// Residual ratio tracking between bounds in cells.
    ResidualCells,
    /// Chooses between some of them.
    Hybrid,
    /// Two combs: a biased baseline.
    Jackknife,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Woodcock,
        Self::DoubleParticle,
        Self::SingleParticle,
        Self::LineIntegral,
        Self::RayMarching,
        Self::NextFlight,
        Self::PSeries,
        Self::GeneralisedPoisson,
        Self::AdaptiveRatio,
        Self::UnbiasedRayMarching,
        Self::Telescoping,
        Self::JitteredRatio,
        Self::ResidualCells,
        Self::Hybrid,
        Self::Jackknife,
    ];

    /// The name in an experiment.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Woodcock => "woodcock",
            Self::DoubleParticle => "double_particle",
            Self::SingleParticle => "single_particle",
            Self::LineIntegral => "line_integral",
            Self::RayMarching => "ray_marching",
            Self::NextFlight => "next_flight",
            Self::PSeries => "p_series",
            Self::GeneralisedPoisson => "generalised_poisson",
            Self::AdaptiveRatio => "adaptive_ratio",
            Self::UnbiasedRayMarching => "unbiased_ray_marching",
            Self::Telescoping => "telescoping",
            Self::JitteredRatio => "jittered_ratio",
            Self::ResidualCells => "residual_cells",
            Self::Hybrid => "hybrid",
            Self::Jackknife => "jackknife",
        }
    }

    /// The kinds that a check in words is about: those named in it, the versions of the single particle model, and the
    /// double particle model where it goes by its special cases.
    #[must_use]
    pub(crate) fn named_in(words: &str) -> Vec<Self> {
        let words = words.to_lowercase().replace(['_', '-'], " ");
        if words.contains("every sampler") {
            return Self::ALL.to_vec();
        }
        let names = |kind: Self| -> &[&str] {
            match kind {
                Self::Woodcock => &["woodcock"],
                Self::DoubleParticle => &[
                    "double particle",
                    "ratio tracking",
                    "below the extinction",
                    "residual",
                    "difference",
                    "piecewise",
                    "explorers",
                    "control",
                ],
                Self::SingleParticle => &["single particle", "terminating", "adaptive"],
                Self::LineIntegral => &["line integral"],
                Self::RayMarching => &["ray marching"],
                Self::NextFlight => &["next flight", "unidirectional", "bidirectional"],
                Self::PSeries => &["p series"],
                Self::GeneralisedPoisson => &["generalised poisson"],
                Self::AdaptiveRatio => &["adaptive ratio"],
                Self::UnbiasedRayMarching => &["comb", "unbiased ray marching"],
                Self::Telescoping => &["telescoping"],
                Self::JitteredRatio => &["jittered ratio"],
                Self::ResidualCells => &["residual cells"],
                Self::Hybrid => &["hybrid"],
                Self::Jackknife => &["jackknife"],
            }
        };
        // What another name begins or ends with.
        let other = |kind: Self| match kind {
            Self::SingleParticle => words.contains("adaptive ratio"),
            Self::NextFlight => words.contains("p series"),
            Self::DoubleParticle => words.contains("jittered ratio") || words.contains("residual cells"),
            Self::RayMarching => words.contains("unbiased ray marching"),
            _ => false,
        };
        // A version of the single particle model is one also "below the extinction".
        let single = names(Self::SingleParticle).iter().any(|name| words.contains(name));
        Self::ALL
            .into_iter()
            .filter(|&kind| !other(kind))
            .filter(|&kind| !(single && kind == Self::DoubleParticle && !words.contains("double particle")))
            .filter(|&kind| names(kind).iter().any(|name| words.contains(name)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Kind;

    #[test]
    fn words_name_kinds() {
        assert_eq!(Kind::named_in("ratio_tracking"), [Kind::DoubleParticle]);
        assert_eq!(Kind::named_in("adaptive albedo 0.5 below the extinction"), [Kind::SingleParticle]);
        assert_eq!(Kind::named_in("woodcock, line integral"), [Kind::Woodcock, Kind::LineIntegral]);
        assert_eq!(Kind::named_in("adaptive ratio 0.1"), [Kind::AdaptiveRatio]);
        assert_eq!(Kind::named_in("p_series_next_flight"), [Kind::PSeries]);
        assert_eq!(Kind::named_in("comb_bernoulli_2"), [Kind::UnbiasedRayMarching]);
        assert_eq!(Kind::named_in("jittered ratio tracking"), [Kind::JitteredRatio]);
        assert_eq!(Kind::named_in("residual_cells_rate_2"), [Kind::ResidualCells]);
        assert_eq!(Kind::named_in("unidirectional"), [Kind::NextFlight]);
        assert_eq!(Kind::named_in("every sampler").len(), Kind::ALL.len());
        assert!(Kind::named_in("clipped ray").is_empty());
    }
}
