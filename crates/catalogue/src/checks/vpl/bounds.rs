//! Upper bounds of compensation, and limits that agree to the last bit.

use super::{Check, LAWFUL, Law, STRATEGIES};
use crate::vpl::bounds::{coincide, compensation_at_most};
use crate::vpl::local::{Local, estimate};
use crate::vpl::rooms::{Replica, Room};
use crate::vpl::scenes::{ball, cloud, diffuse, environment, homogeneous, open, rectangle, smoky};
use crate::vpl::tiny;
use fairflight_collision::Version;
use fairflight_compensation::{Compensation, CompensationOptions, LocalMean, Placement};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds, EmptySpace, Medium};
use fairflight_paths::transport::{Lobe, Vertex, World};
use fairflight_paths::{Ratio, Uniform, Walk};
use fairflight_scene::{Geometry, Surfaces};
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use fairflight_vpl::{Connected, Pairing};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

const DRAWS: u64 = 50_000;
const SETS: u64 = 500;

/// Checks of bounds.
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
        checks.push(same(&format!("b=inf is unbounded, {of}"), move |run| {
            let unbounded = CompensationOptions { steps: Some(0), ..options };
            let [ours, theirs] = [options, unbounded].map(|options| replica(options, f64::INFINITY, Regular));
            cloud().coincides_with(&cloud(), (ours, theirs), run)
        }));
    }
    for placement in [Placement::FreeFlight, Placement::LocallyHomogeneous] {
        let options = CompensationOptions { placement, ..CompensationOptions::EXACT };
        checks.push(same(&format!("no medium is a medium elsewhere, {placement:?}"), move |run| {
            let mut elsewhere = behind_a_wall(homogeneous(2.0));
            elsewhere.volume.bounds = Bounds::sphere(dvec3(0.0, 90.0, 0.0), 1.0).expect(LAWFUL);
            let ours = replica(options, 2.0, Regular);
            behind_a_wall(EmptySpace).coincides_with(&elsewhere, (ours, ours), run)
        }));
        checks.push(same(&format!("no surfaces is an empty list of them, {placement:?}"), move |run| {
            let Room { volume, lights, eye, .. } = cloud();
            let listed = Room { volume, surfaces: Surfaces::new(Vec::new()), lights, eye };
            let ours = replica(options, 2.0, Regular);
            cloud().coincides_with(&listed, (ours, ours), run)
        }));
    }
    // Whatever the lights, path tracing does not see them.
    checks.push(same("b=0 sees no light of the set", |run| {
        let [one, other] = [1.0, 3.0].map(|factor| {
            let mut scene = Local { bound: 0.0, ..tiny::above_floor() };
            scene.vpls.iter_mut().for_each(|vpl| vpl.power *= factor);
            scene
        });
        coincide(estimates(&one), estimates(&other), run)
    }));
    let id = "vpl/limit/grazing connections";
    checks.push(Check::new(id, Law::Bound, "virtual point lights", "a floor", SETS, grazing));
    checks
}

/// Floor and ball under a lamp, inside a black sphere of radius 4: no ray leaves it, whatever the variates, and what lies
/// outside is met by nobody. (A lamp, since the ball that far light covers would hold what lies outside, too.)
fn behind_a_wall<M>(medium: M) -> Room<Surfaces<f64>, M, HenyeyGreenstein> {
    let room = open(medium);
    let mut all = Geometry::<f64>::surfaces(&room.surfaces).to_vec();
    let lamp = rectangle(dvec3(-0.2, 0.5, -0.2), 0.4 * DVec3::X, 0.4 * DVec3::Z);
    all.extend([diffuse(lamp, 0.5, 1.0), diffuse(ball(DVec3::ZERO, 4.0), 0.0, 0.0)]);
    Room { surfaces: Surfaces::new(all), lights: environment(0.0), ..room }
}

/// Bounded connections and one step of compensation.
fn estimates(scene: &Local) -> impl FnMut(&mut Seeded) -> f64 {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(2.0 * tiny::SIGMA_T).expect(LAWFUL));
    let mean = LocalMean::of(&scene.volume.medium, &scene.volume.bounds, [1; 3], 1);
    let options = CompensationOptions { steps: Some(1), ..CompensationOptions::EXACT };
    move |source| {
        let mut gather = scene.gather(walk, Regular);
        let mut correction = Compensation::new(options, &mean);
        estimate(&mut gather, &mut correction, Pairing::Every, &scene.y, source)
    }
}

/// A light in the medium that rises by next to nothing above the floor on which the point lies: G counts its cosine, whatever
/// is left of it, and a light in the very plane, or on the floor itself, adds nothing.
fn grazing(run: Run) -> CheckResult {
    let mut worst = 0.0_f64;
    for height in [0.0, 5e-324, 1e-300, 1e-17, 1e-9, 1e-3] {
        let mut scene = tiny::isotropic_above_floor();
        scene.vpls.truncate(1);
        scene.vpls[0].vertex.position = dvec3(0.25, 0.0, height);
        let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).expect(LAWFUL));
        let mut source = Seeded::new(run.seed);
        let found = scene.gather(walk, Regular).connected(&scene.y, Connected::All, &mut source);
        let distance = 0.25_f64.hypot(height);
        let geometric = (height / distance.powi(3)).min(scene.bound);
        let right = geometric * (-tiny::SIGMA_T * distance).exp() / (4.0 * PI * PI);
        let off = (found - right).abs();
        // A subnormal product has no relative accuracy.
        worst = worst.max(if off <= f64::MIN_POSITIVE { 0.0 } else { off / right });
        let mut draw = estimates(&scene);
        if let Some(value) = (0..run.samples).map(|_| draw(&mut source)).find(|value| !value.is_finite()) {
            return CheckResult::exact(false, format!("{value} at the height {height}"));
        }
    }
    CheckResult {
        detectable_relative_bias: Some(1e-14),
        ..CheckResult::exact(worst <= 1e-14, format!("off by {worst:.1e} at most"))
    }
}

fn replica<T>(options: CompensationOptions, bound: f64, shadow: T) -> Replica<Uniform, T> {
    let walk = Walk::new(Version::NonTerminating, Uniform::new(3.0).expect(LAWFUL));
    Replica { paths: 6, rays: 2, eye_samples: 2, bound, options, walk, shadow }
}

fn same(name: &str, function: impl Fn(Run) -> CheckResult + Send + Sync + 'static) -> Check {
    let id = format!("vpl/limit/{name}");
    Check::new(id, Law::Bound, "virtual point lights", "furnace", SETS, function)
}

/// Check at a point of a floor and at one in eq. 21 above it: under an even sky, and in a room with a lamp.
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
        CheckResult::of_all(parts)
    })
}

fn one<G: Geometry<f64>, M: Medium>(
    room: &Room<G, M, HenyeyGreenstein>,
    y: &Vertex,
    (bound, steps): (f64, Option<u32>),
    most: f64,
    run: Run,
) -> CheckResult {
    let Room { volume, surfaces, lights, .. } = room;
    let world = World::new(volume, surfaces, lights);
    // Nowhere below eq. 21, which stays below 1 times its scale.
    let sampling = Uniform::new(3.0).expect(LAWFUL);
    let walk = Walk::new(Version::NonTerminating, sampling);
    compensation_at_most(world, (walk, Ratio(sampling)), (y, bound, steps), most, run)
}
