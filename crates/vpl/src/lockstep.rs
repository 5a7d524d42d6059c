//! Connections of a vertex with sixteen virtual point lights at a time: the twin of `Gather::one` where transmittance has a closed form.
//!
//! The law of this module is equality, bit for bit; its theory is that of [`Gather`]. Surfaces in the way are asked for one connection after the other.

use crate::gather::connection;
use crate::{Gather, Term, Vpl};
use fairflight_elementary::lanes::{self, LANES, Lanes};
use fairflight_elementary::{InstructionSet, LaneWork};
use fairflight_media::PhaseFunction;
use fairflight_media::lanes::{points, set_vector, splat, vector};
use fairflight_paths::RayTransmittance;
use fairflight_paths::transport::{Lobe, Types, Vertex};
use fairflight_scene::{Geometry, Spectrum};
use fairflight_sources::UniformSource;
use std::f64::consts::FRAC_1_PI;

/// Ends of connections, by lane: what is read of virtual point lights.
struct Ends {
    positions: [Lanes; 3],
    /// Normals on surfaces, and the directions in which the light arrived in the medium.
    axes: [Lanes; 3],
    on_surface: [bool; LANES],
}

impl Ends {
    #[inline(always)]
    fn of<C>(vpls: &[Vpl<C>]) -> Self {
        let none = [[0.0; LANES]; 3];
        let mut ends = Self { positions: none, axes: none, on_surface: [false; LANES] };
        for (i, vpl) in vpls.iter().enumerate() {
            let (axis, on_surface) = match vpl.vertex.lobe {
                Lobe::Diffuse { normal, .. } => (normal, true),
                Lobe::Phase { incident } => (incident, false),
            };
            set_vector(&mut ends.positions, i, vpl.vertex.position);
            set_vector(&mut ends.axes, i, axis);
            ends.on_surface[i] = on_surface;
        }
        ends
    }
}

/// Connections of a vertex in lanes.
struct Connections {
    directions: [Lanes; 3],
    distances: Lanes,
    /// Parts of the geometric terms \[1/length²\]; 0 where nothing is added.
    terms: Lanes,
    /// Values of both scattering functions, multiplied \[1/sr²\].
    scattering: Lanes,
}

impl Connections {
    #[inline(always)]
    fn of(y: &Vertex, ends: &Ends, term: Term, phase: &impl PhaseFunction) -> Self {
        let (mut directions, mut distances) = ([[0.0; LANES]; 3], [0.0; LANES]);
        let (mut squares, mut of_y, mut of_ends) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let y_axis = match y.lobe {
            Lobe::Diffuse { normal, .. } => normal,
            Lobe::Phase { incident } => incident,
        };
        for i in 0..LANES {
            let offset = vector(&ends.positions, i) - y.position;
            squares[i] = offset.length_squared();
            distances[i] = squares[i].sqrt();
            let direction = offset / distances[i];
            set_vector(&mut directions, i, direction);
            of_y[i] = y_axis.dot(direction);
            of_ends[i] = vector(&ends.axes, i).dot(-direction);
        }
        let (phase_of_ends, y_on_surface) = (phase.eval_lanes(&of_ends), y.surface().is_some());
        let phase_of_y = if y_on_surface { [FRAC_1_PI; LANES] } else { phase.eval_lanes(&of_y) };
        let (mut terms, mut scattering) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let y_cosine = if y_on_surface { of_y[i].max(0.0) } else { 1.0 };
            let end_cosine = if ends.on_surface[i] { of_ends[i].max(0.0) } else { 1.0 };
            let of_term = term.of(y_cosine * end_cosine / squares[i]);
            // A light at the vertex itself has no direction.
            terms[i] = if squares[i] == 0.0 { 0.0 } else { of_term };
            scattering[i] = phase_of_y[i] * if ends.on_surface[i] { FRAC_1_PI } else { phase_of_ends[i] };
        }
        Self { directions, distances, terms, scattering }
    }
}

impl<W: Types> Gather<'_, W> {
    /// The contribution of all virtual point lights, the sum of [`one`](Self::one) over them in their order: where transmittance has a closed form in lanes, by an
    /// instruction set, with the same bits on all.
    pub fn all_by(
        &mut self,
        set: InstructionSet,
        y: &Vertex,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let volume = self.world.volume;
        match self.shadow.everywhere(&volume.medium) {
            Some(sigma_t) if !self.vpls.is_empty() && volume.bounds.contains(y.position) => {
                set.run(All { gather: self, y, sigma_t, source })
            }
            _ => self.one_after_the_other(y, source),
        }
    }

    fn one_after_the_other(&mut self, y: &Vertex, source: &mut impl UniformSource) -> W::Spectrum {
        let mut sum = W::Spectrum::ZERO;
        for index in 0..self.vpls.len() {
            sum += self.one(y, index, source);
        }
        sum
    }
}

/// Work of [`Gather::all_by`].
struct All<'a, 's, W: Types, S> {
    gather: &'a mut Gather<'s, W>,
    y: &'a Vertex,
    sigma_t: f64,
    source: &'a mut S,
}

impl<W: Types, S: UniformSource> LaneWork for All<'_, '_, W, S> {
    type Output = W::Spectrum;

    #[inline(always)]
    fn run(self) -> W::Spectrum {
        let Self { gather, y, sigma_t, source } = self;
        let (world, vpls) = (gather.world, gather.vpls);
        let mut sum = W::Spectrum::ZERO;
        for (chunk, some) in vpls.chunks(LANES).enumerate() {
            let mut found = Connections::of(y, &Ends::of(some), gather.term, &world.volume.phase);
            if !W::Geometry::IS_EMPTY {
                for (i, vpl) in some.iter().enumerate() {
                    if found.terms[i] == 0.0 {
                        continue;
                    }
                    let direction = vector(&found.directions, i);
                    let segment = connection(y, &vpl.vertex, direction, found.distances[i]);
                    if gather.is_on_one_plane(&segment) || world.surfaces.is_occluded(&segment) {
                        found.terms[i] = 0.0;
                    }
                }
            }
            let ends = points(&splat(y.position), &found.directions, &found.distances);
            let is_inside = world.volume.bounds.contains_lanes(&ends);
            let transmittance = lanes::exp(&found.distances.map(|distance| -(sigma_t * distance)));
            for (i, vpl) in some.iter().enumerate() {
                if found.terms[i] == 0.0 {
                    continue;
                }
                // An end that is rounded out of the bounds, or lies there, needs the part of the segment inside them.
                sum += if is_inside[i] {
                    vpl.power * (found.scattering[i] * found.terms[i] * transmittance[i])
                } else {
                    gather.one(y, chunk * LANES + i, source)
                };
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{Scene, ball, diffuse, hazy, in_medium, on_surface, square, vpl};
    use fairflight_media::Homogeneous;
    use fairflight_sources::{Scripted, Seeded};
    use glam::{DVec3, dvec3};

    /// Lights on the floor, on a ball, in the haze and outside of its bounds, one of them at the first vertex.
    fn vpls(source: &mut Seeded) -> Vec<Vpl<f64>> {
        let mut next = || 2.0 * source.next_uniform() - 1.0;
        let mut vpls = Vec::new();
        for i in 0..75 {
            let axis = dvec3(next(), next(), next()).normalize();
            let place = 4.0 * dvec3(next(), next(), next());
            let vertex = match i % 5 {
                0 => on_surface(dvec3(place.x, place.y, 0.0), DVec3::Z, 0),
                1 => on_surface(3.0 * DVec3::Z + axis, axis, 1),
                2 => in_medium(3.0 * place, axis),
                _ => in_medium(place, axis),
            };
            vpls.push(vpl(vertex, 1.0 + next()));
        }
        vpls
    }

    fn is_the_same(scene: &Scene<Homogeneous, f64>) {
        let source = &mut Seeded::new(5);
        let all = vpls(source);
        let mut ys = vec![all[3].vertex, all[0].vertex, all[1].vertex, in_medium(11.0 * DVec3::X, DVec3::Y)];
        ys.extend(vpls(source).iter().map(|vpl| vpl.vertex));
        for term in [Term::Bounded(f64::INFINITY), Term::Bounded(0.3), Term::Excess(0.1)] {
            for count in [0, 1, 15, 16, 17, 75] {
                let mut gather = scene.gather(&all[..count], term);
                for y in &ys {
                    let none = &mut Scripted::new([]);
                    let expected = gather.one_after_the_other(y, none);
                    for set in InstructionSet::of_this_machine() {
                        let found = gather.all_by(set, y, none);
                        assert_eq!(found.to_bits(), expected.to_bits(), "{}, {count}: {y:?}", set.name());
                    }
                }
            }
        }
    }

    #[test]
    fn all_lights_are_those_of_one_after_the_other() {
        is_the_same(&hazy(vec![], vec![]));
        let globe = ball(3.0 * DVec3::Z, 1.0, diffuse(0.5), 0.0);
        is_the_same(&hazy(vec![square(0.0, 5.0, diffuse(0.5), 0.0), globe], vec![]));
    }

    /// A twin that sums lane by lane adds the same numbers in another order.
    #[test]
    fn the_order_of_lights_decides_bits() {
        let scene = hazy(vec![], vec![]);
        let all = vpls(&mut Seeded::new(5));
        let mut gather = scene.gather(&all, Term::Bounded(1.0));
        let none = &mut Scripted::new([]);
        let mut differ = 0;
        for step in 0..10 {
            let y = in_medium(0.3 * f64::from(step) * DVec3::ONE, DVec3::X);
            let mut sums = [0.0; LANES];
            for index in 0..all.len() {
                sums[index % LANES] += gather.one(&y, index, none);
            }
            let (lane_by_lane, found) =
                (sums.iter().sum::<f64>(), gather.all_by(InstructionSet::widest(), &y, none));
            assert!((lane_by_lane / found - 1.0).abs() < 1e-14);
            differ += u32::from(lane_by_lane.to_bits() != found.to_bits());
        }
        assert!(differ > 0);
    }
}
