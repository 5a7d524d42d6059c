//! The whole recursion over random sets: furnaces, and a room of smoke against path tracing.

use super::{Check, LAWFUL, Law, STRATEGIES, result};
use crate::vpl::rooms::{Replica, Room};
use crate::vpl::scenes::{GLOW, clear, cloud, round, shiny, smoky, square};
use fairflight_collision::Version;
use fairflight_compensation::{CompensationOptions, Placement};
use fairflight_media::{Medium, PhaseFunction};
use fairflight_paths::{Ratio, RayTransmittance, Uniform, Walk};
use fairflight_scene::Geometry;
use fairflight_stats::Reference;
use fairflight_transmittance::Regular;

/// A bound that takes about half of the light away, and leaves mild tails: d = 0.7 of rooms two wide.
const BOUND: f64 = 2.0;

/// All rooms. Each strategy meets both placements; tiny scenes have every pair on every kind of vertex.
pub(super) fn checks() -> Vec<Check> {
    let of = |strategy, placement| CompensationOptions { strategy, placement, ..CompensationOptions::EXACT };
    let (flights, homogeneous) = (Placement::FreeFlight, Placement::LocallyHomogeneous);
    let [many, to_one, pairs] = STRATEGIES.map(|(strategy, _)| strategy);
    let mut checks = vec![
        furnace("cloud/1-to-N flights", cloud, 1.0, (of(many, flights), BOUND), CLOUD),
        furnace("cloud/N-to-1 homogeneous", cloud, 1.0, (of(to_one, homogeneous), BOUND), CLOUD),
        furnace("cloud/1-to-1 flights", cloud, 1.0, (of(pairs, flights), BOUND), 2 * CLOUD),
        // Path tracing by another name.
        furnace("cloud/b=0", cloud, 1.0, (of(many, flights), 0.0), CLOUD),
        furnace("round/1-to-N homogeneous", round, GLOW, (of(many, homogeneous), BOUND), ROUND),
        furnace("round/N-to-1 flights", round, GLOW, (of(to_one, flights), BOUND), ROUND),
        furnace("round/1-to-1 homogeneous", round, GLOW, (of(pairs, homogeneous), BOUND), 2 * ROUND),
        furnace("square/1-to-1 flights", square, GLOW, (of(pairs, flights), BOUND), 3 * ROUND),
        furnace("shiny/1-to-N flights", shiny, 1.0, (of(many, flights), BOUND), SHINY),
    ];
    for (strategy, name) in STRATEGIES {
        let options = of(strategy, flights);
        checks.push(furnace(&format!("clear/{name}"), clear, 1.0, (options, BOUND), CLEAR));
    }
    checks.push(against_paths("smoky/1-to-N flights", of(many, flights)));
    checks.push(against_paths("smoky/1-to-1 homogeneous", of(pairs, homogeneous)));
    checks
}

/// Sets of light paths, as many as the tails of their images ask for.
const CLOUD: u64 = 150_000;
const ROUND: u64 = 150_000;
const SHINY: u64 = 300_000;
const CLEAR: u64 = 600_000;
const SMOKY: u64 = 60_000;

fn replica<T>((options, bound): (CompensationOptions, f64), rate: f64, shadow: T) -> Replica<Uniform, T> {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(rate).expect(LAWFUL));
    Replica { paths: 3, rays: 1, eye_samples: 2, bound, options, walk, shadow }
}

fn furnace<G, M, P>(
    name: &str,
    room: impl Fn() -> Room<G, M, P> + Send + Sync + 'static,
    radiance: f64,
    law: (CompensationOptions, f64),
    replicas: u64,
) -> Check
where
    G: Geometry<f64> + 'static,
    M: Medium + 'static,
    P: PhaseFunction + 'static,
    Regular: RayTransmittance<M>,
{
    let id = format!("vpl/furnace/{name}");
    Check::new(id, Law::Compensation, "bounded lights and compensation", "furnace", replicas, move |run| {
        let replica = replica(law, 2.0, Regular);
        result(&room().check(replica, &Reference::exact(radiance), run), run)
    })
}

fn against_paths(name: &str, options: CompensationOptions) -> Check {
    let id = format!("vpl/paths/{name}");
    Check::new(id, Law::Compensation, "bounded lights and compensation", "smoke", SMOKY, move |run| {
        let shadow = Ratio(Uniform::new(3.0).expect(LAWFUL));
        result(&smoky().check_against_paths(replica((options, BOUND), 3.0, shadow), 8, run), run)
    })
}
