//! Placement of a compensation vertex.

use crate::{CompensationOptions, LocalMean, Placement, TransmittanceUse, TruncatedExponential, Visibility};
use fairflight_elementary::exp;
use fairflight_media::Extinction;
use fairflight_paths::transport::{Event, Lobe, Types, Vertex};
use fairflight_scene::{Geometry, Hit, Segment};
use fairflight_sources::UniformSource;
use fairflight_vpl::Gather;

/// Surroundings of a point, as far as bounding reaches.
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
    /// The vertex, seen from the point that it compensates.
    pub(crate) vertex: Vertex,
    /// Transmittance · (σ_s or reflectance)/density: what L_s has to be multiplied with, without (G − b)/G.
    pub(crate) factor: C,
    /// G between the two \[1/length²\].
    pub(crate) geometric: f64,
}

impl Region {
    pub(crate) fn new<W: Types>(
        center: Vertex,
        bound: f64,
        options: &CompensationOptions,
        gather: &Gather<'_, W>,
    ) -> Self {
        let radius = 1.0 / bound.sqrt();
        let near = match options.visibility {
            Visibility::Full => u64::MAX,
            Visibility::Local => gather.world.surfaces.reaching(center.position, radius),
            // On a surface the other surface is what matters most (kollig-2004).
            Visibility::Ignored if center.surface().is_some() => u64::MAX,
            Visibility::Ignored => 0,
        };
        Self { center, bound, radius, near }
    }

    /// Draws a vertex; `None` where the ray leaves the region or meets something smooth, with which nothing is ever connected.
    pub(crate) fn place<W: Types>(
        &self,
        options: &CompensationOptions,
        mean: &LocalMean,
        gather: &mut Gather<'_, W>,
        source: &mut impl UniformSource,
    ) -> Option<Placed<W::Spectrum>> {
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

/// Places a vertex by a free flight, cut off where the region ends: what lies beyond counts for nothing.
fn by_flight<W: Types>(
    segment: &Segment,
    hit: Option<&Hit<'_, W::Spectrum>>,
    gather: &Gather<'_, W>,
    source: &mut impl UniformSource,
) -> Option<(Vertex, W::Spectrum)> {
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

/// Places a vertex as if the medium were homogeneous within the region (engelhardt-2013 eq. 4).
///
/// With a surface at s < d the distance is drawn within d all the same, and one beyond the medium in front of the surface means the
/// surface: with probability (e^{−σs} − e^{−σd})/(1 − e^{−σd}), not exp(−σs) as under a free flight. The paper's appendix never
/// limits d to the surface.
fn within_region<W: Types>(
    segment: &Segment,
    (radius, transmittance, mean): (f64, TransmittanceUse, &LocalMean),
    hit: Option<&Hit<'_, W::Spectrum>>,
    gather: &mut Gather<'_, W>,
    source: &mut impl UniformSource,
) -> Option<(Vertex, W::Spectrum)> {
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
    let mut between = |distance: f64| match transmittance {
        TransmittanceUse::Exact => {
            let way = Segment { length: distance, ..*segment };
            world.transmittance(&way, &mut gather.shadow, source)
        }
        TransmittanceUse::Approximate => exp(-mean.at(segment.line.origin) * distance),
    };
    if distance < end {
        if distance < ray.entry_distance() {
            return None;
        }
        let sigma_t = ray.sigma_t(distance - ray.entry_distance());
        if sigma_t == 0.0 {
            return None;
        }
        let weight = between(distance) * sigma_t / law.pdf_distance(distance);
        let lobe = Lobe::Phase { incident: segment.line.direction };
        let vertex = Vertex { position: segment.line.at(distance), lobe };
        Some((vertex, world.volume.albedo * weight))
    } else {
        let (vertex, reflectance) = surface?;
        let weight = between(segment.length) / law.probability_beyond(end);
        Some((vertex, reflectance * weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{
        ALBEDO, REFLECTANCE, SIGMA_T, Scene, hazy, in_medium, mean, on_floor, room, square, vacuum,
    };
    use fairflight_media::{Bounds, LineThickness};
    use fairflight_scene::Material;
    use fairflight_sources::Scripted;
    use glam::{DVec3, dvec3};
    use std::f64::consts::LN_2;

    const EXACT: CompensationOptions = CompensationOptions::EXACT;
    const LOCAL: CompensationOptions =
        CompensationOptions { placement: Placement::LocallyHomogeneous, ..EXACT };
    /// Variates for straight up from a floor, and for on along z in the medium.
    const UP: [f64; 2] = [0.0, 0.0];

    /// The vertex of these variates, all of which it must use, within 1/√`bound` of `y`.
    fn place<M: LineThickness>(
        scene: &Scene<M>,
        (y, bound): (Vertex, f64),
        (options, sigma_t): (CompensationOptions, f64),
        script: &[f64],
    ) -> Option<Placed<f64>> {
        let mut gather = scene.gather(&[], bound);
        let region = Region::new(y, bound, &options, &gather);
        let mut source = Scripted::new(script.iter().copied());
        let placed = region.place(&options, &mean(sigma_t), &mut gather, &mut source);
        assert_eq!(source.remaining(), 0);
        placed
    }

    fn up(rest: &[f64]) -> Vec<f64> {
        [&UP[..], rest].concat()
    }

    #[test]
    fn without_a_medium_the_next_surface_within_the_region() {
        for options in [EXACT, LOCAL] {
            let near = vacuum(room(0.5), vec![]);
            let placed = place(&near, (on_floor(), 1.0), (options, SIGMA_T), &UP).unwrap();
            assert_eq!(placed.vertex.position, 0.5 * DVec3::Z);
            assert_eq!(placed.vertex.lobe, Lobe::Diffuse { normal: DVec3::NEG_Z, surface: 1 });
            assert_eq!((placed.factor, placed.geometric), (REFLECTANCE, 4.0));
            // At the cosine 1/2 to either normal it is 1 away, and at 0.4 beyond the region.
            let slanted = place(&near, (on_floor(), 0.99), (options, SIGMA_T), &[0.75, 0.3]).unwrap();
            assert!((slanted.geometric - 0.25).abs() < 1e-14);
            assert!(place(&near, (on_floor(), 1.0), (options, SIGMA_T), &[0.84, 0.3]).is_none());
            // b = 0 has no end.
            let far = vacuum(room(8.0), vec![]);
            assert!(place(&far, (on_floor(), 1.0), (options, SIGMA_T), &UP).is_none());
            let endless = place(&far, (on_floor(), 0.0), (options, SIGMA_T), &UP).unwrap();
            assert_eq!((endless.factor, endless.geometric), (REFLECTANCE, 1.0 / 64.0));
            // Something smooth is in the way, and is no vertex.
            let mut surfaces = room(0.5);
            surfaces.push(square(0.25, Material::Mirror));
            assert!(place(&vacuum(surfaces, vec![]), (on_floor(), 1.0), (options, SIGMA_T), &UP).is_none());
        }
    }

    #[test]
    fn visibility_full_local_and_ignored() {
        let scene = vacuum(room(0.5), vec![]);
        for placement in [Placement::FreeFlight, Placement::LocallyHomogeneous] {
            let seen = |visibility, bound| {
                let options = CompensationOptions { placement, visibility, ..EXACT };
                place(&scene, (on_floor(), bound), (options, SIGMA_T), &UP).map(|placed| placed.factor)
            };
            for bound in [0.0, 1.0, 3.9] {
                assert_eq!(seen(Visibility::Full, bound), Some(REFLECTANCE));
                assert_eq!(seen(Visibility::Local, bound), Some(REFLECTANCE));
                // A point of a surface sees surfaces whatever is said.
                assert_eq!(seen(Visibility::Ignored, bound), Some(REFLECTANCE));
            }
            assert_eq!((seen(Visibility::Full, 4.1), seen(Visibility::Local, 4.1)), (None, None));
        }
        // Ignored, the vertex of a point of the medium may lie behind the surface that a free flight would have met.
        let hazy = hazy(room(0.5));
        let above = Vertex { position: 0.25 * DVec3::Z, lobe: Lobe::Phase { incident: DVec3::Z } };
        let reached = |visibility, script: &[f64]| {
            let options = CompensationOptions { visibility, ..EXACT };
            let placed = place(&hazy, (above, 0.1), (options, SIGMA_T), script).unwrap();
            (placed.vertex.position - above.position).length()
        };
        assert!((reached(Visibility::Ignored, &[0.0, 0.0, 0.5, 0.1]) - 2.0 * LN_2).abs() < 1e-15);
        assert_eq!(reached(Visibility::Full, &[0.0, 0.0, 0.5]), 0.25);
    }

    #[test]
    fn a_free_flight_may_be_lost() {
        let scene = hazy(room(2.0));
        let y = in_medium(DVec3::Z, DVec3::Z);
        let flight = |bound, rest: &[f64]| place(&scene, (y, bound), (EXACT, SIGMA_T), &up(rest));
        // −ln(1 − u)/σ, less than the 1 to either surface; the albedo decides what happens there.
        let placed = flight(0.25, &[0.2, 0.74]).unwrap();
        let distance = (placed.vertex.position - y.position).length();
        assert!((distance + 0.8f64.ln() / SIGMA_T).abs() < 1e-15);
        let Lobe::Phase { incident } = placed.vertex.lobe else { panic!("{placed:?}") };
        assert!((incident - (placed.vertex.position - y.position) / distance).length() < 1e-14);
        assert_eq!(placed.factor, 1.0);
        assert!((placed.geometric * distance * distance - 1.0).abs() < 1e-14);
        assert!(flight(0.25, &[0.2, 0.76]).is_none());
        // Through the 1 to the surface, or to the end of the region before it.
        let at_surface = flight(0.25, &[0.5]).unwrap();
        assert!(at_surface.vertex.surface().is_some());
        assert!(
            (at_surface.factor - REFLECTANCE).abs() < 1e-15 && (at_surface.geometric - 1.0).abs() < 1e-14
        );
        assert!(flight(4.0, &[0.5]).is_none());
    }

    #[test]
    fn within_a_homogeneous_region_every_collision_weighs_the_same() {
        // T σ_s over the density of eq. 4 is albedo · (1 − e^(−σR)), wherever the vertex lies.
        let scene = hazy(vec![]);
        let y = in_medium(DVec3::ZERO, DVec3::Z);
        let expected = ALBEDO * -(-SIGMA_T * 2.0).exp_m1();
        let law = TruncatedExponential::new(SIGMA_T, 2.0);
        for u in [0.0, 0.3, 0.999] {
            for transmittance in [TransmittanceUse::Exact, TransmittanceUse::Approximate] {
                let options = CompensationOptions { transmittance, ..LOCAL };
                let Some(placed) = place(&scene, (y, 0.25), (options, SIGMA_T), &up(&[u])) else { panic!() };
                assert!((placed.factor - expected).abs() < 1e-14, "{u} {transmittance:?}");
                assert!((placed.vertex.position.length() - law.sample(u)).abs() < 1e-15);
            }
        }
        // Where the mean is not the extinction, one transmittance is right and the other that of another medium.
        let weight = |transmittance| {
            let options = CompensationOptions { transmittance, ..LOCAL };
            place(&scene, (y, 0.25), (options, 0.8), &up(&[0.6])).unwrap().factor
        };
        let law = TruncatedExponential::new(0.8, 2.0);
        let t = law.sample(0.6);
        let right = ALBEDO * SIGMA_T * (-SIGMA_T * t).exp() / law.pdf_distance(t);
        assert!((weight(TransmittanceUse::Exact) - right).abs() < 1e-14);
        let other = ALBEDO * SIGMA_T / 0.8 * -(-1.6f64).exp_m1();
        assert!((weight(TransmittanceUse::Approximate) - other).abs() < 1e-14);
    }

    #[test]
    fn the_surface_event_has_the_probability_of_the_truncated_law() {
        // A ceiling at 1, the region reaches 2: (e^(−σ) − e^(−2σ))/(1 − e^(−2σ)) = 1/(1 + e^σ), not e^(−σ).
        let scene = hazy(room(1.0));
        let probability = 1.0 / (1.0 + SIGMA_T.exp());
        let at = |u| place(&scene, (on_floor(), 0.25), (LOCAL, SIGMA_T), &up(&[u])).unwrap();
        let below = at(1.0 - probability - 1e-9);
        assert!(below.vertex.surface().is_none() && (below.vertex.position.z - 1.0).abs() < 1e-8);
        let above = at(1.0 - probability + 1e-9);
        assert_eq!(above.vertex.surface(), Some(1));
        assert!((above.factor - REFLECTANCE * (-SIGMA_T).exp() / probability).abs() < 1e-14);
        // Both events together are what a free flight finds: 1 − e^(−σ) of collisions, e^(−σ) of the surface.
        let collisions = (1.0 - probability) * below.factor / ALBEDO;
        assert!((collisions + probability * above.factor / REFLECTANCE - 1.0).abs() < 1e-14);
        assert!((collisions + (-SIGMA_T).exp_m1()).abs() < 1e-14);
    }

    #[test]
    fn a_region_without_end_or_mean() {
        // b = 0, and a mean of nothing: uniform to twice the distance of the surface.
        let scene = hazy(room(1.0));
        let at = |u| place(&scene, (on_floor(), 0.0), (LOCAL, 0.0), &up(&[u])).unwrap();
        let surface = at(0.5);
        assert_eq!(surface.vertex.surface(), Some(1));
        assert!((surface.factor - 2.0 * REFLECTANCE * (-SIGMA_T).exp()).abs() < 1e-15);
        let collision = at(0.25);
        assert_eq!(collision.vertex.position, 0.5 * DVec3::Z);
        assert!((collision.factor - 2.0 * ALBEDO * SIGMA_T * (-0.5 * SIGMA_T).exp()).abs() < 1e-15);
    }

    #[test]
    fn before_the_medium_there_is_nothing_to_meet() {
        let mut scene = hazy(room(2.0));
        scene.volume.bounds = Bounds::aligned_box(dvec3(-9.0, -9.0, 0.5), dvec3(9.0, 9.0, 1.5)).unwrap();
        let at = |u| place(&scene, (on_floor(), 1.0 / 9.0), (LOCAL, SIGMA_T), &up(&[u]));
        let law = TruncatedExponential::new(SIGMA_T, 3.0);
        let u_of = |distance| 1.0 - law.probability_beyond(distance);
        assert!(at(u_of(0.49)).is_none());
        let placed = at(u_of(0.9)).unwrap();
        assert!((placed.vertex.position.z - 0.9).abs() < 1e-12 && placed.vertex.surface().is_none());
        // Only 0.4 of the way is hazy.
        let expected = ALBEDO * SIGMA_T * (-0.4 * SIGMA_T).exp() / law.pdf_distance(0.9);
        assert!((placed.factor - expected).abs() < 1e-12);
        // Behind the medium the surface is certain, and the density says so.
        let surface = at(u_of(1.51)).unwrap();
        assert_eq!(surface.vertex.surface(), Some(1));
        let expected = REFLECTANCE * (-SIGMA_T).exp() / law.probability_beyond(1.5);
        assert!((surface.factor - expected).abs() < 1e-14);
    }
}
