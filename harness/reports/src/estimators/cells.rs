//! Grids of majorants and minorants: what they cost to build and to walk, and what they save.

use crate::run::Run;
use cpu_time::ThreadTime;
use fairflight_document::{Cell, Section, Table};
use fairflight_harness::Failure;
use fairflight_media::{
    AnalyticCosine, BoundCell, BoundGrid, Bounds, BoxBounds, Extinction, InCells, Lattice, Line, Majorant,
    Medium, MediumBreakpoints, Ray, RayQuadrature, Tolerance, Voxels,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::{ClosedForm, JitteredRatioInCells, ResidualCells, Theory};
use glam::{DAffine3, DVec3};
use std::hint::black_box;

/// Voxels a side of the large volume.
const SIDE: usize = 256;
/// Rays that are walked.
const RAYS: usize = 60;

pub(super) fn steps() -> u64 {
    2
}

/// Dense voxels of a smooth bump with noise on it.
struct Dense {
    values: Vec<f32>,
    side: usize,
    range: (f64, f64),
}

impl Dense {
    fn new(side: usize, seed: u64) -> Self {
        let mut source = Seeded::new(seed);
        let at = |i: usize| {
            let centred = |j: usize| 2.0 * j as f64 / (side - 1) as f64 - 1.0;
            let (x, y, z) = (centred(i / (side * side)), centred(i / side % side), centred(i % side));
            let bump = (1.0 - (x * x + y * y + z * z)).max(0.0);
            (bump * (0.5 + source.next_uniform())) as f32
        };
        let values: Vec<f32> = (0..side * side * side).map(at).collect();
        let range = values.iter().fold((0.0, 0.0), |(low, high): (f64, f64), &value| {
            (low.min(value.into()), high.max(value.into()))
        });
        Self { values, side, range }
    }

    fn voxel(&self, x: f64, y: f64, z: f64) -> f64 {
        let last = (self.side - 1) as f64;
        if [x, y, z].iter().any(|c| !(0.0..=last).contains(c)) {
            return 0.0;
        }
        f64::from(self.values[(x as usize * self.side + y as usize) * self.side + z as usize])
    }
}

impl Lattice for Dense {
    fn trilinear(&self, x: f64, y: f64, z: f64) -> f64 {
        let (i, j, k) = (x.floor(), y.floor(), z.floor());
        let (u, v, w) = (x - i, y - j, z - k);
        let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
        let along = |i: f64, j: f64| match w {
            0.0 => self.voxel(i, j, k),
            _ => mix(self.voxel(i, j, k), self.voxel(i, j, k + 1.0), w),
        };
        let across = |i: f64| if v == 0.0 { along(i, j) } else { mix(along(i, j), along(i, j + 1.0), v) };
        if u == 0.0 { across(i) } else { mix(across(i), across(i + 1.0), u) }
    }

    fn maximum(&self) -> f64 {
        self.range.1
    }

    fn minimum(&self) -> f64 {
        self.range.0
    }
}

/// A grid on a medium; costs are means over rays.
struct Row {
    medium: String,
    side: usize,
    /// Seconds.
    build: f64,
    bytes: usize,
    cells: f64,
    /// Seconds.
    walk: f64,
    /// Look-ups and the logarithm of the gain, of residual and of jittered ratio tracking.
    residual: [f64; 2],
    jittered: [f64; 2],
}

pub(super) fn study(run: &Run<'_>) -> Result<Section, Failure> {
    let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("cells: {error}"));
    let eq21 = AnalyticCosine::new(1.0).map_err(|error| refuse(&error))?;
    let sphere = AnalyticCosine::default_bounds();
    let mut rows = rows(run, "eq. 21", &eq21, &sphere, &[1, 8, 16, 32, 64, 128])?;
    run.advance();
    let side = run.quick_or(64, SIDE);
    // A cube of side 20, as thick as the sphere of eq. 21.
    let index_from_world = DAffine3::from_scale(DVec3::splat((side - 1) as f64 / 20.0));
    let voxels = Voxels::new(Dense::new(side, run.seed("cells/voxels")), index_from_world, 0.4)
        .map_err(|error| refuse(&error))?;
    let cube = Bounds::Box { min: DVec3::ZERO, max: DVec3::splat(20.0) };
    rows.extend(self::rows(run, &format!("{side}³ voxels"), &voxels, &cube, &[1, 8, 16, 32, 64])?);
    run.advance();
    let text = "The bounds of eq. 21 in a box are the product of the exact ranges of its two factors, those of voxels the range of all values that \
         are interpolated in it: exact. Tighter majorants alone lower the cost and raise the variance; with the minorant as control both \
         fall. Expressions and noise do not know their bounds and are refused.";
    let table = Table::of(
        [
            "cells-grids",
            "Grids of bounds",
            "Seconds on one core, memory of the grid, and its cells on random chords of the medium: their number (neighbours with the same bounds \
             are one), the time to find them, and what residual ratio tracking and jittered ratio tracking (ε = 0.25) cost with them, as closed \
             forms; the gain is that over ratio tracking with one majorant, the geometric mean over chords.",
        ],
        rows,
        &[
            ("medium", "", &|row| Cell::text(&*row.medium)),
            ("boxes a side", "1", &|row| Cell::Count(row.side as u64)),
            ("build", "s", &|row| Cell::Number(row.build)),
            ("memory", "MiB", &|row| Cell::Number(row.bytes as f64 / f64::from(1 << 20))),
            ("cells a ray", "1", &|row| Cell::Number(row.cells)),
            ("walk", "µs", &|row| Cell::Number(1e6 * row.walk)),
            ("residual: look-ups", "1", &|row| Cell::Number(row.residual[0])),
            ("gain", "1", &|row| Cell::Number(row.residual[1].exp())),
            ("jittered: look-ups", "1", &|row| Cell::Number(row.jittered[0])),
            ("gain", "1", &|row| Cell::Number(row.jittered[1].exp())),
        ],
    );
    Ok(Section::new("cells", "Majorants and minorants in cells").with(text).with(table))
}

/// A row for each number of boxes a side.
fn rows<M: BoxBounds + MediumBreakpoints>(
    run: &Run<'_>,
    name: &str,
    medium: &M,
    bounds: &Bounds,
    sides: &[usize],
) -> Result<Vec<Row>, Failure> {
    const ROUNDS: usize = 20;
    let rays = rays(run, medium, bounds)?;
    let corners = corners(medium, bounds);
    let row = |&side: &usize| {
        let clock = ThreadTime::now();
        let grid = BoundGrid::build(medium, corners, [side; 3])
            .map_err(|error| Failure::refused(format!("cells: {error}")))?;
        let build = clock.elapsed().as_secs_f64();
        let mut cells = Vec::new();
        let clock = ThreadTime::now();
        for ray in (0..ROUNDS).flat_map(|_| &rays) {
            grid.cells_along(ray.local_line(), ray.length(), &mut cells);
            black_box(&cells);
        }
        let walk = clock.elapsed().as_secs_f64() / (ROUNDS * rays.len()) as f64;
        let (medium, bytes) = (name.to_owned(), grid.bytes());
        let mut row =
            Row { medium, side, build, bytes, walk, cells: 0.0, residual: [0.0; 2], jittered: [0.0; 2] };
        for ray in &rays {
            grid.cells_along(ray.local_line(), ray.length(), &mut cells);
            let [residual, jittered, ratio] = theories(ray, &cells);
            let log_price =
                |theory: &Theory| theory.log_relative_variance.max(-60.0) + theory.lookups.max(1.0).ln();
            let baseline = ratio.log_relative_variance + ratio.lookups.ln();
            let share = 1.0 / rays.len() as f64;
            row.cells += share * cells.len() as f64;
            for (sums, theory) in [(&mut row.residual, residual), (&mut row.jittered, jittered)] {
                sums[0] += share * theory.lookups;
                sums[1] += share * (baseline - log_price(&theory));
            }
        }
        Ok(row)
    };
    sides.iter().map(row).collect()
}

/// Chords between two random points on the surface of the bounds' box or sphere.
fn rays<'m, M: Medium>(run: &Run<'_>, medium: &'m M, bounds: &Bounds) -> Result<Vec<Ray<&'m M>>, Failure> {
    let (centre, radius) = match *bounds {
        Bounds::Sphere { center, radius } => (center, radius),
        Bounds::Box { min, max } => (0.5 * (min + max), 0.5 * (max - min).max_element()),
    };
    let mut source = Seeded::new(run.seed("cells/chords"));
    let mut point = || loop {
        let p = DVec3::from_array(std::array::from_fn(|_| 2.0 * source.next_uniform() - 1.0));
        if (0.01..=1.0).contains(&p.length()) {
            return centre + radius * p.normalize();
        }
    };
    let count = run.quick_or(12, RAYS);
    let mut rays = Vec::new();
    while rays.len() < count {
        let (from, to) = (point(), point());
        let clip = bounds
            .clip(from, to - from, Some((to - from).length()))
            .map_err(|error| Failure::refused(format!("cells: {error}")))?;
        if let Some(clip) = clip.filter(|clip| clip.length > 0.2 * radius) {
            rays.push(Ray::new(medium, &clip));
        }
    }
    Ok(rays)
}

/// Residual ratio tracking and jittered ratio tracking in `cells`, and ratio tracking with one majorant.
fn theories<M: MediumBreakpoints>(ray: &Ray<&M>, cells: &[BoundCell]) -> [Theory; 3] {
    let tolerance = Tolerance::to(1e-6);
    let mut quadrature = RayQuadrature::new(ray, &cells.iter().map(|cell| cell.to).collect::<Vec<_>>());
    let tau = quadrature.integrate(tolerance, |_, sigma_t| [sigma_t]).value[0];
    let residual = ResidualCells::new(1.0).expect("a rate of 1 is positive");
    let jittered = JitteredRatioInCells::new(0.25).expect("0.25 is positive and at most 1");
    let whole = [BoundCell { to: ray.length(), minorant: 0.0, majorant: ray.majorant() }];
    let of = |estimator: &dyn Fn(&mut Fenced<'_, M>) -> Theory, cells| {
        let field = InCells::new(ray, cells).expect("a grid's cells cover the ray");
        estimator(&mut quadrature.with_field(field))
    };
    [
        of(&|quadrature| residual.theory(quadrature, tau, tolerance), cells),
        of(&|quadrature| jittered.theory(quadrature, tau, tolerance), cells),
        of(&|quadrature| residual.theory(quadrature, tau, tolerance), &whole),
    ]
}

/// A ray in cells, with its quadrature.
type Fenced<'a, M> = RayQuadrature<InCells<&'a Ray<&'a M>, &'a [BoundCell]>>;

/// The corners of the bounds in the medium's own coordinates, whose axes are those of the world.
fn corners<M: Medium>(medium: &M, bounds: &Bounds) -> (DVec3, DVec3) {
    let local = |point| medium.local(Line { origin: point, direction: DVec3::X }).origin;
    let (min, max) = bounds.corners();
    let (min, max) = (local(min), local(max));
    (min.min(max), min.max(max))
}
