//! The surfaces of a scene that has some.

use super::{Geometry, Hit, Segment, Surface};
use crate::Spectrum;
use glam::DVec3;

/// A handful of surfaces, tried one by one.
///
/// Surfaces that share an edge let nothing through. Surfaces that lie in one another have no order: which is met first is left
/// to rounding, so that a light is to be put before a wall and not into it.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces<C> {
    all: Vec<Surface<C>>,
    emitters: Vec<usize>,
    has_specular: bool,
}

impl<C: Spectrum> Surfaces<C> {
    /// The surfaces of a scene, in this order.
    #[must_use]
    pub fn new(all: Vec<Surface<C>>) -> Self {
        let emitters = (0..all.len()).filter(|&i| all[i].emits()).collect();
        let has_specular = all.iter().any(Surface::is_specular);
        Self { all, emitters, has_specular }
    }
}

impl<C: Spectrum> Surfaces<C> {
    /// The nearest of the surfaces whose index is wanted.
    #[inline]
    fn nearest(&self, segment: &Segment, wanted: impl Fn(usize) -> bool) -> Option<Hit<'_, C>> {
        let mut length = segment.length;
        let mut nearest = None;
        for (index, surface) in self.all.iter().enumerate() {
            if !wanted(index) {
                continue;
            }
            let leaves = segment.from == Some(index);
            if let Some(distance) = surface.shape.intersect(&segment.line, length, leaves) {
                length = distance;
                nearest = Some(index);
            }
        }
        let index = nearest?;
        let surface = &self.all[index];
        let position = segment.line.at(length);
        let outer = surface.shape.normal(position);
        let outside = segment.line.direction.dot(outer) < 0.0;
        let normal = if outside { outer } else { -outer };
        Some(Hit { distance: length, position, normal, outside, index, surface })
    }
}

/// The bit of a surface.
fn bit(index: usize) -> u64 {
    1 << index.min(63)
}

impl<C: Spectrum> Geometry<C> for Surfaces<C> {
    const IS_EMPTY: bool = false;

    fn surfaces(&self) -> &[Surface<C>] {
        &self.all
    }
    fn emitters(&self) -> &[usize] {
        &self.emitters
    }
    fn has_specular(&self) -> bool {
        self.has_specular
    }
    #[inline]
    fn intersect(&self, segment: &Segment) -> Option<Hit<'_, C>> {
        self.nearest(segment, |_| true)
    }
    fn reaching(&self, center: DVec3, radius: f64) -> u64 {
        let near = self.all.iter().enumerate().filter(|(_, surface)| surface.shape.reaches(center, radius));
        near.fold(0, |bits, (index, _)| bits | bit(index))
    }
    #[inline]
    fn intersect_among(&self, segment: &Segment, among: u64) -> Option<Hit<'_, C>> {
        self.nearest(segment, |index| among & bit(index) != 0)
    }
    #[inline]
    fn is_occluded(&self, segment: &Segment) -> bool {
        let Segment { ref line, length, from, to } = *segment;
        self.all.iter().enumerate().any(|(index, surface)| {
            let leaves = from == Some(index);
            if to == Some(index) {
                surface.shape.blocks_its_own_point(line, length, leaves)
            } else {
                surface.shape.intersect(line, length, leaves).is_some()
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cosine_hemisphere;
    use crate::surface::{Material, NoSurfaces, Rectangle, Shape, Sphere};
    use crate::variates::Variates;
    use fairflight_media::Line;
    use glam::{DQuat, dvec3};

    const GRAY: Material<f64> = Material::Diffuse { reflectance: 0.5 };

    fn surfaces(shapes: &[Shape]) -> Surfaces<f64> {
        Surfaces::new(shapes.iter().map(|&shape| Surface::new(shape, GRAY, 0.0).unwrap()).collect())
    }

    /// Six faces of a box, with the outer side inwards.
    fn room(corner: DVec3, [x, y, z]: [DVec3; 3]) -> Vec<Shape> {
        let far = corner + x + y + z;
        [(corner, x, y), (corner, y, z), (corner, z, x), (far, -y, -x), (far, -z, -y), (far, -x, -z)]
            .map(|(at, u, v)| Shape::Rectangle(Rectangle::new(at, u, v).unwrap()))
            .to_vec()
    }

    fn between(from: (DVec3, Option<usize>), to: (DVec3, Option<usize>)) -> Segment {
        let offset = to.0 - from.0;
        let line = Line { origin: from.0, direction: offset.normalize() };
        Segment { line, length: offset.length(), from: from.1, to: to.1 }
    }

    #[test]
    fn nothing_escapes_from_a_closed_room() {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0);
        let straight = [2.0 * DVec3::X, 3.0 * DVec3::Y, DVec3::Z];
        let turned = straight.map(|edge| turn * edge);
        let skew = [dvec3(2.0, 0.3, 0.0), dvec3(-0.5, 3.0, 0.2), dvec3(0.1, 0.4, 1.0)];
        let far = dvec3(1e3, -2e4, 3e2);
        let mut escaped = 0;
        for (corner, edges) in [(DVec3::ZERO, straight), (-DVec3::ONE, turned), (far, skew)] {
            let shapes = room(corner, edges);
            let room = surfaces(&shapes);
            let mut next = Variates::new(41);
            for (face, shape) in shapes.iter().enumerate() {
                for _ in 0..3000 {
                    // Ten reflections of every ray.
                    let start = shape.sample_area(next.draw(), next.draw());
                    let (mut origin, mut normal, mut from) = (start.position, start.normal, face);
                    for _ in 0..10 {
                        let direction = cosine_hemisphere(normal, next.draw(), next.draw());
                        let line = Line { origin, direction };
                        let segment = Segment { line, length: f64::INFINITY, from: Some(from), to: None };
                        let Some(hit) = room.intersect(&segment) else {
                            escaped += 1;
                            break;
                        };
                        assert!(hit.outside && hit.index != from && hit.distance > 0.0);
                        assert!(hit.normal.dot(direction) < 0.0);
                        // A convex room: what is met is seen.
                        assert!(!room.is_occluded(&Segment {
                            length: hit.distance,
                            to: Some(hit.index),
                            ..segment
                        }));
                        assert!(room.is_occluded(&segment));
                        (origin, normal, from) = (hit.position, hit.normal, hit.index);
                    }
                }
            }
        }
        assert_eq!(escaped, 0);
    }

    #[test]
    fn points_on_all_pairs_of_faces_see_each_other() {
        let shapes = room(DVec3::ONE, [2.0 * DVec3::X, 3.0 * DVec3::Y, DVec3::Z]);
        let room = surfaces(&shapes);
        let mut next = Variates::new(42);
        for _ in 0..500 {
            for (i, a) in shapes.iter().enumerate() {
                for (j, b) in shapes.iter().enumerate() {
                    let from = a.sample_area(next.draw(), next.draw()).position;
                    let to = b.sample_area(next.draw(), next.draw()).position;
                    assert!(!room.is_occluded(&between((from, Some(i)), (to, Some(j)))), "{i} {j}");
                    assert!(!room.is_occluded(&between((to, Some(j)), (from, Some(i)))), "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn a_sphere_in_the_way_and_its_own_points() {
        let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
        let mut shapes = room(DVec3::splat(-2.0), [4.0 * DVec3::X, 4.0 * DVec3::Y, 4.0 * DVec3::Z]);
        shapes.push(ball);
        let scene = surfaces(&shapes);
        let on_wall = |y| (dvec3(-2.0, y, 0.0), Some(1));
        assert!(scene.is_occluded(&between(on_wall(0.0), (dvec3(2.0, 0.0, 0.0), Some(4)))));
        assert!(!scene.is_occluded(&between(on_wall(1.5), (dvec3(2.0, 1.5, 0.0), Some(4)))));
        let [front, back] = [DVec3::NEG_X, DVec3::X].map(|at| (at, Some(6)));
        assert!(!scene.is_occluded(&between(on_wall(0.0), front)));
        assert!(!scene.is_occluded(&between(front, on_wall(0.0))));
        assert!(scene.is_occluded(&between(on_wall(0.0), back)));
        assert!(scene.is_occluded(&between(back, on_wall(0.0))));
        // Two points of the sphere, through its inside.
        assert!(!scene.is_occluded(&between(front, back)));
        assert!(!scene.is_occluded(&between(back, front)));
        assert!(!scene.is_occluded(&between((DVec3::ZERO, None), back)));
        // A point in space behind it, and one before it.
        assert!(scene.is_occluded(&between(on_wall(0.0), (dvec3(1.5, 0.0, 0.0), None))));
        assert!(!scene.is_occluded(&between(on_wall(0.0), (dvec3(-1.5, 0.0, 0.0), None))));
    }

    #[test]
    fn the_nearest_of_many_with_its_side() {
        let ball = |z| Shape::Sphere(Sphere::new(dvec3(0.0, 0.0, z), 1.0).unwrap());
        let scene = surfaces(&[ball(9.0), ball(3.0), ball(6.0)]);
        let line = Line { origin: DVec3::ZERO, direction: DVec3::Z };
        let mut segment = Segment { line, length: f64::INFINITY, from: None, to: None };
        let mut seen = Vec::new();
        while let Some(hit) = scene.intersect(&segment) {
            seen.push((hit.index, hit.position.z, hit.outside));
            assert_eq!(hit.normal, DVec3::NEG_Z);
            assert_eq!(hit.surface, &scene.surfaces()[hit.index]);
            let line = Line { origin: hit.position, direction: DVec3::Z };
            segment = Segment { line, from: Some(hit.index), ..segment };
        }
        let crossings = [(1, 2.0, true), (1, 4.0, false), (2, 5.0, true), (2, 7.0, false)];
        assert_eq!(seen, [&crossings[..], &[(0, 8.0, true), (0, 10.0, false)]].concat());
        assert!(scene.intersect(&Segment { line, length: 2.0, from: None, to: None }).is_none());
    }

    #[test]
    fn among_those_that_reach_a_ball_the_nearest_in_it_is_found() {
        // More than have a bit of their own, in a row.
        let balls: Vec<_> =
            (0..80).map(|i| Shape::Sphere(Sphere::new(f64::from(i) * DVec3::X, 0.25).unwrap())).collect();
        let scene = surfaces(&balls);
        assert_eq!(scene.reaching(dvec3(2.5, 0.0, 0.0), 0.3), 0b1100);
        assert_eq!(scene.reaching(dvec3(0.0, 5.0, 0.0), 4.0), 0);
        assert_eq!(scene.reaching(dvec3(70.0, 0.0, 0.0), 0.5), 1 << 63);
        let mut next = Variates::new(43);
        let mut met = 0;
        for _ in 0..20_000 {
            let origin = dvec3(80.0 * next.draw(), next.draw(), 0.0);
            let direction = dvec3(next.draw() - 0.5, -next.draw(), 0.0).normalize();
            let radius = 2.0 * next.draw();
            let segment = Segment { line: Line { origin, direction }, length: radius, from: None, to: None };
            let among = scene.reaching(origin, radius);
            let found = scene.intersect_among(&segment, among);
            assert_eq!(found, scene.intersect(&segment));
            met += usize::from(found.is_some());
        }
        assert!(met > 2000, "{met}");
    }

    #[test]
    fn surfaces_know_their_lights_and_whether_one_is_specular() {
        let shape = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
        let dark = Surface::new(shape, GRAY, 0.0).unwrap();
        let light = Surface::new(shape, GRAY, 2.0).unwrap();
        let mirror = Surface::new(shape, Material::Mirror, 0.0).unwrap();
        let scene = Surfaces::new(vec![dark, light, dark, light]);
        assert_eq!((scene.emitters(), scene.has_specular()), (&[1, 3][..], false));
        assert!(Surfaces::new(vec![dark, mirror]).has_specular());
        assert!(Geometry::<f64>::surfaces(&NoSurfaces).is_empty());
    }
}
