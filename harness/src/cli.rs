//! The command line.

use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Measures, verifies and reports unbiased estimators of volumetric light transport.
///
/// Without a subcommand it writes the standard report to reports/standard.
#[derive(Debug, Parser)]
#[command(name = "harness", version, max_term_width = 100)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a report: variance and efficiency against sigma_samp, speed against error, claims, hard cases
    Report(ReportArguments),
    /// Measure one experiment, or a sweep of them, given as JSON; the result goes to standard output
    Estimate(EstimateArguments),
    /// Check all laws over all estimators, media and hard cases; exit code 1 if one fails
    Verify(VerifyArguments),
    /// List reports, profiles, media, estimators and controls
    List,
}

/// Arguments of `report`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ReportArguments {
    /// Which report
    #[arg(default_value = "standard")]
    pub name: String,
    /// The same report in under ten seconds, with wider intervals
    #[arg(long)]
    pub quick: bool,
    /// An OpenVDB fog volume to be reported on as well
    #[arg(long, value_name = "FILE")]
    pub vdb: Option<PathBuf>,
    /// The grid of that file [default: its first float grid]
    #[arg(long, value_name = "NAME", requires = "vdb")]
    pub grid: Option<String>,
    /// A factor in front of its values
    #[arg(long, value_name = "NUMBER", requires = "vdb", default_value_t = 1.0)]
    pub scale: f64,
    /// Where to write [default: reports/NAME]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
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
            grid: None,
            scale: 1.0,
            out: None,
            seed: 1,
            threads: None,
        }
    }
}

/// Arguments of `estimate`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct EstimateArguments {
    /// The experiment; - reads standard input
    #[arg(value_name = "SPEC.json")]
    pub spec: PathBuf,
    /// Instead of the spec's samples
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    pub samples: Option<u64>,
    /// Instead of the spec's seed
    #[arg(long)]
    pub seed: Option<u64>,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// Arguments of `verify`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct VerifyArguments {
    /// Only the checks of this estimator
    #[arg(long, value_name = "NAME")]
    pub estimator: Option<String>,
    /// Fewer samples: under ten seconds, with less power
    #[arg(long)]
    pub quick: bool,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}
