//! The standard report as data: everything that is plotted, tabulated or said. Writers read this and nothing else.

use crate::result::{Provenance, number};
use serde::Serialize;

/// A whole report.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Where the numbers come from.
    pub provenance: Provenance,
    /// Whether this is the quick version, with fewer samples.
    pub quick: bool,
    /// Wall-clock seconds of the whole measurement, and the threads it ran on.
    pub seconds: f64,
    /// Threads that measured.
    pub threads: usize,
    /// One part per medium: eq. 21, Perlin, and an OpenVDB volume if one was given.
    pub media: Vec<MediumReport>,
    /// Equal look-up images of each medium.
    pub images: Vec<ImageStudy>,
    /// The ledger of the papers' claims.
    pub claims: Vec<Claim>,
    /// The hard cases.
    pub stability: Vec<StabilityRow>,
}

/// All curves of one ray through one medium.
#[derive(Clone, Debug, Serialize)]
pub struct MediumReport {
    /// Short name for files: `eq21`, `perlin`, `vdb`.
    pub id: String,
    /// Name for people.
    pub title: String,
    /// What the medium is, with its source.
    pub description: String,
    /// The ray that is studied.
    pub ray: RayFacts,
    /// Variance, look-ups and efficiency against the sampling extinction: one curve per series.
    pub sweeps: Vec<SweepCurve>,
    /// Error against cost: one curve per series.
    pub convergence: Vec<ConvergenceCurve>,
    /// Extinction, control, explorers, interaction points, transmittance along the ray.
    pub anatomy: Anatomy,
    /// Sample transmittance functions with their band.
    pub functions: SampleFunctions,
}

/// What is known of the studied ray.
#[derive(Clone, Debug, Serialize)]
pub struct RayFacts {
    /// Where it enters the medium.
    pub entry: [f64; 3],
    /// Its direction.
    pub direction: [f64; 3],
    /// Length inside the medium \[length\].
    pub length: f64,
    /// ∫ σ_t ds \[1\].
    pub optical_thickness: f64,
    /// Its absolute error.
    pub optical_thickness_error: f64,
    /// exp(−∫ σ_t ds) \[1\].
    pub transmittance: f64,
    /// Greatest σ_t on the ray \[1/length\].
    pub maximum: f64,
    /// Mean σ_t on the ray \[1/length\].
    pub mean: f64,
}

/// What a curve shows: an estimator with all parameters but the swept one. It decides colour, marker and legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Series {
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
}

impl Series {
    /// A biased baseline: it is shown, and does not compete.
    #[must_use]
    pub fn is_baseline(self) -> bool {
        matches!(self, Self::RayMarching | Self::JitteredRayMarching)
    }
}

/// One estimator against the sampling extinction.
#[derive(Clone, Debug, Serialize)]
pub struct SweepCurve {
    /// The estimator.
    pub series: Series,
    /// Its parameters in words: "16 explorers", "8 splits".
    pub parameters: String,
    /// The albedo, where the estimator depends on it.
    pub albedo: Option<f64>,
    /// The points, in increasing σ_samp. For ray marching σ_samp · length is the number of steps.
    pub points: Vec<SweepPoint>,
}

/// One estimator at one sampling extinction.
#[derive(Clone, Debug, Serialize)]
pub struct SweepPoint {
    /// σ_samp \[1/length\].
    pub sigma_samp: f64,
    /// Whether the estimator is defined here; a gap in its curve where not, and all that follows is null.
    pub in_domain: bool,
    /// log10 of the closed-form relative variance Var/T² \[1\]; for a baseline log10 of (Var + bias²)/T².
    #[serde(serialize_with = "number")]
    pub log10_relative_variance: Option<f64>,
    /// Expected look-ups per estimate, explorers included.
    #[serde(serialize_with = "number")]
    pub lookups: Option<f64>,
    /// Closed-form efficiency per look-up in units of 1/T²: T² / (MSE · look-ups), as log10.
    #[serde(serialize_with = "number")]
    pub log10_efficiency_per_lookup: Option<f64>,
    /// What was measured here, where it was.
    pub measured: Option<SweepMeasurement>,
}

/// The measurement at one point of a sweep, all in units of T.
#[derive(Clone, Debug, Serialize)]
pub struct SweepMeasurement {
    /// Number of estimates.
    pub samples: u64,
    /// Mean / T.
    pub relative_mean: f64,
    /// Measured Var/T² (for a baseline MSE/T²).
    pub relative_variance: f64,
    /// 95 % interval of it, from the closed-form 4th moment (sample moment where there is none).
    pub relative_variance_interval: [f64; 2],
    /// Whether this N can test the variance: a filled mark; a hollow one where not.
    pub testable: bool,
    /// (mean − T)/standard error.
    #[serde(serialize_with = "number")]
    pub mean_z: Option<f64>,
    /// (variance − closed form)/standard error.
    #[serde(serialize_with = "number")]
    pub variance_z: Option<f64>,
    /// true, false, or null: not testable.
    pub sound: Option<bool>,
    /// Look-ups per estimate, explorers included.
    pub lookups: f64,
    /// CPU nanoseconds per estimate.
    pub nanoseconds: f64,
    /// T² / (MSE · CPU seconds per estimate), with the closed-form MSE, as log10; null at zero variance.
    #[serde(serialize_with = "number")]
    pub log10_efficiency_per_second: Option<f64>,
}

/// Root mean squared error of the mean of n estimates against cost.
#[derive(Clone, Debug, Serialize)]
pub struct ConvergenceCurve {
    /// The estimator.
    pub series: Series,
    /// Its parameters in words.
    pub parameters: String,
    /// The points, in increasing cost.
    pub points: Vec<ConvergencePoint>,
}

/// Error at one budget.
#[derive(Clone, Debug, Serialize)]
pub struct ConvergencePoint {
    /// Estimates averaged (for ray marching: the number of steps of one estimate).
    pub estimates: u64,
    /// Independent replicas over which the RMSE was measured.
    pub replicas: u64,
    /// Look-ups of one replica.
    pub lookups: f64,
    /// CPU seconds of one replica.
    pub seconds: f64,
    /// RMSE / T.
    pub relative_rmse: f64,
    /// 95 % interval of it.
    pub interval: [f64; 2],
    /// |bias| / T of the estimator in closed form: 0 for an unbiased one, the floor of a baseline.
    pub relative_bias: f64,
    /// Closed-form RMSE / T at this cost.
    #[serde(serialize_with = "number")]
    pub predicted: Option<f64>,
}

/// One ray taken apart (szirmay-kalos-2017 fig. 5).
#[derive(Clone, Debug, Serialize)]
pub struct Anatomy {
    /// Sampling extinction of the walk \[1/length\].
    pub sigma_samp: f64,
    /// Distances \[length\], increasing.
    pub s: Vec<f64>,
    /// σ_t there.
    pub sigma_t: Vec<f64>,
    /// σ_main there.
    pub sigma_main: Vec<f64>,
    /// T(0, s) there.
    pub transmittance: Vec<f64>,
    /// One sampled T(0, s) there.
    pub sampled: Vec<f64>,
    /// Explorer points (s, σ_t).
    pub explorers: Vec<[f64; 2]>,
    /// Interaction points (s, σ_t).
    pub interactions: Vec<[f64; 2]>,
}

/// Sample transmittance functions (fig. 8).
#[derive(Clone, Debug, Serialize)]
pub struct SampleFunctions {
    /// Sampling extinction \[1/length\].
    pub sigma_samp: f64,
    /// Number of explorers of the control.
    pub explorers: usize,
    /// Distances \[length\], increasing.
    pub s: Vec<f64>,
    /// Exact T(0, s).
    pub transmittance: Vec<f64>,
    /// Standard deviation of T̂(0, s) by eq. 16.
    pub standard_deviation: Vec<f64>,
    /// A few sampled functions.
    pub samples: Vec<Vec<f64>>,
}

/// Equal look-up images (fig. 9 and 10).
#[derive(Clone, Debug, Serialize)]
pub struct ImageStudy {
    /// Medium id.
    pub medium: String,
    /// Look-ups per pixel that each method may spend on average.
    pub budget: f64,
    /// Width and height in pixels.
    pub resolution: [usize; 2],
    /// Exact transmittance per pixel, row 0 on top.
    #[serde(skip)]
    pub exact: Vec<f64>,
    /// Greatest absolute error of an exact pixel.
    pub exact_error: f64,
    /// The methods.
    pub panels: Vec<ImagePanel>,
}

/// One image of a study.
#[derive(Clone, Debug, Serialize)]
pub struct ImagePanel {
    /// The method; none for one that is not a curve elsewhere.
    pub series: Series,
    /// Its parameters in words.
    pub parameters: String,
    /// Estimated transmittance per pixel, row 0 on top.
    #[serde(skip)]
    pub pixels: Vec<f64>,
    /// Look-ups per pixel on average.
    pub lookups_per_pixel: f64,
    /// RMSE over the pixels that meet the medium.
    pub rmse: f64,
    /// 95 % interval of it.
    pub rmse_interval: [f64; 2],
    /// CPU seconds of the image.
    pub seconds: f64,
}

/// One line of the ledger.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    /// S1 …
    pub id: String,
    /// What the paper says, in our words.
    pub claim: String,
    /// Where.
    pub source: String,
    /// What we measured, with its interval.
    pub measured: String,
    /// The verdict.
    pub verdict: ClaimVerdict,
    /// Under which condition, or why not.
    pub comment: String,
}

impl Claim {
    /// A line of the ledger: its place in it and its source, what is claimed, what was measured, the verdict and its comment.
    pub(super) fn new(
        (id, source): (&str, &str),
        claim: impl Into<String>,
        measured: String,
        (verdict, comment): (ClaimVerdict, impl Into<String>),
    ) -> Self {
        let (claim, comment) = (claim.into(), comment.into());
        Self { id: id.to_owned(), claim, source: source.to_owned(), measured, verdict, comment }
    }
}

impl ClaimVerdict {
    /// The verdict of a criterion that is met or not.
    pub(super) fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }
}

/// Whether a claim held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ClaimVerdict {
    /// As printed.
    Holds,
    /// Under a condition that the comment names.
    HoldsUnder,
    /// Not.
    DoesNotHold,
    /// This N cannot tell.
    NotTestable,
}

/// One line of the stability table.
#[derive(Clone, Debug, Serialize)]
pub struct StabilityRow {
    /// Number of the hard case.
    pub number: u32,
    /// The case.
    pub case: String,
    /// The exact answer.
    pub exact: String,
    /// Ours.
    pub ours: String,
    /// Whether ours is right: the exact answer, or a refusal where one is due.
    pub passes: bool,
}
