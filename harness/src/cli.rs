//! Arguments of the commands that measure, render, verify and tell.

use std::path::PathBuf;

/// Arguments of `info`.
#[derive(Clone, Debug, clap::Args)]
pub struct InfoArguments {
    /// The file
    #[arg(value_name = "FILE.vdb")]
    pub file: PathBuf,
    /// The grids as JSON, without a scene
    #[arg(long)]
    pub json: bool,
}

/// Values of an OpenVDB fog volume: their grid and their unit.
#[derive(Clone, Debug, clap::Args)]
pub struct VolumeValues {
    /// The grid of that file [default: density, or else its only float grid]
    #[arg(long, value_name = "NAME", requires = "vdb")]
    pub grid: Option<String>,
    /// A factor in front of its values
    #[arg(long, value_name = "NUMBER", requires = "vdb", default_value_t = 1.0)]
    pub scale: f64,
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Limits {
    /// Refuse a run that is expected to make more look-ups
    #[arg(long, value_name = "NUMBER", value_parser = positive, default_value = "1e11")]
    pub budget: f64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// Arguments of `estimate`.
#[derive(Clone, Debug, clap::Args)]
pub struct EstimateArguments {
    /// The experiment; - reads standard input
    #[arg(value_name = "SPEC.json")]
    pub spec: PathBuf,
    /// JSON on a terminal too
    #[arg(long)]
    pub json: bool,
    /// Instead of the spec's samples
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    pub samples: Option<u64>,
    /// Instead of the spec's seed
    #[arg(long)]
    pub seed: Option<u64>,
    /// Limits of the run
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `advise`.
#[derive(Clone, Debug, clap::Args)]
pub struct AdviseArguments {
    /// A medium as in an experiment; or a scene without scattering, whose camera's rays are then used; - reads
    /// standard input
    #[arg(value_name = "MEDIUM.json", required_unless_present = "vdb", conflicts_with = "vdb")]
    pub medium: Option<PathBuf>,
    /// Instead, an OpenVDB fog volume
    #[arg(long, value_name = "FILE")]
    pub vdb: Option<PathBuf>,
    /// Values of the volume
    #[command(flatten)]
    pub values: VolumeValues,
    /// JSON on a terminal too, and no table
    #[arg(long)]
    pub json: bool,
    /// An upper bound of the extinction [default: what the medium declares]
    #[arg(long, value_name = "NUMBER", value_parser = positive)]
    pub majorant: Option<f64>,
    /// Rays that probe the medium
    #[arg(long, value_name = "NUMBER", default_value_t = 60, value_parser = clap::value_parser!(u16).range(2..))]
    pub rays: u16,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Limits of the run
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `render`.
#[derive(Clone, Debug, clap::Args)]
pub struct RenderArguments {
    /// The scene; - reads standard input
    #[arg(value_name = "SCENE.json")]
    pub scene: PathBuf,
    /// File to write, by extension: .pfm and .exr linear radiance, .png tone-mapped, .json statistics; may be repeated.
    /// The images of a sweep are numbered from 0: NAME-0.png for the first value of NAME.png
    #[arg(long, value_name = "IMAGE", required = true)]
    pub out: Vec<PathBuf>,
    /// An image (.pfm or .exr) to measure the error against
    #[arg(long, value_name = "IMAGE")]
    pub reference: Option<PathBuf>,
    /// The exposure of .png files: 2^STOPS times linear radiance is shown [default: that of a small pilot image]
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: Option<f64>,
    /// Stop after the pass of one sample per pixel in which this time runs out, or with the replicas of chains that have begun by then, for each image; not for photons
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub time_limit: Option<f64>,
    /// Instead of the scene's samples per pixel
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples_per_pixel: Option<u32>,
    /// Instead of the scene's seed
    #[arg(long)]
    pub seed: Option<u64>,
    /// Limits of the run
    #[command(flatten)]
    pub limits: Limits,
}

/// Reads a number above 0.
///
/// # Errors
/// If it is none.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number above 0".to_owned()),
    }
}

fn stops(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (-100.0..=100.0).contains(&number) => Ok(number),
        _ => Err("must be a number from -100 to 100".to_owned()),
    }
}

/// Arguments of `verify`.
#[derive(Clone, Debug, clap::Args)]
pub struct VerifyArguments {
    /// Only the checks that draw from this estimator, free-flight sampler or integrator
    #[arg(long, visible_alias = "kind", value_name = "KIND")]
    pub estimator: Option<String>,
    /// Fewer samples, with less power
    #[arg(long)]
    pub quick: bool,
    /// Every check with its p-values as JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}
