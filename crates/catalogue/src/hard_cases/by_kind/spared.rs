//! Kinds that a row does not concern, with the reasons.

use super::integrators::is_integrator;
use super::{flights, spectral};
use crate::estimators::{self, is_estimator};

/// Rows of the list of hard cases: number and difficulty.
pub const ROWS: [(u32, &str); 22] = [
    (1, "nothing on a very long ray, with rates of 0"),
    (2, "nothing on the ray, but a dense region in the same bounds"),
    (3, "a sampling extinction or a majorant below the extinction"),
    (4, "extinction of both signs"),
    (5, "negative extinction"),
    (6, "a wavelength that nothing attenuates"),
    (7, "a null probability that rounding leaves"),
    (8, "optical thicknesses from 1e-12 to 1e6"),
    (9, "a spike of 1e6 on 1e-6 of the ray"),
    (10, "faces, edges and corners of voxels; negative zeros"),
    (11, "a feature of 1e-3 at 1e6"),
    (12, "segments of length 0, grazing rays, origins on the bounds and beyond"),
    (13, "ratios at the ends of a domain, albedos of 0 and 1"),
    (14, "variates at both ends of their lattice"),
    (15, "a medium that breaks its promises"),
    (16, "anisotropies next to 0 and to 1"),
    (17, "distances within a region of any thickness"),
    (18, "a light next to the point that it lights"),
    (19, "densities of several techniques that under- or overflow"),
    (20, "a million collisions in one walk"),
    (21, "variances that no sample shows"),
    (22, "one distance for two wavelengths"),
];

/// The samplers of free flights by the names of their types: no experiment names them, so that no registry does.
pub const SAMPLERS: [&str; 11] = [
    "inversion_flight",
    "newton_flight",
    "regular_flight",
    "woodcock_flight",
    "jittered_flight",
    "tracking_flight",
    "decomposition_tracking",
    "spectral_tracking",
    "hero_wavelength",
    "separate_solve",
    "shared_distance",
];

/// Kinds of one sort.
enum Kinds {
    /// Kinds that draw along a line: estimators of transmittance and samplers of free flights.
    OfLines,
    /// Kinds of one wavelength.
    Gray,
    /// Estimators of transmittance but this one.
    EstimatorsBut(&'static str),
    /// Kinds for a whole scene.
    Integrators,
    /// Kinds with these names.
    These(&'static [&'static str]),
}

/// Rows that kinds are spared, with the reason.
struct Reason {
    rows: &'static [u32],
    kinds: Kinds,
    why: &'static str,
}

/// Integrators that connect no vertices of two paths.
const UNCONNECTED: [&str; 6] = [
    "transmittance",
    "particle_tracer",
    "line_splitting",
    "single_scattering",
    "path_tracer",
    "beam_radiance",
];

const REASONS: [Reason; 21] = [
    Reason {
        rows: &[3, 13, 21],
        kinds: Kinds::Integrators,
        why: "walks below the extinction have laws of their own: furnaces, slabs and the growth of their energy",
    },
    Reason {
        rows: &[4, 5],
        kinds: Kinds::Integrators,
        why: "what a walk makes of a negative ratio is paths/growth; along a line it is its estimator",
    },
    Reason { rows: &[6, 22], kinds: Kinds::Integrators, why: "the extinction of a scene is gray" },
    Reason {
        rows: &[7, 9, 10, 11, 20],
        kinds: Kinds::Integrators,
        why: "what varies along a line is met by its estimators and by the collisions of single_particle",
    },
    Reason {
        rows: &[17, 18, 19],
        kinds: Kinds::These(&["metropolis", "energy_redistribution"]),
        why: "its paths are those of the integrator whose variates it moves, which meets the row itself",
    },
    Reason {
        rows: &[15],
        kinds: Kinds::Integrators,
        why: "whoever renders watches the medium, not the integrator: tests of the program",
    },
    Reason {
        rows: &[17],
        kinds: Kinds::These(&["bidirectional"]),
        why: "its distances are those of walks, which do not end before the medium does",
    },
    Reason { rows: &[17, 18], kinds: Kinds::These(&UNCONNECTED), why: "it has no virtual lights" },
    Reason {
        rows: &[19],
        kinds: Kinds::These(&["vpl"]),
        why: "its light paths have no densities but that of their start",
    },
    Reason {
        rows: &[19],
        kinds: Kinds::These(&UNCONNECTED),
        why: "its techniques are weighed vertex by vertex: no densities are multiplied along a path",
    },
    Reason { rows: &[6, 22], kinds: Kinds::Gray, why: "it has one wavelength" },
    Reason {
        rows: &[6],
        kinds: Kinds::These(&["shared_distance"]),
        why: "its second moment depends on the other wavelengths: row 22",
    },
    Reason {
        rows: &[22],
        kinds: Kinds::These(&["separate_solve"]),
        why: "it draws a distance for each wavelength",
    },
    Reason {
        rows: &[16, 17, 18, 19],
        kinds: Kinds::OfLines,
        why: "it draws along one line, and connects nothing",
    },
    Reason {
        rows: &[13],
        kinds: Kinds::EstimatorsBut("single_particle"),
        why: "no albedo enters its weights",
    },
    Reason {
        rows: &[13],
        kinds: Kinds::These(&SAMPLERS),
        why: "the albedo is that of what follows the collision",
    },
    Reason {
        rows: &[11],
        kinds: Kinds::These(&["jittered_flight"]),
        why: "one majorant for all of the ray would ask for 1e9 look-ups: a case for rates and bounds in cells",
    },
    Reason {
        rows: &[9, 20],
        kinds: Kinds::These(&["jittered_flight"]),
        why: "its law is one of each stratum of one majorant, of which there would be a million",
    },
    Reason {
        rows: &[4, 5],
        kinds: Kinds::These(&["inversion_flight", "newton_flight"]),
        why: "a thickness that falls has no inverse, and where there is none nothing is looked up that could be refused",
    },
    Reason {
        rows: &[10],
        kinds: Kinds::These(&["inversion_flight"]),
        why: "voxels have no inverse in closed form",
    },
    Reason {
        rows: &[15],
        kinds: Kinds::These(&["inversion_flight", "newton_flight"]),
        why: "it looks nothing up but a closed form",
    },
];

/// The reason why `row` does not concern `kind`; `None` where it does.
#[must_use]
pub fn spared(kind: &str, row: u32) -> Option<&'static str> {
    let is_gray = || is_estimator(kind) || flights::subjects().iter().any(|subject| subject.kind == kind);
    let concerns = |reason: &&Reason| {
        reason.rows.contains(&row)
            && match reason.kinds {
                Kinds::OfLines => {
                    is_gray() || spectral::subjects().iter().any(|subject| subject.kind == kind)
                }
                Kinds::Gray => is_gray(),
                Kinds::EstimatorsBut(other) => kind != other && is_estimator(kind),
                Kinds::Integrators => is_integrator(kind),
                Kinds::These(kinds) => kinds.contains(&kind),
            }
    };
    estimators::spared(kind, row).or_else(|| REASONS.iter().find(concerns).map(|reason| reason.why))
}
