//! The reports that there are, by name.

use super::document::Document;
use super::run::Run;
use super::{estimators, free_flight, particle_tracing, single_scattering, virtual_lights};
use crate::Failure;

/// A report that can be asked for.
pub(crate) struct ReportKind {
    /// Its name on the command line, and of its folder.
    pub(crate) name: &'static str,
    /// What it is about, for `harness list`.
    pub(crate) about: &'static str,
    /// Whether it takes a volume.
    pub(crate) takes_volume: bool,
    /// How it is measured.
    pub(crate) study: Study,
}

/// How a report is measured.
#[derive(Clone, Copy)]
pub(crate) enum Study {
    /// The standard report, which has a structure of its own and takes a volume.
    Standard,
    /// A document, measured on the threads of the current pool.
    Document(fn(&Run<'_>) -> Result<Document, Failure>),
}

/// All reports; the first is the default.
pub(crate) const REPORTS: [ReportKind; 6] = [
    ReportKind {
        name: "standard",
        about: "transmittance estimators against their closed forms",
        takes_volume: true,
        study: Study::Standard,
    },
    ReportKind {
        name: "particle-tracing",
        about: "multiple scattering over the sampling extinction: three versions, noise, growth, speed",
        takes_volume: false,
        study: Study::Document(particle_tracing::document),
    },
    ReportKind {
        name: "single-scattering",
        about: "a point light in a medium: all methods at equal look-ups, speed against error",
        takes_volume: false,
        study: Study::Document(single_scattering::document),
    },
    ReportKind {
        name: "free-flight",
        about: "distance samplers by their law, algorithm 2 from homogeneous to inhomogeneous, two wavelengths",
        takes_volume: false,
        study: Study::Document(free_flight::document),
    },
    ReportKind {
        name: "vpl",
        about: "virtual point lights: clamping, strategies of bias compensation, approximations, costs, anisotropy",
        takes_volume: false,
        study: Study::Document(virtual_lights::document),
    },
    ReportKind {
        name: "estimators",
        about: "all estimators of transmittance: the canonical plane, random rays, speed against error, which to use",
        takes_volume: true,
        study: Study::Document(estimators::document),
    },
];

/// The report of this name.
pub(crate) fn find(name: &str) -> Result<&'static ReportKind, Failure> {
    let known = REPORTS.each_ref().map(|kind| kind.name).join(", ");
    REPORTS
        .iter()
        .find(|kind| kind.name == name)
        .ok_or_else(|| Failure::refused(format!("report {name}: must be one of {known}")))
}
