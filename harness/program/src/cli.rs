//! The command line.

use crate::porting::{CheckPortArguments, VectorsArguments};
use clap::{Parser, Subcommand};
use fairflight_harness::cli::{
    AdviseArguments, EstimateArguments, InfoArguments, RenderArguments, VerifyArguments,
};
use fairflight_harness::progress::ProgressForm;
use fairflight_reports::ReportArguments;
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
    /// The subcommand; without one the standard report is written.
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
    /// Write test vectors for ports to other languages: what an estimator makes of given variates, with tolerances
    Vectors(VectorsArguments),
    /// Hold a port to the test vectors: which cases fail, in which layer, and what mistake it looks like
    CheckPort(CheckPortArguments),
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

/// Arguments of `schema`.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct SchemaArguments {
    /// The kinds and their keys as Markdown tables instead
    #[arg(long)]
    pub tables: bool,
}
