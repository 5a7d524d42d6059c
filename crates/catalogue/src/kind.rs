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
    /// The closed form itself.
    Regular,
    /// One comb with a random shift: a biased baseline.
    Naive,
    /// Ratio tracking with a guess that is raised to what it finds: a biased baseline.
    ProgressiveMajorant,
}

impl Kind {
    /// Every kind of estimator.
    pub const ALL: [Self; 18] = [
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
        Self::Regular,
        Self::Naive,
        Self::ProgressiveMajorant,
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
            Self::Regular => "regular",
            Self::Naive => "naive",
            Self::ProgressiveMajorant => "progressive_majorant",
        }
    }
}
