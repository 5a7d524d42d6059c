//! A furnace: without absorption, and lit by the same radiance from all sides, every ray sees that radiance.

use super::{Check, LAWFUL, radiance};
use crate::paths::check;
use fairflight_collision::Version;
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh};
use fairflight_media::{AnalyticCosine, Bounds, BoxBounds, Homogeneous, Line, Medium, PhaseFunction};
use fairflight_paths::{Grid, LineSplitting, ParticleTracer, SamplingExtinction, Uniform, Walk};
use fairflight_scene::{Background, Lights, Volume};
use fairflight_stats::{ClosedMoments, Reference};
use fairflight_transmittance::{LineIntegral, Starts};
use glam::{DVec3, dvec3};

/// Walks of a rate that is nowhere below the extinction keep an energy of 1 exactly: few of them tell. Of the others as many as make
/// their shape, which is that of the sample, 1.6 times as good as it has to be ([`super`]).
const WITHOUT_VARIANCE: u64 = 2_000;
const WEIGHTED: u64 = 550_000;

const VERSIONS: [(Version, &str); 3] = [
    (Version::Terminating, "terminating"),
    (Version::NonTerminating, "non_terminating"),
    (Version::Adaptive, "adaptive"),
];

/// All furnaces.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    // Above and at the extinction: r ≤ 1, where q_sum = 1. The only loss would be a wrong one.
    for (version, name) in VERSIONS {
        for (rate, sigma_samp) in [("above", 1.5), ("at", 1.0)] {
            let sampling = Uniform::new(sigma_samp).expect(LAWFUL);
            let walk = Walk::new(version, sampling);
            let id = format!("furnace/eq21/{name}_{rate}");
            checks.push(furnace(&id, eq21(10.0, Rayleigh), walk, WITHOUT_VARIANCE));
            let id = format!("furnace/homogeneous/{name}_{rate}");
            checks.push(furnace(&id, homogeneous(4.0, Isotropic), walk, WITHOUT_VARIANCE));
        }
        let walk = Walk::new(version, majorants(&eq21(10.0, Isotropic)));
        checks.push(furnace(
            &format!("furnace/eq21/{name}_grid"),
            eq21(10.0, forward()),
            walk,
            WITHOUT_VARIANCE,
        ));
    }
    // Below it energies grow to 2 r − 1 at a collision, and leaking must outweigh that: small media, dense ones so that energies vary
    // often and not rarely. The terminating version ends at r = 2/(1 + a) = 1.
    for (version, name) in &VERSIONS[1..] {
        let walk = Walk::new(*version, Uniform::new(0.5).expect(LAWFUL));
        checks.push(furnace(&format!("furnace/eq21/{name}_below"), dense(forward()), walk, WEIGHTED));
        let walk = Walk::new(*version, Uniform::new(0.8).expect(LAWFUL));
        let id = format!("furnace/homogeneous/{name}_below");
        checks.push(furnace(&id, homogeneous(0.25, Rayleigh), walk, WEIGHTED));
        let walk = Walk::new(*version, grid(0.75, &dense(Isotropic)));
        checks.push(furnace(&format!("furnace/eq21/{name}_grid_below"), dense(Isotropic), walk, WEIGHTED));
    }
    for (starts, name) in [(Starts::Equidistant, "equidistant"), (Starts::Independent, "independent")] {
        checks.push(splitting(&format!("furnace/eq21/splitting_{name}"), starts, 1.0, WITHOUT_VARIANCE));
        checks.push(splitting(
            &format!("furnace/eq21/splitting_{name}_below"),
            starts,
            0.5,
            3 * WEIGHTED / 4,
        ));
    }
    checks
}

fn forward() -> HenyeyGreenstein {
    HenyeyGreenstein::new(0.5).expect(LAWFUL)
}

fn eq21<P>(radius: f64, phase: P) -> Volume<AnalyticCosine, P, f64> {
    ball(AnalyticCosine::new(1.0).expect(LAWFUL), radius, phase)
}

fn homogeneous<P>(radius: f64, phase: P) -> Volume<Homogeneous, P, f64> {
    ball(Homogeneous::new(1.0).expect(LAWFUL), radius, phase)
}

fn ball<M, P>(medium: M, radius: f64, phase: P) -> Volume<M, P, f64> {
    let bounds = Bounds::sphere(dvec3(0.0, 0.0, 10.0), radius).expect(LAWFUL);
    Volume { medium, bounds, albedo: 1.0, phase }
}

/// A ball half a unit around (0, 0, 4π), where eq. 21 is dense: σ_t is 2/3 in the middle, up to 0.7, and down to 0.07.
fn dense<P>(phase: P) -> Volume<AnalyticCosine, P, f64> {
    let bounds = Bounds::sphere(dvec3(0.0, 0.0, 4.0 * std::f64::consts::PI), 0.5).expect(LAWFUL);
    Volume { bounds, ..eq21(1.0, phase) }
}

const CELLS: usize = 12;

/// 1.5 times a bound of the extinction in each of 12³ cells, at least 0.15: nowhere below it.
fn majorants(volume: &Volume<AnalyticCosine, Isotropic, f64>) -> Grid {
    let (min, max) = volume.bounds.corners();
    let cell = (max - min) / CELLS as f64;
    // A point next to a border may round into the other cell.
    let slack = DVec3::splat(1e-9);
    let bound = |x: usize, y: usize, z: usize| {
        let corner = min + cell * dvec3(x as f64, y as f64, z as f64);
        1.5 * volume.medium.bounds_in(corner - slack, corner + cell + slack).1.max(0.1)
    };
    let layers = (0..CELLS).flat_map(|z| (0..CELLS).map(move |y| (y, z)));
    let rates = layers.flat_map(|(y, z)| (0..CELLS).map(move |x| (x, y, z)));
    Grid::new(&volume.bounds, [CELLS; 3], rates.map(|(x, y, z)| bound(x, y, z)).collect()).expect(LAWFUL)
}

/// `factor` times the greatest value found in each of 12³ cells, at least 0.1.
fn grid(factor: f64, volume: &Volume<AnalyticCosine, Isotropic, f64>) -> Grid {
    Grid::fitted(&volume.medium, &volume.bounds, [CELLS; 3], (6, factor, 0.1)).expect(LAWFUL)
}

fn lights() -> Lights<f64> {
    Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() }
}

/// Lines through the middle and past it.
fn lines() -> [Line; 2] {
    let line = |beside: f64| Line { origin: dvec3(beside, 0.0, -20.0), direction: DVec3::Z };
    [line(0.0), line(0.1)]
}

fn furnace<M, P, R>(id: &str, volume: Volume<M, P, f64>, walk: Walk<R>, samples: u64) -> Check
where
    M: Medium + Clone + Send + Sync + 'static,
    P: PhaseFunction + Clone + Send + Sync + 'static,
    R: SamplingExtinction + Clone + Send + Sync + 'static,
{
    let (estimator, medium) = (format!("importons, {:?}", walk.version()), "furnace");
    radiance(id, estimator, medium, samples, move |run| {
        let lights = lights();
        let mut tracer = ParticleTracer::new(&volume, &lights, walk.clone());
        check(&mut tracer, &lines(), &reference(samples), run)
    })
    .about(["particle_tracer"])
}

/// The radiance 1; where energies do not vary, exactly.
fn reference(samples: u64) -> Reference {
    let moments = (samples == WITHOUT_VARIANCE).then(|| ClosedMoments::from_central(1.0, &[Some(0.0); 7]));
    Reference { moments, ..Reference::exact(1.0) }
}

fn splitting(id: &str, starts: Starts, sigma_samp: f64, samples: u64) -> Check {
    radiance(id, "splitting by algorithm 2", "furnace", samples, move |run| {
        let (volume, lights) = (dense(forward()), lights());
        let walk = Walk::new(Version::NonTerminating, Uniform::new(sigma_samp).expect(LAWFUL));
        let line = LineIntegral::new(4).expect(LAWFUL);
        let mut tracer = LineSplitting::new(&volume, &lights, walk, (line, starts, 1.0));
        check(&mut tracer, &lines(), &reference(samples), run)
    })
    .about(["line_splitting", "line_integral"])
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_paths::{Criticality, second_moment_growth};
    use fairflight_sources::Seeded;

    #[test]
    fn the_walks_below_the_extinction_are_subcritical() {
        fn criticality<M: Medium, P: PhaseFunction, R: SamplingExtinction>(
            volume: &Volume<M, P, f64>,
            sampling: R,
        ) -> Criticality {
            let walk = Walk::new(Version::NonTerminating, sampling);
            second_moment_growth(volume, &walk, &mut Seeded::new(1)).unwrap().criticality()
        }
        let uniform = |sigma_samp| Uniform::new(sigma_samp).unwrap();
        assert_eq!(criticality(&dense(forward()), uniform(0.5)), Criticality::Subcritical);
        assert_eq!(criticality(&homogeneous(0.25, Rayleigh), uniform(0.8)), Criticality::Subcritical);
        let dense = dense(Isotropic);
        assert_eq!(criticality(&dense, grid(0.75, &dense)), Criticality::Subcritical);
        // And a walk that is not: a furnace of 4 mean free paths at the same rate.
        assert_eq!(criticality(&homogeneous(4.0, Isotropic), uniform(0.8)), Criticality::Supercritical);
    }
}
