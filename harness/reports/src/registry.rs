//! The reports that there are, by name.

use super::run::{Finished, Run};
use super::{
    bidirectional, estimators, free_flight, metropolis, particle_tracing, single_scattering, speed, standard,
    virtual_lights,
};
use fairflight_harness::Failure;

/// A report that can be asked for.
pub struct ReportKind {
    /// Its name on the command line, and of its folder.
    pub name: &'static str,
    /// Subject, for `harness list`.
    pub about: &'static str,
    /// True if it takes a volume.
    pub takes_volume: bool,
    /// Times on two quiet cores, full and quick, as last measured.
    pub takes: [&'static str; 2],
    /// Measures it, on the threads of the current pool.
    pub(crate) study: fn(&Run<'_>) -> Result<Finished, Failure>,
}

/// All reports; the first is the default.
pub const REPORTS: [ReportKind; 9] = [
    ReportKind {
        name: "standard",
        about: "transmittance estimators against their closed forms",
        takes_volume: true,
        takes: ["24 s", "7 s"],
        study: standard::study,
    },
    ReportKind {
        name: "particle-tracing",
        about: "multiple scattering over the sampling extinction: three versions, noise, growth, speed",
        takes_volume: false,
        takes: ["111 s", "6 s"],
        study: |run| Finished::of(particle_tracing::document(run)?),
    },
    ReportKind {
        name: "single-scattering",
        about: "a point light in a medium: all methods at equal look-ups, speed against error",
        takes_volume: false,
        takes: ["57 s", "3 s"],
        study: |run| Finished::of(single_scattering::document(run)?),
    },
    ReportKind {
        name: "free-flight",
        about: "distance samplers by their law, algorithm 2 from homogeneous to inhomogeneous, two wavelengths",
        takes_volume: false,
        takes: ["82 s", "10 s"],
        study: |run| Finished::of(free_flight::document(run)?),
    },
    ReportKind {
        name: "vpl",
        about: "virtual point lights: clamping, strategies of compensation, costs, anisotropy; the beam radiance estimate",
        takes_volume: false,
        takes: ["4.6 min", "13 s"],
        study: |run| Finished::of(virtual_lights::document(run)?),
    },
    ReportKind {
        name: "bidirectional",
        about: "paths joined from both ends: gain over path tracing and its extensions, strategies, a point light, weights",
        takes_volume: false,
        takes: ["89 s", "3 s"],
        study: |run| Finished::of(bidirectional::document(run)?),
    },
    ReportKind {
        name: "metropolis",
        about: "chains of paths: the start, rows of variates, mutations, equal time against independent samples, resolution",
        takes_volume: false,
        takes: ["5.3 min", "5 s"],
        study: |run| Finished::of(metropolis::document(run)?),
    },
    ReportKind {
        name: "estimators",
        about: "all estimators of transmittance: the canonical plane, random rays, speed against error, which to use",
        takes_volume: true,
        takes: ["3.8 min", "14 s"],
        study: |run| Finished::of(estimators::document(run)?),
    },
    ReportKind {
        name: "speed",
        about: "look-ups, walks, connections and images per second, beside the parts that they cannot do without",
        takes_volume: false,
        takes: ["20 s", "4 s"],
        study: |run| Finished::of(speed::document(run)?),
    },
];

/// The reports with their times, for `harness report --help`.
pub(crate) fn times() -> String {
    let line = |kind: &ReportKind| {
        let [full, quick] = kind.takes;
        format!("  {:<18} {full:>9} {quick:>13}   {}\n", kind.name, kind.about)
    };
    let lines: String = REPORTS.iter().map(line).collect();
    format!(
        "Reports, and how long they take on two quiet cores:\n\n  {:<18} {:>9} {:>13}\n{lines}",
        "", "full", "with --quick"
    )
}

/// The report of this name.
pub(crate) fn find(name: &str) -> Result<&'static ReportKind, Failure> {
    let known = REPORTS.each_ref().map(|kind| kind.name).join(", ");
    REPORTS
        .iter()
        .find(|kind| kind.name == name)
        .ok_or_else(|| Failure::refused(format!("report {name}: must be one of {known}")))
}
