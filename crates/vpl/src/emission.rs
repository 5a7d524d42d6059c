//! Where light paths start.

use fairflight_media::Line;
use fairflight_scene::{Geometry, Lights, Segment, Spectrum, Surface, cosine_hemisphere};
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::f64::consts::PI;

/// All emitters of a scene, chosen in proportion to their power.
#[derive(Clone, Debug)]
pub struct Emitters<C> {
    list: Vec<Emitter<C>>,
    /// Of the first 1, 2, … emitters, by the greatest channel.
    cumulative: Vec<f64>,
    ball: (DVec3, f64),
}

#[derive(Clone, Copy, Debug)]
struct Emitter<C> {
    kind: Kind,
    power: C,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// One of `Lights::emit`.
    Light(usize),
    /// A surface, and which of its sides.
    Surface(usize, Sides),
}

/// Which sides of a surface send light to where it can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    Both,
    Outer,
}

/// The start of a light path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<C> {
    /// The first ray.
    pub segment: Segment,
    /// The power of all emitters, if this is the only light path.
    pub power: C,
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
        let of_lights = (0..lights.emitters())
            .map(|index| Emitter { kind: Kind::Light(index), power: lights.power(index, ball.1) });
        let of_surfaces = geometry.emitters().iter().map(|&index| {
            let surface = &geometry.surfaces()[index];
            let sides = Sides::seen(surface, observer);
            let count = if sides == Sides::Both { 2.0 } else { 1.0 };
            let power = surface.emission * (PI * surface.shape.area() * count);
            Emitter { kind: Kind::Surface(index, sides), power }
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

    /// Draws the start of a light path; `None` if nothing shines.
    pub fn sample<G: Geometry<C>, S: UniformSource + ?Sized>(
        &self,
        lights: &Lights<C>,
        geometry: &G,
        source: &mut S,
    ) -> Option<Start<C>> {
        let total = self.cumulative.last().copied().filter(|&total| total > 0.0)?;
        let target = source.next_uniform() * total;
        let index = self.cumulative.partition_point(|&sum| sum <= target).min(self.list.len() - 1);
        let Emitter { kind, power } = self.list[index];
        let pmf = power.max_channel() / total;
        let free = |line| Segment { line, length: f64::INFINITY, from: None, to: None };
        Some(match kind {
            Kind::Light(light) => {
                let u = std::array::from_fn(|_| source.next_uniform());
                let photon = lights.emit(light, self.ball, u)?;
                let line = Line { origin: photon.origin, direction: photon.direction };
                Start { segment: free(line), power: photon.power * (1.0 / pmf) }
            }
            Kind::Surface(surface, sides) => {
                let [u, v, side, s, t] = std::array::from_fn(|_| source.next_uniform());
                let point = geometry.surfaces()[surface].shape.sample_area(u, v);
                let inner = sides == Sides::Both && side < 0.5;
                let normal = if inner { -point.normal } else { point.normal };
                let line = Line { origin: point.position, direction: cosine_hemisphere(normal, s, t) };
                Start { segment: Segment { from: Some(surface), ..free(line) }, power: power * (1.0 / pmf) }
            }
        })
    }
}

impl Sides {
    fn seen<C: Spectrum>(surface: &Surface<C>, observer: DVec3) -> Self {
        let closed = surface.is_opaque() && surface.shape.is_closed();
        if closed && !surface.shape.encloses(observer) { Self::Outer } else { Self::Both }
    }
}
