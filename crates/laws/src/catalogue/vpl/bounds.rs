//! What compensation is at most, and limits that agree to the last bit.

use super::{Check, LAWFUL, Law, STRATEGIES};
use crate::vpl::bounds::compensation_at_most;
use crate::vpl::rooms::{Replica, Room};
use crate::vpl::scenes::{clear, cloud, diffuse, homogeneous, open, rectangle, smoky};
use fairflight_collision::Version;
use fairflight_compensation::{CompensationOptions, Placement};
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Medium};
use fairflight_paths::transport::{Lobe, Vertex, World};
use fairflight_paths::{Ratio, RayTransmittance, Uniform, Walk};
use fairflight_scene::{Geometry, Surfaces, Volume};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};

const DRAWS: u64 = 50_000;
const SETS: u64 = 500;

/// All.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for (steps, name) in [(Some(1), "one step"), (None, "all steps")] {
        for bound in [0.0, 2.0, 50.0] {
            let id = format!("vpl/bound/{name} b={bound}");
            checks.push(at_most(id, bound, steps));
        }
    }
    for (strategy, of) in STRATEGIES {
        let options = CompensationOptions { strategy, ..CompensationOptions::EXACT };
        // Nothing is taken away, and nothing made up for.
        checks.push(same(format!("b=inf is unbounded, {of}"), move |run| {
            let unbounded = CompensationOptions { steps: Some(0), ..options };
            let [ours, theirs] = [options, unbounded].map(|options| replica(options, f64::INFINITY, Regular));
            cloud().coincides_with(&cloud(), (ours, theirs), run)
        }));
    }
    for placement in [Placement::FreeFlight, Placement::LocallyHomogeneous] {
        let options = CompensationOptions { placement, ..CompensationOptions::EXACT };
        // Surfaces alone: three ways to have no medium.
        checks.push(same(format!("no medium is a medium elsewhere, {placement:?}"), move |run| {
            let mut elsewhere: Room<_, Homogeneous, _> = open(homogeneous(2.0));
            elsewhere.volume.bounds = Bounds::sphere(dvec3(0.0, 90.0, 0.0), 1.0).expect(LAWFUL);
            // The ball that holds everything enters the start of light paths, so that both need the same.
            let room = clear();
            elsewhere.lights = crate::vpl::scenes::environment(0.0);
            let mut lit = room.clone();
            lit.lights = crate::vpl::scenes::environment(0.0);
            for surfaces in [&mut elsewhere.surfaces, &mut lit.surfaces] {
                let mut all = Geometry::<f64>::surfaces(surfaces).to_vec();
                all.push(diffuse(
                    rectangle(dvec3(-0.2, 0.5, -0.2), 0.4 * DVec3::X, 0.4 * DVec3::Z),
                    0.5,
                    1.0,
                ));
                *surfaces = Surfaces::new(all);
            }
            let ours = replica(options, 2.0, Regular);
            lit.coincides_with(&elsewhere, (ours, ours), run)
        }));
        checks.push(same(format!("no surfaces is an empty list of them, {placement:?}"), move |run| {
            let Room { volume, lights, eye, .. } = cloud();
            let listed = Room { volume, surfaces: Surfaces::new(Vec::new()), lights, eye };
            let ours = replica(options, 2.0, Regular);
            cloud().coincides_with(&listed, (ours, ours), run)
        }));
    }
    checks
}

fn replica<T>(options: CompensationOptions, bound: f64, shadow: T) -> Replica<Uniform, T> {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(3.0).expect(LAWFUL));
    Replica { paths: 6, rays: 2, eye_samples: 2, bound, options, walk, shadow }
}

fn same(name: String, function: impl Fn(crate::Run) -> crate::CheckResult + Send + Sync + 'static) -> Check {
    let id = format!("vpl/limit/{name}");
    Check::new(id, Law::Bound, "virtual point lights", "furnace", SETS, function)
}

/// At a point of a floor and at one in eq. 21 above it: under an even sky, and in a room with a lamp.
fn at_most(id: String, bound: f64, steps: Option<u32>) -> Check {
    Check::new(id, Law::Bound, "compensation by flights", "eq21", DRAWS, move |run| {
        let (sky, smoke) = (open(AnalyticCosine::new(2.0).expect(LAWFUL)), smoky());
        let on_floor =
            Vertex { position: dvec3(0.1, -0.5, 0.2), lobe: Lobe::Diffuse { normal: DVec3::Y, surface: 0 } };
        let above = Vertex { position: dvec3(0.1, -0.4, 0.2), lobe: Lobe::Phase { incident: DVec3::NEG_Y } };
        let under_lamp = Vertex { position: dvec3(0.05, 0.8, 0.05), ..above };
        // The sky alone: at most its radiance. A lamp of 5: by either technique.
        let parts = [
            ("floor", one(&sky, &on_floor, (bound, steps), 1.0, run)),
            ("above it", one(&sky, &above, (bound, steps), 1.0, run)),
            ("smoke", one(&smoke, &under_lamp, (bound, steps), 10.0, run)),
        ];
        crate::CheckResult::of_all(parts)
    })
}

fn one<G: Geometry<f64>, M: Medium>(
    room: &Room<G, M, fairflight_media::phase::HenyeyGreenstein>,
    y: &Vertex,
    (bound, steps): (f64, Option<u32>),
    most: f64,
    run: crate::Run,
) -> crate::CheckResult
where
    Ratio<Uniform>: RayTransmittance<M>,
{
    let Room { volume, surfaces, lights, .. } = room;
    let _: &Volume<M, _, f64> = volume;
    let world = World { volume, surfaces, lights };
    // Nowhere below eq. 21, which stays below 1 times its scale.
    let sampling = Uniform::new(3.0).expect(LAWFUL);
    let walk = Walk::new(Version::NonTerminating, sampling);
    compensation_at_most(world, (walk, Ratio(sampling)), (y, bound, steps), most, run)
}
