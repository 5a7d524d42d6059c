//! Where a compensation vertex lies.

use crate::{CompensationOptions, LocalMean, Placement, TransmittanceUse, TruncatedExponential, Visibility};
use fairflight_media::{Extinction, Medium, PhaseFunction};
use fairflight_paths::transport::{Event, Lobe, Vertex};
use fairflight_paths::{RayTransmittance, SamplingExtinction};
use fairflight_scene::{Geometry, Hit, Segment, Spectrum};
use fairflight_sources::UniformSource;
use fairflight_vpl::Gather;

/// What lies around a point as far as bounding reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region {
    /// The point.
    pub(crate) center: Vertex,
    /// b \[1/length²\].
    pub(crate) bound: f64,
    /// d = 1/√b, beyond which G ≤ 1/r² ≤ b. With a cosine at either end G is smaller, and so is the region in most directions.
    radius: f64,
    /// The surfaces that come near, one bit each.
    near: u64,
}

/// A compensation vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed<C> {
    /// Where, seen from the point that it compensates.
    pub(crate) vertex: Vertex,
    /// Transmittance · (σ_s or reflectance)/density: what L_s has to be multiplied with, without (G − b)/G.
    pub(crate) factor: C,
    /// G between the two \[1/length²\].
    pub(crate) geometric: f64,
}

impl Region {
    pub(crate) fn new<G, M, P, C, R, T>(
        center: Vertex,
        bound: f64,
        options: &CompensationOptions,
        gather: &Gather<'_, G, M, P, C, R, T>,
    ) -> Self
    where
        G: Geometry<C>,
        C: Spectrum,
    {
        let radius = 1.0 / bound.sqrt();
        let near = match options.visibility {
            Visibility::Full => u64::MAX,
            Visibility::Local => gather.world.surfaces.reaching(center.position, radius),
            Visibility::Ignored => 0,
        };
        Self { center, bound, radius, near }
    }

    /// Draws a vertex; `None` where the ray leaves the region or meets something smooth, with which nothing is ever connected.
    pub(crate) fn place<G, M, P, C, R, T, S>(
        &self,
        options: &CompensationOptions,
        mean: &LocalMean,
        gather: &mut Gather<'_, G, M, P, C, R, T>,
        source: &mut S,
    ) -> Option<Placed<C>>
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        C: Spectrum,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let y = &self.center;
        let phase = &gather.world.volume.phase;
        let direction = y.sample(phase, source.next_uniform(), source.next_uniform());
        let mut segment = y.leave(direction, self.radius);
        let hit =
            if self.near == 0 { None } else { gather.world.surfaces.intersect_among(&segment, self.near) };
        segment.length = hit.map_or(self.radius, |hit| hit.distance);
        let (vertex, factor) = match options.placement {
            Placement::FreeFlight => by_flight(&segment, hit.as_ref(), gather, source)?,
            Placement::LocallyHomogeneous => {
                let law = (self.radius, options.transmittance, mean);
                within_region(&segment, law, hit.as_ref(), gather, source)?
            }
        };
        let squared = (vertex.position - y.position).length_squared();
        let geometric = y.cosine(direction) * vertex.cosine(-direction) / squared;
        Some(Placed { vertex, factor, geometric })
    }
}

/// By a free flight, cut off where the region ends: what lies beyond counts for nothing.
fn by_flight<G, M, P, C, R, T, S>(
    segment: &Segment,
    hit: Option<&Hit<'_, C>>,
    gather: &Gather<'_, G, M, P, C, R, T>,
    source: &mut S,
) -> Option<(Vertex, C)>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    S: UniformSource + ?Sized,
{
    let world = &gather.world;
    match world.follow(&gather.walk, &world.collisions(&gather.walk), segment, source) {
        Event::Scattered { vertex, energy } => Some((vertex, energy)),
        Event::Passed { weight } => {
            let (vertex, reflectance) = world.diffuse_vertex(hit?)?;
            Some((vertex, reflectance * weight))
        }
        Event::Absorbed | Event::Truncated => None,
    }
}

/// As if the medium were homogeneous within the region (engelhardt-2013 eq. 4).
///
/// With a surface at s < d the distance is drawn within d all the same, and one beyond the medium in front of the surface means the
/// surface: with probability (e^{−σs} − e^{−σd})/(1 − e^{−σd}), not exp(−σs) as under a free flight. The paper's appendix never
/// limits d to the surface.
fn within_region<G, M, P, C, R, T, S>(
    segment: &Segment,
    (radius, transmittance, mean): (f64, TransmittanceUse, &LocalMean),
    hit: Option<&Hit<'_, C>>,
    gather: &mut Gather<'_, G, M, P, C, R, T>,
    source: &mut S,
) -> Option<(Vertex, C)>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
    S: UniformSource + ?Sized,
{
    let world = gather.world;
    let surface = hit.and_then(|hit| world.diffuse_vertex(hit));
    let length = segment.length.is_finite().then_some(segment.length);
    let Some(ray) = world.volume.enter(&segment.line, length) else { return surface };
    // The medium ends here at the latest; so does what is drawn, unless something lies behind.
    let end = ray.entry_distance() + ray.length();
    let rate = mean.placement_rate(segment.line.origin);
    let reach = match surface {
        None => end,
        // Any reach beyond the end will do where neither the region nor the medium says one.
        Some(_) if rate == 0.0 && radius == f64::INFINITY => 2.0 * end,
        Some(_) => radius,
    };
    let law = TruncatedExponential::new(rate, reach);
    let distance = law.sample(source.next_uniform());
    let mut between = |distance: f64, source: &mut S| match transmittance {
        TransmittanceUse::Exact => {
            let way = Segment { length: distance, ..*segment };
            world.transmittance(&way, &mut gather.shadow, source)
        }
        TransmittanceUse::Approximate => (-mean.at(segment.line.origin) * distance).exp(),
    };
    if distance < end {
        if distance < ray.entry_distance() {
            return None;
        }
        let sigma_t = ray.sigma_t(distance - ray.entry_distance());
        if sigma_t == 0.0 {
            return None;
        }
        let weight = between(distance, source) * sigma_t / law.pdf_distance(distance);
        let lobe = Lobe::Phase { incident: segment.line.direction };
        let vertex = Vertex { position: segment.line.at(distance), lobe };
        Some((vertex, world.volume.albedo * weight))
    } else {
        let (vertex, reflectance) = surface?;
        let weight = between(segment.length, source) / law.probability_beyond(end);
        Some((vertex, reflectance * weight))
    }
}
