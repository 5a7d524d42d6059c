//! The whole recursion over random sets: furnaces, and a room of smoke against path tracing.

use super::{Check, LAWFUL, Law, STRATEGIES, result};
use crate::vpl::rooms::{Replica, Room};
use crate::vpl::scenes::{GLOW, clear, cloud, round, shiny, smoky};
use fairflight_collision::Version;
use fairflight_compensation::{CompensationOptions, Placement};
use fairflight_laws::scores::NEVER_NEGATIVE;
use fairflight_media::{LineThickness, PhaseFunction};
use fairflight_paths::{Ratio, Uniform, Walk};
use fairflight_scene::Geometry;
use fairflight_stats::Reference;
use fairflight_transmittance::Regular;

/// Sizes of a check: b, light paths of a set, points on its eye ray, and sets, as many as the tails of their images ask for.
///
/// The bounds take more than half of the light away, and leave mild tails: d = 1 and 1.4 in rooms two wide. Small sets have heavier
/// tails, but make up for that by their number.
type Size = (f64, u32, u32, u64);
const CLOUD: Size = (1.0, 3, 2, 220_000);
const ROUND: Size = (1.0, 2, 1, 1_000_000);
const CLEAR: Size = (0.5, 8, 2, 300_000);
/// Light that finds its way through the glass is rare and bright: one such path in a smaller sample leaves no test.
const SHINY: Size = (0.5, 6, 2, 330_000);
const SMOKY: Size = (1.0, 3, 2, 80_000);

/// All rooms. Each strategy meets both placements; tiny scenes have every pair on every kind of vertex.
pub(super) fn checks() -> Vec<Check> {
    let of = |strategy, placement| CompensationOptions { strategy, placement, ..CompensationOptions::EXACT };
    let (flights, homogeneous) = (Placement::FreeFlight, Placement::LocallyHomogeneous);
    let [many, to_one, pairs] = STRATEGIES.map(|(strategy, _)| strategy);
    let with = |(bound, paths, points, _): Size, sets| (bound, paths, points, sets);
    let unbounded = (0.0, CLOUD.1, CLOUD.2, CLOUD.3);
    let mut checks = vec![
        furnace("cloud/1-to-N flights", cloud, 1.0, of(many, flights), CLOUD),
        furnace("cloud/N-to-1 homogeneous", cloud, 1.0, of(to_one, homogeneous), with(CLOUD, 40_000)),
        furnace("cloud/1-to-1 flights", cloud, 1.0, of(pairs, flights), with(CLOUD, 300_000)),
        furnace("cloud/1-to-1 homogeneous", cloud, 1.0, of(pairs, homogeneous), with(CLOUD, 220_000)),
        // Path tracing by another name.
        furnace("cloud/b=0", cloud, 1.0, of(many, flights), unbounded),
        furnace("round/1-to-N homogeneous", round, GLOW, of(many, homogeneous), ROUND),
        furnace("shiny/1-to-N flights", shiny, 1.0, of(many, flights), SHINY),
    ];
    for (strategy, name) in STRATEGIES {
        let size = if strategy == pairs { with(CLEAR, 1_050_000) } else { CLEAR };
        checks.push(furnace(&format!("clear/{name}"), clear, 1.0, of(strategy, flights), size));
    }
    checks.push(against_paths("smoky/1-to-N flights", of(many, flights)));
    checks.push(against_paths("smoky/1-to-N homogeneous", of(many, homogeneous)));
    checks
}

fn replica<T>(
    options: CompensationOptions,
    (bound, paths, eye_samples, _): Size,
    rate: f64,
    shadow: T,
) -> Replica<Uniform, T> {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(rate).expect(LAWFUL));
    Replica { paths, rays: 1, eye_samples, bound, options, walk, shadow }
}

fn furnace<G: Geometry<f64> + 'static, M: LineThickness + 'static, P: PhaseFunction + 'static>(
    name: &str,
    room: impl Fn() -> Room<G, M, P> + Send + Sync + 'static,
    radiance: f64,
    options: CompensationOptions,
    size: Size,
) -> Check {
    let id = format!("vpl/furnace/{name}");
    Check::new(id, Law::Compensation, "bounded lights and compensation", "furnace", size.3, move |run| {
        let replica = replica(options, size, 2.0, Regular);
        // Rates above every extinction: no weight is negative.
        let reference = Reference { scores: NEVER_NEGATIVE, ..Reference::exact(radiance) };
        result(&room().check(replica, &reference, run), run)
    })
}

fn against_paths(name: &str, options: CompensationOptions) -> Check {
    let id = format!("vpl/paths/{name}");
    Check::new(id, Law::Compensation, "bounded lights and compensation", "smoke", SMOKY.3, move |run| {
        let shadow = Ratio(Uniform::new(3.0).expect(LAWFUL));
        result(&smoky().check_against_paths(replica(options, SMOKY, 3.0, shadow), 8, run), run)
    })
    .about(["path_tracer"])
}
