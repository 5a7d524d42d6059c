//! The command line.

use crate::progress::ProgressForm;
use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Measures, verifies, renders and reports unbiased estimators of volumetric light transport.
///
/// Without a subcommand it writes the standard report to reports/standard in the working directory.
#[derive(Debug, Parser)]
#[command(name = "harness", version, max_term_width = 100)]
pub(crate) struct Cli {
    /// Neither progress nor notes: results, warnings and refusals only
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Progress on standard error
    #[arg(long, value_name = "FORM", global = true, conflicts_with = "quiet", value_enum, default_value_t)]
    pub progress: ProgressForm,
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a report: variance and efficiency against sigma_samp, speed against error, claims, hard cases
    Report(ReportArguments),
    /// Measure one experiment, or a sweep of them, given as JSON; the result goes to standard output: a table on a
    /// terminal, else JSON
    Estimate(EstimateArguments),
    /// Say which estimator of transmittance along rays to use in a medium: a table on a terminal, else JSON with the
    /// table on standard error
    Advise(AdviseArguments),
    /// Render a scene, or a sweep of them, given as JSON, into images and statistics
    Render(RenderArguments),
    /// Check all laws over all estimators, media and hard cases: a table; exit code 1 if one fails
    Verify(VerifyArguments),
    /// List reports, and all kinds of profiles, media, estimators, integrators and parts of scenes with their keys
    List,
    /// Say what an OpenVDB file holds: grids, boxes, values, mean free paths, and a scene that can be pasted
    Info(InfoArguments),
    /// Print the JSON Schema of experiments and scenes: with it editors check and complete them
    Schema(SchemaArguments),
    /// Print what completes this command line in a shell; its manual says where to put it
    Completions(CompletionsArguments),
    /// Write manual pages into a folder: harness.1, harness-estimate.1, and so on
    Man(ManArguments),
    /// Print the licences of the fonts and crates that the program contains
    Licences,
}

/// Arguments of `completions`.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct CompletionsArguments {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Arguments of `man`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ManArguments {
    /// The folder, made if there is none
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
}

/// Arguments of `info`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct InfoArguments {
    /// The file
    #[arg(value_name = "FILE.vdb")]
    pub file: PathBuf,
    /// The grids as JSON, without a scene
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `schema`.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct SchemaArguments {
    /// The kinds and their keys as Markdown tables instead
    #[arg(long)]
    pub tables: bool,
}

/// Values of an OpenVDB fog volume: their grid and their unit.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct VolumeValues {
    /// The grid of that file [default: density, or else its only float grid]
    #[arg(long, value_name = "NAME", requires = "vdb")]
    pub grid: Option<String>,
    /// A factor in front of its values
    #[arg(long, value_name = "NUMBER", requires = "vdb", default_value_t = 1.0)]
    pub scale: f64,
}

/// Arguments of `report`.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = crate::report::registry::times())]
pub(crate) struct ReportArguments {
    /// Which report
    #[arg(default_value = "standard")]
    pub name: String,
    /// The same report from fewer samples, with wider intervals
    #[arg(long)]
    pub quick: bool,
    /// An OpenVDB fog volume to be reported on as well
    #[arg(long, value_name = "FILE")]
    pub vdb: Option<PathBuf>,
    #[command(flatten)]
    pub values: VolumeValues,
    /// A page without script: static figures only, small enough to be kept in a repository
    #[arg(long)]
    pub static_figures: bool,
    /// Folder to write into [default: reports/NAME in the working directory]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Refuse a volume in which more look-ups are to be expected
    #[arg(long, value_name = "NUMBER", requires = "vdb", value_parser = positive, default_value = "1e11")]
    pub budget: f64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// What the command line gives for a report that names nothing.
impl Default for ReportArguments {
    fn default() -> Self {
        Self {
            name: "standard".to_owned(),
            quick: false,
            vdb: None,
            values: VolumeValues { grid: None, scale: 1.0 },
            static_figures: false,
            out: None,
            seed: 1,
            budget: 1e11,
            threads: None,
        }
    }
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct Limits {
    /// Refuse a run that is expected to make more look-ups
    #[arg(long, value_name = "NUMBER", value_parser = positive, default_value = "1e11")]
    pub budget: f64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// Arguments of `estimate`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct EstimateArguments {
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
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `advise`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct AdviseArguments {
    /// A medium as in an experiment; or a scene without scattering, whose camera's rays are then used; - reads
    /// standard input
    #[arg(value_name = "MEDIUM.json", required_unless_present = "vdb", conflicts_with = "vdb")]
    pub medium: Option<PathBuf>,
    /// Instead, an OpenVDB fog volume
    #[arg(long, value_name = "FILE")]
    pub vdb: Option<PathBuf>,
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
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `render`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct RenderArguments {
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
    /// Stop after the pass of one sample per pixel in which this time runs out, for each image; not for photons
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub time_limit: Option<f64>,
    /// Instead of the scene's samples per pixel
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples_per_pixel: Option<u32>,
    /// Instead of the scene's seed
    #[arg(long)]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub limits: Limits,
}

fn positive(text: &str) -> Result<f64, String> {
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
pub(crate) struct VerifyArguments {
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
