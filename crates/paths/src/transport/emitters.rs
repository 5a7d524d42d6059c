//! Emission of light paths.

use fairflight_media::Line;
use fairflight_scene::{Geometry, Lights, Segment, Spectrum, Surface, cosine_hemisphere};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// All emitters of a scene, chosen in proportion to their power.
#[derive(Clone, Debug)]
pub struct Emitters<C> {
    list: Vec<Emitter<C>>,
    /// Sums of the powers of the first 1, 2, … emitters, by the greatest channel.
    cumulative: Vec<f64>,
    ball: (DVec3, f64),
}

#[derive(Clone, Copy, Debug)]
struct Emitter<C> {
    light: Light,
    sides: Sides,
    power: C,
}

/// One emitter of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// The constant part of the background.
    Constant,
    /// A map of the background, by its index.
    Map(usize),
    /// A light without extent, by its index.
    Source(usize),
    /// A surface, by its index.
    Surface(usize),
}

impl Light {
    /// Returns true if a direction may meet the emitter by chance; not one of a point or of a direction.
    #[must_use]
    pub fn has_extent(self) -> bool {
        !matches!(self, Self::Source(_))
    }
}

/// Sides of a surface that send light to where it can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Both of them, each with half of the light paths.
    Both,
    /// The outer side of a closed surface.
    Outer,
}

/// The start of a light path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<C> {
    /// The first ray.
    pub segment: Segment,
    /// The power of all emitters, if this is the only light path.
    pub power: C,
    /// The emitter.
    pub light: Light,
    /// The probability of the emitter, times the density of the start on it: of the point on a surface \[1/length²\], of the direction
    /// in which light of the background arrives \[1/sr\], 1 for a light without extent.
    pub pdf: f64,
}

impl<C: Spectrum> Emitters<C> {
    /// The emitters of a scene that fits into `ball` (center, radius) and is seen from `observer`.
    ///
    /// The inside of a closed opaque surface in which nobody stands is never seen: nothing starts there.
    pub fn new<G: Geometry<C>>(
        lights: &Lights<C>,
        geometry: &G,
        ball: (DVec3, f64),
        observer: DVec3,
    ) -> Self {
        // In the order of `Lights::emit`.
        let constant = (lights.background.constant != C::ZERO).then_some(Light::Constant);
        let maps = (0..lights.background.maps.len()).map(Light::Map);
        let sources = (0..lights.sources.len()).map(Light::Source);
        let of_lights = constant
            .into_iter()
            .chain(maps)
            .chain(sources)
            .enumerate()
            .map(|(index, light)| Emitter { light, sides: Sides::Outer, power: lights.power(index, ball.1) });
        let of_surfaces = geometry.emitters().iter().map(|&index| {
            let surface = &geometry.surfaces()[index];
            let sides = Sides::seen(surface, observer);
            let count = if sides == Sides::Both { 2.0 } else { 1.0 };
            let power = surface.emission * (PI * surface.shape.area() * count);
            Emitter { light: Light::Surface(index), sides, power }
        });
        let list: Vec<Emitter<C>> = of_lights.chain(of_surfaces).collect();
        let mut sum = 0.0;
        let cumulative = list
            .iter()
            .map(|emitter| {
                sum += emitter.power.max_channel();
                sum
            })
            .collect();
        Self { list, cumulative, ball }
    }

    /// The power of all emitters together, as far as it may meet the scene.
    #[must_use]
    pub fn power(&self) -> C {
        self.list.iter().fold(C::ZERO, |sum, emitter| sum + emitter.power)
    }

    /// The probability that a light path starts on `light` \[1\]; 0 where it has no power, or is none of these.
    #[must_use]
    pub fn pmf(&self, light: Light) -> f64 {
        match (self.find(light), self.cumulative.last()) {
            (Some(emitter), Some(&total)) if total > 0.0 => emitter.power.max_channel() / total,
            _ => 0.0,
        }
    }

    /// The sides of `light` on which light paths start; the outer one where that means nothing.
    #[must_use]
    pub fn sides(&self, light: Light) -> Sides {
        self.find(light).map_or(Sides::Outer, |emitter| emitter.sides)
    }

    /// The area of the disc that infinitely far light crosses to meet the scene \[length²\].
    #[must_use]
    pub fn disc(&self) -> f64 {
        PI * self.ball.1 * self.ball.1
    }

    fn find(&self, light: Light) -> Option<&Emitter<C>> {
        self.list.iter().find(|emitter| emitter.light == light)
    }

    /// Draws the start of a light path; `None` if nothing shines.
    pub fn sample<G: Geometry<C>>(
        &self,
        lights: &Lights<C>,
        geometry: &G,
        source: &mut impl UniformSource,
    ) -> Option<Start<C>> {
        let total = self.cumulative.last().copied().filter(|&total| total > 0.0)?;
        let target = source.next_uniform() * total;
        let index = self.cumulative.partition_point(|&sum| sum <= target).min(self.list.len() - 1);
        let Emitter { light, sides, power } = self.list[index];
        let pmf = power.max_channel() / total;
        let free = |line| Segment { line, length: f64::INFINITY, from: None, to: None };
        Some(match light {
            Light::Constant | Light::Map(_) | Light::Source(_) => {
                let u = std::array::from_fn(|_| source.next_uniform());
                let photon = lights.emit(index, self.ball, u)?;
                let line = Line { origin: photon.origin, direction: photon.direction };
                let pdf = match light {
                    Light::Constant => pmf * (0.25 * FRAC_1_PI),
                    Light::Map(map) => pmf * lights.background.maps[map].pdf_solid_angle(-photon.direction),
                    Light::Source(_) | Light::Surface(_) => pmf,
                };
                Start { segment: free(line), power: photon.power * (1.0 / pmf), light, pdf }
            }
            Light::Surface(surface) => {
                let [u, v, side, s, t] = std::array::from_fn(|_| source.next_uniform());
                let shape = &geometry.surfaces()[surface].shape;
                let point = shape.sample_area(u, v);
                let inner = sides == Sides::Both && side < 0.5;
                let normal = if inner { -point.normal } else { point.normal };
                let line = Line { origin: point.position, direction: cosine_hemisphere(normal, s, t) };
                let segment = Segment { from: Some(surface), ..free(line) };
                Start { segment, power: power * (1.0 / pmf), light, pdf: pmf / shape.area() }
            }
        })
    }
}

impl Sides {
    fn seen<C: Spectrum>(surface: &Surface<C>, observer: DVec3) -> Self {
        let closed = surface.is_opaque() && surface.shape.is_closed();
        if closed && !surface.shape.encloses(observer) { Self::Outer } else { Self::Both }
    }

    /// The density of the direction in which a light path leaves its start, per projected solid angle; `cosine` is that of the
    /// angle to the outer normal \[1/sr\].
    #[must_use]
    pub fn pdf_projected(self, cosine: f64) -> f64 {
        match self {
            Self::Both => 0.5 * FRAC_1_PI,
            Self::Outer if cosine > 0.0 => FRAC_1_PI,
            Self::Outer => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Scene, ball, diffuse, square, vacuum};
    use super::*;
    use fairflight_media::EmptySpace;
    use fairflight_scene::{Background, EnvironmentMap, Material, NoSurfaces, Source};
    use fairflight_sources::Scripted;
    use glam::dvec3;

    const BALL: (DVec3, f64) = (DVec3::ZERO, 2.0);
    const FAR: DVec3 = DVec3::new(50.0, 0.0, 0.0);

    fn emitters(scene: &Scene<EmptySpace>, observer: DVec3) -> Emitters<f64> {
        Emitters::new(&scene.lights, &scene.surfaces, BALL, observer)
    }

    fn power(surface: Surface<f64>, observer: DVec3) -> f64 {
        emitters(&vacuum(vec![surface], vec![]), observer).power()
    }

    #[test]
    fn powers_of_lights_and_surfaces() {
        let lights = |sources| emitters(&vacuum(vec![], sources), FAR).power();
        assert_eq!(lights(vec![Source::point(DVec3::ONE, 5.0).unwrap()]), 5.0);
        // On the disc of the ball, π 2².
        let parallel = lights(vec![Source::directional(DVec3::Z, 5.0).unwrap()]);
        assert!((parallel - 20.0 * PI).abs() < 1e-14);
        // π · radiance · area, on both sides of a rectangle.
        assert!((power(square(0.0, 1.0, diffuse(0.5), 3.0), FAR) - 24.0 * PI).abs() < 1e-13);
        assert_eq!(power(square(0.0, 1.0, diffuse(0.5), 0.0), FAR), 0.0);
        // Of a sphere that nobody sees from inside the outer side: π · 3 · 4π.
        let outer = 12.0 * PI * PI;
        let lamp = |material| ball(DVec3::ZERO, 1.0, material, 3.0);
        assert!((power(lamp(diffuse(0.5)), FAR) - outer).abs() < 1e-13);
        assert!((power(lamp(diffuse(0.5)), 0.5 * DVec3::X) - 2.0 * outer).abs() < 1e-13);
        // Out of glass light comes from the inside, too.
        assert!((power(lamp(Material::Dielectric { ior: 1.5 }), FAR) - 2.0 * outer).abs() < 1e-13);
        assert!((power(lamp(Material::Mirror), FAR) - outer).abs() < 1e-13);
    }

    #[test]
    fn the_background_emits() {
        let mut scene = vacuum(vec![], vec![]);
        scene.lights.background.constant = 0.25;
        scene.lights.background.maps.push(EnvironmentMap::new(2, 2, vec![0.75; 4]).unwrap());
        scene.lights.sources.push(Source::point(DVec3::ZERO, 16.0 * PI * PI).unwrap());
        // 4π · π 2², of radiance 1 in all, and a point as bright.
        let emitters = emitters(&scene, FAR);
        assert!((emitters.power() - 32.0 * PI * PI).abs() < 1e-12);
        let over_sphere = 0.25 * FRAC_1_PI;
        let lights = [
            (0.1, Light::Constant, 0.125 * over_sphere),
            (0.4, Light::Map(0), 0.375 * over_sphere),
            (0.6, Light::Source(0), 0.5),
        ];
        for (u, light, pdf) in lights {
            let mut source = Scripted::new([u, 0.5, 0.5, 0.5, 0.5, 0.5]);
            let start = emitters.sample(&scene.lights, &scene.surfaces, &mut source).unwrap();
            assert_eq!((start.light, light.has_extent()), (light, !matches!(light, Light::Source(_))));
            assert!((start.pdf - pdf).abs() < 1e-15);
            let pmf = if light.has_extent() { pdf / over_sphere } else { pdf };
            assert!((emitters.pmf(light) - pmf).abs() < 1e-15);
            assert!((start.power - 32.0 * PI * PI).abs() < 1e-12);
        }
    }

    /// A point light of power 1, a lamp of 3 on both sides together, and one that is black.
    fn mixed() -> Scene<EmptySpace> {
        let lamp = square(1.0, 0.5, diffuse(0.0), 1.5 / PI);
        let dark = square(2.0, 0.5, diffuse(0.0), 0.0);
        vacuum(vec![dark, lamp], vec![Source::point(dvec3(0.0, 0.0, 5.0), 1.0).unwrap()])
    }

    fn start(u: &[f64]) -> Start<f64> {
        let scene = mixed();
        let mut source = Scripted::new(u.iter().copied());
        let start = emitters(&scene, FAR).sample(&scene.lights, &scene.surfaces, &mut source).unwrap();
        assert_eq!(source.remaining(), 0);
        start
    }

    #[test]
    fn starts_are_chosen_in_proportion_and_carry_all_power() {
        for u in [0.0, 0.2, 0.249_999] {
            // on_sphere(1/2, 1/4) is the y axis.
            let light = start(&[u, 0.5, 0.25, 0.9, 0.9, 0.9]);
            assert_eq!(light.segment.line.origin, dvec3(0.0, 0.0, 5.0));
            assert!((light.segment.line.direction - DVec3::Y).length() < 1e-15);
            assert_eq!((light.segment.from, light.segment.to, light.light), (None, None, Light::Source(0)));
            assert!((light.pdf - 0.25).abs() < 1e-15);
            assert!((light.power - 4.0).abs() < 1e-14);
        }
        for u in [0.250_001, 0.7, 1.0 - f64::EPSILON] {
            for (side, normal) in [(0.49, DVec3::NEG_Z), (0.5, DVec3::Z)] {
                let lamp = start(&[u, 0.5, 0.25, side, 0.0, 0.0]);
                assert_eq!(lamp.segment.line.origin, dvec3(0.0, -0.25, 1.0));
                assert_eq!(lamp.segment.line.direction, normal);
                assert_eq!((lamp.segment.from, lamp.segment.length), (Some(1), f64::INFINITY));
                assert_eq!(lamp.light, Light::Surface(1));
                assert!((lamp.pdf - 0.75).abs() < 1e-15, "on the area 1: {}", lamp.pdf);
                assert!((lamp.power - 4.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn what_is_no_emitter_is_never_chosen() {
        let emitters = emitters(&mixed(), FAR);
        for light in [Light::Constant, Light::Map(0), Light::Source(1), Light::Surface(0)] {
            assert_eq!(emitters.pmf(light), 0.0, "{light:?}");
        }
        assert_eq!(emitters.sides(Light::Surface(1)), Sides::Both);
        assert!((emitters.disc() - 4.0 * PI).abs() < 1e-14);
        // Over the projected hemispheres both densities integrate to one: π on each side.
        assert!((2.0 * PI * Sides::Both.pdf_projected(-0.3) - 1.0).abs() < 1e-15);
        assert_eq!((PI * Sides::Outer.pdf_projected(0.3), Sides::Outer.pdf_projected(-0.3)), (1.0, 0.0));
    }

    #[test]
    fn a_sphere_starts_outwards_unless_somebody_stands_inside() {
        let scene = vacuum(vec![ball(DVec3::ZERO, 1.0, diffuse(0.0), 1.0)], vec![]);
        for (observer, side, sign) in [(FAR, 0.1, 1.0), (DVec3::ZERO, 0.1, -1.0), (DVec3::ZERO, 0.9, 1.0)] {
            let mut source = Scripted::new([0.5, 0.3, 0.6, side, 0.0, 0.0]);
            let start =
                emitters(&scene, observer).sample(&scene.lights, &scene.surfaces, &mut source).unwrap();
            let line = start.segment.line;
            assert!((line.direction - sign * line.origin).length() < 1e-15);
        }
    }

    #[test]
    fn where_nothing_shines_nothing_starts() {
        let scene =
            vacuum(vec![square(1.0, 1.0, diffuse(0.5), 0.0)], vec![Source::point(DVec3::ONE, 0.0).unwrap()]);
        let emitters = emitters(&scene, FAR);
        assert_eq!(emitters.power(), 0.0);
        assert!(emitters.sample(&scene.lights, &scene.surfaces, &mut Scripted::new([])).is_none());
    }

    #[test]
    fn colours_are_chosen_by_their_greatest_channel() {
        let red = Source::point(DVec3::ZERO, dvec3(3.0, 0.0, 0.0)).unwrap();
        let gray = Source::point(DVec3::ONE, DVec3::ONE).unwrap();
        let lights = Lights { background: Background::dark(), sources: vec![red, gray] };
        let emitters = Emitters::new(&lights, &NoSurfaces, BALL, FAR);
        assert_eq!(emitters.power(), dvec3(4.0, 1.0, 1.0));
        let start = |u: f64| {
            let mut source = Scripted::new([u, 0.5, 0.5, 0.5, 0.5, 0.5]);
            emitters.sample(&lights, &NoSurfaces, &mut source).unwrap().power
        };
        assert!((start(0.74) - dvec3(4.0, 0.0, 0.0)).length() < 1e-14);
        assert!((start(0.76) - DVec3::splat(4.0)).length() < 1e-14);
        // On average all power, per channel.
        assert!((0.75 * start(0.1) + 0.25 * start(0.9) - emitters.power()).length() < 1e-14);
    }
}
