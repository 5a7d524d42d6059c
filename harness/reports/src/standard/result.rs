//! The standard report as data: all that is drawn, tabulated or said.

use super::findings::Findings;
use super::optimum::CurveOptima;
use fairflight_document::{Claim, Provenance};
use fairflight_harness::result::number;
use serde::Serialize;

/// A whole report.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    /// Origin of the numbers.
    pub(crate) provenance: Provenance,
    /// True for the quick version, with fewer samples.
    pub(crate) quick: bool,
    /// Wall-clock seconds of the whole measurement, and the threads it ran on.
    pub(crate) seconds: f64,
    /// Threads that measured.
    pub(crate) threads: usize,
    /// One part per medium: eq. 21, Perlin, and an OpenVDB volume if one was given.
    pub(crate) media: Vec<MediumReport>,
    /// Equal look-up images of each medium.
    pub(crate) images: Vec<ImageStudy>,
    /// The ledger of the papers' claims.
    pub(crate) claims: Vec<Claim>,
    /// The hard cases.
    pub(crate) stability: Vec<StabilityRow>,
    /// Expectations of unbiased estimators that are not met, one sentence each.
    pub(crate) unsound: Vec<String>,
}

/// All curves of one ray through one medium.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct MediumReport {
    /// Short name for files: `eq21`, `perlin`, `vdb`.
    pub(crate) id: String,
    /// Name for people.
    pub(crate) title: String,
    /// The medium in words, with its source.
    pub(crate) description: String,
    /// The ray that is studied.
    pub(crate) ray: RayFacts,
    /// Variance, look-ups and efficiency against the sampling extinction: one curve per series.
    pub(crate) sweeps: Vec<SweepCurve>,
    /// Error against cost: one curve per series.
    pub(crate) convergence: Vec<ConvergenceCurve>,
    /// Extinction, control, explorers, interaction points, transmittance along the ray.
    pub(crate) anatomy: Anatomy,
    /// Sample transmittance functions with their band.
    pub(crate) functions: SampleFunctions,
    /// The best sampling extinction of each curve of `sweeps`.
    pub(crate) optima: Vec<CurveOptima>,
    /// All estimators with usual parameters.
    pub(crate) estimators: Vec<EstimatorRow>,
    /// Those that are not defined on this ray.
    pub(crate) refused: Vec<Refusal>,
    /// Answers, made of the numbers above.
    pub(crate) findings: Findings,
}

/// Facts of the studied ray.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RayFacts {
    /// Its entry into the medium.
    pub(crate) entry: [f64; 3],
    /// Its direction.
    pub(crate) direction: [f64; 3],
    /// Length inside the medium \[length\].
    pub(crate) length: f64,
    /// ∫ σ_t ds \[1\].
    pub(crate) optical_thickness: f64,
    /// Its absolute error.
    pub(crate) optical_thickness_error: f64,
    /// exp(−∫ σ_t ds) \[1\].
    pub(crate) transmittance: f64,
    /// Greatest σ_t on the ray \[1/length\].
    pub(crate) maximum: f64,
    /// Mean σ_t on the ray \[1/length\].
    pub(crate) mean: f64,
}

/// An estimator with all parameters but those that its curve runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Series {
    /// Woodcock tracking, majorant = σ_samp.
    Woodcock,
    /// Double particle, no control: ratio tracking and its extension below the extinction.
    DoubleParticle,
    /// Double particle with the ray's mean as control: an oracle, since the mean times the length is the answer.
    DoubleParticleMean,
    /// Double particle with a piecewise linear control through explorer points.
    DoubleParticleExplorers,
    /// Single particle, terminating.
    Terminating,
    /// Single particle, non-terminating.
    NonTerminating,
    /// Single particle, adaptive.
    Adaptive,
    /// raab-2008 algorithm 2, majorant = σ_samp.
    LineIntegral,
    /// Ray marching in the middle of its steps: biased.
    RayMarching,
    /// Ray marching with one random offset: biased.
    JitteredRayMarching,
    /// Another entrant of the comparison of all estimators, by its name.
    #[serde(untagged)]
    Entrant(&'static str),
}

impl Series {
    /// The series with labels of their own: those of the same estimator in the comparison of all, where it is one.
    pub(crate) const LABELLED: [(Self, &'static str); 10] = [
        (Self::Woodcock, "track length"),
        (Self::DoubleParticle, "ratio tracking"),
        (Self::DoubleParticleMean, "mean of the ray (oracle)"),
        (Self::DoubleParticleExplorers, "explorers and residual ratio"),
        (Self::Terminating, "terminating"),
        (Self::NonTerminating, "non-terminating"),
        (Self::Adaptive, "adaptive"),
        (Self::LineIntegral, "line integral"),
        (Self::RayMarching, "ray marching (biased)"),
        (Self::JitteredRayMarching, "jittered marching (biased)"),
    ];

    /// The series of an entrant of the comparison.
    pub(super) fn of(entrant: &'static str) -> Self {
        let known = Self::LABELLED.into_iter().find(|(_, label)| *label == entrant);
        known.map_or(Self::Entrant(entrant), |(series, _)| series)
    }

    /// The name in legends and tables of all reports.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Entrant(name) => name,
            _ => Self::LABELLED.into_iter().find(|(series, _)| *series == self).map_or("", |known| known.1),
        }
    }

    /// True of a biased baseline of a sweep, which is shown and does not compete. Swept entrants are unbiased.
    pub(crate) fn is_baseline(self) -> bool {
        matches!(self, Self::RayMarching | Self::JitteredRayMarching)
    }

    /// True where the answer is presumed: such an estimator shows what a control could gain, and does not compete either.
    pub(crate) fn is_oracle(self) -> bool {
        self == Self::DoubleParticleMean
    }
}

/// One estimator against the sampling extinction.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SweepCurve {
    /// The estimator.
    pub(crate) series: Series,
    /// Its parameters in words: "16 explorers", "8 splits".
    pub(crate) parameters: String,
    /// The albedo, where the estimator depends on it.
    pub(crate) albedo: Option<f64>,
    /// The points, in increasing σ_samp. For ray marching σ_samp · length is the number of steps.
    pub(crate) points: Vec<SweepPoint>,
}

/// One estimator at one sampling extinction.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SweepPoint {
    /// σ_samp \[1/length\].
    pub(crate) sigma_samp: f64,
    /// True where the estimator is defined; elsewhere its curve has a gap, and all that follows is null.
    pub(crate) in_domain: bool,
    /// log10 of the closed-form relative variance Var/T² \[1\]; for a baseline log10 of (Var + bias²)/T².
    #[serde(serialize_with = "number")]
    pub(crate) log10_relative_variance: Option<f64>,
    /// Expected look-ups per estimate, explorers included.
    #[serde(serialize_with = "number")]
    pub(crate) lookups: Option<f64>,
    /// Closed-form efficiency per look-up in units of 1/T²: T² / (MSE · look-ups), as log10.
    #[serde(serialize_with = "number")]
    pub(crate) log10_efficiency_per_lookup: Option<f64>,
    /// The measurement, if there was one.
    pub(crate) measured: Option<SweepMeasurement>,
}

/// The measurement at one point of a sweep, all in units of T.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SweepMeasurement {
    /// Number of estimates.
    pub(crate) samples: u64,
    /// Mean / T.
    pub(crate) relative_mean: f64,
    /// Measured Var/T² (for a baseline MSE/T²).
    pub(crate) relative_variance: f64,
    /// 95 % interval of it, from the closed-form 4th moment (sample moment where there is none).
    pub(crate) relative_variance_interval: [f64; 2],
    /// True if this N can test the variance: a filled mark, else a hollow one.
    pub(crate) testable: bool,
    /// (mean − T)/standard error.
    #[serde(serialize_with = "number")]
    pub(crate) mean_z: Option<f64>,
    /// (variance − closed form)/standard error.
    #[serde(serialize_with = "number")]
    pub(crate) variance_z: Option<f64>,
    /// true, false, or null: not testable.
    pub(crate) sound: Option<bool>,
    /// Look-ups per estimate, explorers included.
    pub(crate) lookups: f64,
    /// CPU nanoseconds per estimate.
    pub(crate) nanoseconds: f64,
    /// T² / (MSE · CPU seconds per estimate), with the closed-form MSE, as log10; null at zero variance.
    #[serde(serialize_with = "number")]
    pub(crate) log10_efficiency_per_second: Option<f64>,
}

/// An estimator with usual parameters.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct EstimatorRow {
    /// The estimator.
    pub(crate) series: Series,
    /// The value of `kind` in its specs.
    pub(crate) kind: &'static str,
    /// Its parameters in words.
    pub(crate) parameters: String,
    /// True of a biased baseline, which does not compete.
    pub(crate) is_biased: bool,
    /// True where the answer is presumed: it does not compete either.
    pub(crate) is_oracle: bool,
    /// log10(Var/T²) \[1\] (of a baseline that of the mean squared error): the closed form where there is one, else as measured.
    #[serde(serialize_with = "number")]
    pub(crate) log10_relative_variance: Option<f64>,
    /// True for the closed form.
    pub(crate) is_closed: bool,
    /// Look-ups per estimate, explorers included.
    pub(crate) lookups: f64,
    /// T² / (MSE · look-ups), as log10; null at zero variance.
    #[serde(serialize_with = "number")]
    pub(crate) log10_efficiency_per_lookup: Option<f64>,
    /// The measurement.
    pub(crate) measured: SweepMeasurement,
}

/// An estimator that is not defined on a ray.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Refusal {
    /// The estimator.
    pub(crate) series: Series,
    /// The reason.
    pub(crate) reason: String,
}

/// Root mean squared error of the mean of n estimates against cost.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ConvergenceCurve {
    /// The estimator.
    pub(crate) series: Series,
    /// Its parameters in words.
    pub(crate) parameters: String,
    /// The points, in increasing cost.
    pub(crate) points: Vec<ConvergencePoint>,
}

/// Error at one budget.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ConvergencePoint {
    /// Estimates averaged (for ray marching: the number of steps of one estimate).
    pub(crate) estimates: u64,
    /// Independent replicas over which the RMSE was measured.
    pub(crate) replicas: u64,
    /// Look-ups of one replica.
    pub(crate) lookups: f64,
    /// CPU seconds of one replica.
    pub(crate) seconds: f64,
    /// RMSE / T.
    pub(crate) relative_rmse: f64,
    /// 95 % interval of it.
    pub(crate) interval: [f64; 2],
    /// |bias| / T of the estimator in closed form: 0 for an unbiased one, the floor of a baseline.
    pub(crate) relative_bias: f64,
    /// Closed-form RMSE / T at this cost.
    #[serde(serialize_with = "number")]
    pub(crate) predicted: Option<f64>,
}

/// One ray taken apart (szirmay-kalos-2017 fig. 5).
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Anatomy {
    /// Sampling extinction of the walk \[1/length\].
    pub(crate) sigma_samp: f64,
    /// Distances \[length\], increasing.
    pub(crate) s: Vec<f64>,
    /// σ_t there.
    pub(crate) sigma_t: Vec<f64>,
    /// σ_main there.
    pub(crate) sigma_main: Vec<f64>,
    /// T(0, s) there.
    pub(crate) transmittance: Vec<f64>,
    /// One sampled T(0, s) there.
    pub(crate) sampled: Vec<f64>,
    /// Explorer points (s, σ_t).
    pub(crate) explorers: Vec<[f64; 2]>,
    /// Interaction points (s, σ_t).
    pub(crate) interactions: Vec<[f64; 2]>,
}

/// Sample transmittance functions (fig. 8).
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SampleFunctions {
    /// Sampling extinction \[1/length\].
    pub(crate) sigma_samp: f64,
    /// Number of explorers of the control.
    pub(crate) explorers: usize,
    /// Distances \[length\], increasing.
    pub(crate) s: Vec<f64>,
    /// Exact T(0, s).
    pub(crate) transmittance: Vec<f64>,
    /// Standard deviation of T̂(0, s) by eq. 16.
    pub(crate) standard_deviation: Vec<f64>,
    /// A few sampled functions.
    pub(crate) samples: Vec<Vec<f64>>,
}

/// Equal look-up images (fig. 9 and 10).
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ImageStudy {
    /// Medium id.
    pub(crate) medium: String,
    /// Look-ups per pixel that each method may spend on average.
    pub(crate) budget: f64,
    /// Width and height in pixels.
    pub(crate) resolution: [usize; 2],
    /// Exact transmittance per pixel, row 0 on top.
    #[serde(skip)]
    pub(crate) exact: Vec<f64>,
    /// Greatest absolute error of an exact pixel.
    pub(crate) exact_error: f64,
    /// The methods.
    pub(crate) panels: Vec<ImagePanel>,
}

/// One image of a study.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ImagePanel {
    /// The method.
    pub(crate) series: Series,
    /// Its name in this study.
    pub(crate) name: &'static str,
    /// Its parameters in words.
    pub(crate) parameters: String,
    /// Estimated transmittance per pixel, row 0 on top.
    #[serde(skip)]
    pub(crate) pixels: Vec<f64>,
    /// Look-ups per pixel on average.
    pub(crate) lookups_per_pixel: f64,
    /// RMSE over the pixels that meet the medium.
    pub(crate) rmse: f64,
    /// 95 % interval of it.
    pub(crate) rmse_interval: [f64; 2],
    /// CPU seconds of the image.
    pub(crate) seconds: f64,
}

/// One line of the stability table.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct StabilityRow {
    /// Number of the hard case.
    pub(crate) number: u32,
    /// The case.
    pub(crate) case: String,
    /// The exact answer.
    pub(crate) exact: String,
    /// Ours.
    pub(crate) ours: String,
    /// True if ours is right: the exact answer, or a refusal where one is due.
    pub(crate) passes: bool,
}
