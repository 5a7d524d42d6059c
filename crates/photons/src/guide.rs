//! Directions by photons (jensen-1995, antwerpen-2011 section 4.5).

use crate::PhotonMap;
use crate::tree::Near;
use fairflight_elementary::{atan2, sin_cos};
use fairflight_media::PhaseFunction;
use fairflight_paths::extend::{Extended, Extension, OwnShare};
use fairflight_paths::transport::{Lobe, Types, Vertex, World};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use glam::{DVec3, dvec3};
use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};
use std::num::NonZeroU32;

/// Parameters of [`Guided`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideOptions {
    /// Photons that a vertex asks.
    pub nearest: NonZeroU32,
    /// Cells of equal measure in which they are counted.
    pub cells: NonZeroU32,
    /// Share of the directions that are left to the vertex itself.
    pub own_share: OwnShare,
}

/// Directions from where photons came, mixed with those that a vertex chooses itself.
///
/// ```text
/// at a vertex: the n nearest photons, on surfaces or in the medium as the vertex itself is
///     cells of equal measure: of cosine · solid angle on a surface, of solid angle in the medium
///     h_c = share of cell c in power · BRDF or phase function of the photons that came from there
/// draw with q(ω) = α s(ω) + (1 − α) h_c(ω)/|c|, weight s/q
/// ```
///
/// **Law.** E\[weight · g(direction)\] = ∫ g s for every map, even of noise or of none: q is the density of what is drawn, and positive where s
/// is. Directions are compared with light points by q, too.
///
/// **Assumes** that the photons do not depend on the paths.
///
/// **Variance.** A weight is at most 1/α: a map that is good for nothing multiplies what a vertex adds to a second moment by no more. Without
/// photons (or of no power) directions are the vertex's own.
///
/// **Cost.** The search for n photons, and a phase function for each in the medium, at every vertex.
#[derive(Clone, Debug)]
pub struct Guided<'m, C> {
    map: &'m PhotonMap<C>,
    options: GuideOptions,
    columns: usize,
    found: BinaryHeap<Near>,
    /// Power of the photons of each cell, at the vertex that was turned to, and their sum.
    cells: Vec<f64>,
    total: f64,
    square: Square,
}

/// Map of directions to the unit square, under which a cell's share of the area is its share of the measure.
#[derive(Clone, Copy, Debug)]
struct Square {
    /// Two directions across the third.
    x: DVec3,
    y: DVec3,
    axis: DVec3,
    on_surface: bool,
}

impl Square {
    fn of(vertex: &Vertex) -> Self {
        match vertex.lobe {
            Lobe::Diffuse { normal, .. } => {
                let x = normal.any_orthonormal_vector();
                Self { x, y: normal.cross(x), axis: normal, on_surface: true }
            }
            Lobe::Phase { .. } => Self { x: DVec3::X, y: DVec3::Y, axis: DVec3::Z, on_surface: false },
        }
    }

    /// The direction of a point: cosine = √(1 − a) for the cosine's measure, 1 − 2a for that of the sphere.
    fn direction(&self, a: f64, b: f64) -> DVec3 {
        let (sine, cosine) = if self.on_surface {
            (a.sqrt(), (1.0 - a).sqrt())
        } else {
            (2.0 * (a * (1.0 - a)).sqrt(), 1.0 - 2.0 * a)
        };
        let (sin, cos) = sin_cos(TAU * b);
        sine * (cos * self.x + sin * self.y) + cosine * self.axis
    }

    /// The point of a direction.
    fn point(&self, direction: DVec3) -> (f64, f64) {
        let local = dvec3(direction.dot(self.x), direction.dot(self.y), direction.dot(self.axis));
        let a = if self.on_surface { local.x * local.x + local.y * local.y } else { 0.5 * (1.0 - local.z) };
        (a, atan2(local.y, local.x) / TAU + 0.5)
    }
}

impl<'m, C: Spectrum> Guided<'m, C> {
    /// Directions by the photons of `map`.
    #[must_use]
    pub fn new(map: &'m PhotonMap<C>, options: GuideOptions) -> Self {
        let cells = options.cells.get() as usize;
        // As near to a square as the number of cells has divisors.
        let rows = (1..=cells)
            .take_while(|rows| rows * rows <= cells)
            .filter(|&rows| cells.is_multiple_of(rows))
            .max();
        Self {
            map,
            options,
            columns: cells / rows.unwrap_or(1),
            found: BinaryHeap::with_capacity(options.nearest.get() as usize),
            cells: vec![0.0; cells],
            total: 0.0,
            square: Square { x: DVec3::X, y: DVec3::Y, axis: DVec3::Z, on_surface: false },
        }
    }

    fn rows(&self) -> usize {
        self.cells.len() / self.columns
    }

    fn cell(&self, direction: DVec3) -> usize {
        let (a, b) = self.square.point(direction);
        // The casts saturate: rounding beyond an edge belongs to the cell at it.
        let index = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
        index(a, self.rows()) * self.columns + index(b, self.columns)
    }

    /// A direction of the cell that `choice` falls into, in proportion to their power, uniform in its measure.
    fn in_a_cell(&self, choice: f64, u: f64, v: f64) -> DVec3 {
        let mut left = choice * self.total;
        let last = self.cells.iter().rposition(|&power| power > 0.0).unwrap_or(0);
        let cell = self.cells.iter().take(last).position(|&power| {
            left -= power;
            left < 0.0
        });
        let cell = cell.unwrap_or(last);
        let (row, column) = ((cell / self.columns) as f64, (cell % self.columns) as f64);
        let b = (column + v) / self.columns as f64;
        self.square.direction((row + u) / self.rows() as f64, b - 0.5)
    }
}

impl<W: Types> Extension<W> for Guided<'_, W::Spectrum> {
    fn prepare(&mut self, world: &World<'_, W>, vertex: &Vertex) {
        self.square = Square::of(vertex);
        self.cells.fill(0.0);
        self.total = 0.0;
        let on_surface = self.square.on_surface;
        let mut found = std::mem::take(&mut self.found);
        let nearest = self.options.nearest.get() as usize;
        self.map.nearest((vertex.position, on_surface), nearest, &mut found, |photon| {
            let towards = -photon.incident;
            let scattered = match vertex.lobe {
                // The BRDF is the same for all that come from its side.
                Lobe::Diffuse { normal, .. } => f64::from(u8::from(normal.dot(towards) > 0.0)),
                Lobe::Phase { incident } => world.volume.phase.eval(incident.dot(towards)),
            };
            let power = photon.power.magnitude() * scattered;
            let cell = self.cell(towards);
            self.cells[cell] += power;
            self.total += power;
        });
        self.found = found;
    }

    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        let phase = &world.volume.phase;
        let share = if self.total > 0.0 { self.options.own_share.get() } else { 1.0 };
        let [choice, u, v] = std::array::from_fn(|_| source.next_uniform());
        let direction = if choice < share {
            vertex.sample(phase, u, v)
        } else {
            self.in_a_cell((choice - share) / (1.0 - share), u, v)
        };
        let scattered = vertex.pdf_solid_angle(phase, direction);
        let pdf_solid_angle = Extension::<W>::pdf_solid_angle(self, vertex, direction, scattered);
        // Along a surface, where the cosine is 0, nothing is scattered.
        let weight = if scattered > 0.0 { scattered / pdf_solid_angle } else { 0.0 };
        Extended { direction, weight, pdf_solid_angle }
    }

    /// q = α s + (1 − α) h_c/|c|: a cell has the share 1/M of the cosine's measure π, in which s is the cosine over π, or of the sphere, 4π.
    fn pdf_solid_angle(&self, _vertex: &Vertex, direction: DVec3, scattered: f64) -> f64 {
        if self.total <= 0.0 {
            return scattered;
        }
        let share = self.options.own_share.get();
        let relative = self.cells[self.cell(direction)] / self.total * self.cells.len() as f64;
        let in_cell = if self.square.on_surface { scattered } else { 0.25 / PI };
        share * scattered + (1.0 - share) * relative * in_cell
    }
}
