//! Small scenes with every kind of light and material, seen in one pixel.

use crate::checks::paths::LAWFUL;
use crate::vpl::scenes::{ball, diffuse, rectangle, smooth};
use fairflight_bidirectional::{Bidirectional, Found, Subpath, Weigh, WeightThickness};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Medium};
use fairflight_paths::transport::{Emitters, MadeOf, World};
use fairflight_paths::{Heuristic, RayTransmittance, Uniform, Walk};
use fairflight_scene::{
    Background, Camera, EnvironmentMap, Lights, Material, Source, Surface, Surfaces, Volume,
};
use fairflight_sources::{Seeded, UniformSource};
use glam::{DVec3, dvec3};

/// A scene and how it is looked at.
#[derive(Clone, Debug)]
pub struct View<M> {
    /// The camera.
    pub camera: Camera,
    /// The medium.
    pub volume: Volume<M, HenyeyGreenstein, f64>,
    /// The surfaces.
    pub surfaces: Surfaces<f64>,
    /// The lights that are no surfaces.
    pub lights: Lights<f64>,
    /// Flights of both subpaths.
    pub walk: Walk<Uniform>,
}

/// The types of a view whose connections have the transmittance T.
pub(crate) type Viewed<M, T> = MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, T>;

impl<M: Medium> View<M> {
    /// The scene.
    pub(crate) fn world<T: RayTransmittance<M>>(&self) -> World<'_, Viewed<M, T>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }

    /// The emitters on which light paths start.
    pub(crate) fn emitters<T: RayTransmittance<M>>(&self) -> Emitters<f64> {
        let ball = self.world::<T>().enclosing_ball();
        Emitters::new(&self.lights, &self.surfaces, ball, self.camera.origin())
    }

    /// Number of pixels, which is that of light paths.
    pub(super) fn pixels(&self) -> f64 {
        self.camera.resolution().map(f64::from).iter().product()
    }

    /// Weights, of as many light paths as pixels.
    pub(crate) fn weigh<'s, T: RayTransmittance<M>, K>(
        &'s self,
        emitters: &'s Emitters<f64>,
        heuristic: Heuristic,
        thickness: K,
    ) -> Weigh<'s, Viewed<M, T>, K> {
        let light_paths = self.pixels();
        Weigh { world: self.world(), camera: &self.camera, emitters, thickness, heuristic, light_paths }
    }

    /// The same view in so many columns and rows.
    pub(crate) fn in_pixels(self, resolution: [u32; 2]) -> Self {
        Self { camera: self.camera.with_resolution(resolution).expect(LAWFUL), ..self }
    }
}

/// One sample of a pixel and the light path that goes with it: `each` sees what was found, with its path.
pub(super) fn sample<M: Medium, T: RayTransmittance<M>, K: WeightThickness<M>>(
    integrator: &mut Bidirectional<'_, Viewed<M, T>, K>,
    light: &mut Subpath<f64>,
    pixel: [u32; 2],
    source: &mut Seeded,
    mut each: impl FnMut(&Found<f64>, &Subpath<f64>, &Subpath<f64>),
) {
    integrator.trace_light(light, source);
    let within = [source.next_uniform(), source.next_uniform()];
    let line = integrator.weigh().camera.ray(pixel, within);
    integrator.strategies(&line, light, source, |eye, found| each(&found, eye, light));
    let none = Subpath::empty();
    for index in 0..light.steps.len() {
        if let Some((_, found)) = integrator.splat(light, index, source) {
            each(&found, &none, light);
        }
    }
}

/// Floor, ceiling and three walls about the origin, 2 · 2 in size, open towards the camera.
fn room(reflectance: f64) -> Vec<Surface<f64>> {
    let low = DVec3::splat(-1.0);
    let [x, y, z] = [2.0 * DVec3::X, 2.0 * DVec3::Y, 2.0 * DVec3::Z];
    [(low, x, z), (low + y, x, z), (low, y, z), (low + x, y, z), (low + z, x, y)]
        .map(|(corner, u, v)| diffuse(rectangle(corner, u, v), reflectance, 0.0))
        .to_vec()
}

fn lamp(corner: DVec3, u: DVec3, v: DVec3, reflectance: f64, emission: f64) -> Surface<f64> {
    diffuse(rectangle(corner, u, v), reflectance, emission)
}

fn glass(ior: f64) -> Material<f64> {
    Material::Dielectric { ior }
}

fn view<M>((medium, g, albedo): (M, f64, f64), surfaces: Vec<Surface<f64>>, lights: Lights<f64>) -> View<M> {
    // Up to below the point lights: a path tracer has no second moment of one in a medium.
    let bounds = Bounds::aligned_box(DVec3::splat(-1.2), dvec3(1.2, 0.3, 1.2)).expect(LAWFUL);
    let phase = HenyeyGreenstein::new(g).expect(LAWFUL);
    // In the front of the room: a wide view, whose pixels are far from equal.
    let (origin, at) = (dvec3(0.1, -0.1, -1.3), dvec3(0.0, -0.2, 0.0));
    View {
        camera: Camera::new(origin, at, DVec3::Y, 75.0, [1, 1]).expect(LAWFUL),
        volume: Volume { medium, bounds, albedo, phase },
        surfaces: Surfaces::new(surfaces),
        lights,
        walk: Walk::new(Version::NonTerminating, Uniform::new(0.5).expect(LAWFUL)),
    }
}

fn sources(sources: Vec<Source<f64>>) -> Lights<f64> {
    Lights { background: Background::dark(), sources }
}

fn point(position: DVec3, power: f64) -> Source<f64> {
    Source::point(position, power).expect(LAWFUL)
}

fn homogeneous(sigma_t: f64) -> Homogeneous {
    Homogeneous::new(sigma_t).expect(LAWFUL)
}

/// Haze, a mirror, a lamp that reflects and one that is round.
pub(crate) fn mixed() -> View<Homogeneous> {
    let mut surfaces = room(0.6);
    surfaces.push(lamp(dvec3(-0.4, 0.95, -0.4), 0.8 * DVec3::X, 0.8 * DVec3::Z, 0.3, 3.0));
    surfaces.push(smooth(ball(dvec3(0.5, -0.6, 0.3), 0.3), Material::Mirror));
    surfaces.push(diffuse(ball(dvec3(-0.5, -0.7, 0.2), 0.2), 0.5, 2.0));
    view((homogeneous(0.4), 0.3, 0.9), surfaces, sources(vec![]))
}

/// Uneven smoke that collides more often than it is looked up for, a ball of glass, a point light and a lamp.
pub(crate) fn uneven() -> View<AnalyticCosine> {
    let mut surfaces = room(0.5);
    surfaces.push(smooth(ball(dvec3(0.3, -0.5, 0.0), 0.4), glass(1.5)));
    surfaces.push(lamp(dvec3(-0.9, 0.8, -0.8), 1.4 * DVec3::X, dvec3(0.0, 0.1, 1.4), 0.0, 1.0));
    let lights = sources(vec![point(dvec3(-0.5, 0.6, -0.3), 4.0)]);
    view((AnalyticCosine::new(0.8).expect(LAWFUL), -0.2, 0.8), surfaces, lights)
}

/// Under a sky of a constant and a map, with parallel light, a point light, and haze of a few mean free paths that ends.
pub(crate) fn sky() -> View<Homogeneous> {
    let surfaces = vec![
        diffuse(rectangle(DVec3::splat(-1.0), 2.0 * DVec3::X, 2.0 * DVec3::Z), 0.7, 0.0),
        diffuse(ball(dvec3(0.3, -0.4, 0.2), 0.5), 0.4, 0.0),
        smooth(ball(dvec3(-0.6, -0.5, 0.0), 0.3), Material::Mirror),
    ];
    let map = EnvironmentMap::new(4, 2, vec![0.5, 2.0, 1.0, 0.2, 0.1, 0.0, 0.3, 0.4]).expect(LAWFUL);
    let background = Background { constant: 0.3, maps: vec![map] };
    let parallel = Source::directional(dvec3(0.3, -1.0, 0.4), 0.8).expect(LAWFUL);
    let lights = Lights { background, sources: vec![parallel, point(dvec3(0.2, 0.8, -0.5), 4.0)] };
    view((homogeneous(0.5), 0.4, 0.9), surfaces, lights)
}

/// The same without the point light, which is bright without bound nearby, in haze that absorbs half of what it meets: short paths and tails.
pub(crate) fn haze_under_a_sky() -> View<Homogeneous> {
    let mut view = sky();
    view.lights.sources.truncate(1);
    view.volume.albedo = 0.5;
    View { walk: Walk::new(Version::NonTerminating, Uniform::new(0.5).expect(LAWFUL)), ..view }
}

/// A lamp and a faint point light over a strongly forward scattering medium, looked up for more often than it collides.
pub(crate) fn forward() -> View<Homogeneous> {
    let mut surfaces = room(0.5);
    surfaces.push(lamp(dvec3(-0.9, 0.9, -0.9), 1.8 * DVec3::X, 1.8 * DVec3::Z, 0.0, 1.0));
    let lights = sources(vec![point(dvec3(-0.3, 0.7, -0.3), 1.0)]);
    let view = view((homogeneous(2.0), 0.95, 0.95), surfaces, lights);
    View { walk: Walk::new(Version::Terminating, Uniform::new(2.5).expect(LAWFUL)), ..view }
}

/// A lamp in a globe of glass, and one of glass that glows itself.
pub(crate) fn bulb() -> View<Homogeneous> {
    let mut surfaces = room(0.7);
    surfaces.push(smooth(ball(dvec3(0.0, 0.4, 0.0), 0.35), glass(1.5)));
    surfaces.push(diffuse(ball(dvec3(0.0, 0.4, 0.0), 0.2), 0.0, 4.0));
    let glows = smooth(ball(dvec3(-0.5, -0.6, 0.1), 0.3), glass(1.3));
    surfaces.push(Surface { emission: 0.15, ..glows });
    view((homogeneous(0.3), 0.3, 0.9), surfaces, sources(vec![]))
}

/// A floor in haze under a point light that stands above the haze: no direction meets it. Flights collide as often as the haze: a path
/// tracer whose energies may be negative would have heavy tails here.
pub(crate) fn lit_by_a_point() -> View<Homogeneous> {
    let floor = diffuse(rectangle(DVec3::splat(-1.0), 2.0 * DVec3::X, 2.0 * DVec3::Z), 0.7, 0.0);
    let lights = sources(vec![point(dvec3(0.2, 0.8, 0.1), 4.0)]);
    let view = view((homogeneous(0.8), 0.3, 0.9), vec![floor], lights);
    View { walk: Walk::new(Version::NonTerminating, Uniform::new(0.8).expect(LAWFUL)), ..view }
}

/// An endless medium of this extinction and phase function about a point light.
pub(crate) fn endless(sigma_t: f64, g: f64) -> View<Homogeneous> {
    let lights = sources(vec![point(dvec3(-0.3, 0.7, -0.3), 1.0)]);
    let mut view = view((homogeneous(sigma_t), g, 0.95), Vec::new(), lights);
    view.volume.bounds = Bounds::aligned_box(DVec3::splat(-90.0), DVec3::splat(90.0)).expect(LAWFUL);
    view
}

/// A ball of smoke by eq. 21 in parallel light, seen in four pixels.
pub(crate) fn haze_in_the_sun() -> View<AnalyticCosine> {
    let lights = sources(vec![Source::directional(dvec3(0.6, -0.5, -0.6), 3.0).expect(LAWFUL)]);
    let mut view = view((AnalyticCosine::new(2.0).expect(LAWFUL), 0.5, 0.7), Vec::new(), lights);
    view.volume.bounds = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 2.0).expect(LAWFUL);
    view.camera =
        Camera::new(dvec3(2.0, 1.0, -10.0), dvec3(0.0, 0.0, 10.0), DVec3::Y, 12.0, [2, 2]).expect(LAWFUL);
    View { walk: Walk::new(Version::NonTerminating, Uniform::new(1.6).expect(LAWFUL)), ..view }
}

/// A ball that glows and reflects as much, so that the radiance in it is 1, with haze, a mirror and a ball of glass in it. The haze ends before
/// the glass: what is scattered there may be reflected a hundred times before it gets out, a heavy tail.
pub(crate) fn glowing() -> View<Homogeneous> {
    let wall = diffuse(ball(DVec3::ZERO, 1.0), 0.5, 0.5);
    let mirror = smooth(ball(dvec3(0.4, 0.2, 0.3), 0.25), Material::Mirror);
    let clear = smooth(ball(dvec3(-0.3, -0.3, 0.3), 0.3), glass(1.5));
    let mut view = view((homogeneous(0.4), 0.4, 1.0), vec![wall, mirror, clear], sources(vec![]));
    view.volume.bounds = Bounds::sphere(dvec3(0.3, 0.3, -0.3), 0.7).expect(LAWFUL);
    view.camera = Camera::new(dvec3(0.0, 0.0, -0.6), DVec3::ZERO, DVec3::Y, 70.0, [1, 1]).expect(LAWFUL);
    view
}
