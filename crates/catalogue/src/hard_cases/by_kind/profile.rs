//! A profile that knows all that an estimator or a sampler may ask for.

use crate::hard_cases::LAWFUL;
use crate::profiles::constant;
use fairflight_laws::DenseLattice;
use fairflight_media::{
    BoundCell, BoundedInCells, Breakpoints, Cells, Constant, Extinction, InvertOpticalThickness, Majorant,
    Minorant, OpticalThickness, PiecewiseConstant, Ray, Voxels,
};
use std::sync::Arc;

/// The extinction along the ray.
#[derive(Clone, Debug)]
enum Along {
    Constant(Constant),
    Steps(PiecewiseConstant),
    Voxels(Arc<Ray<Voxels<DenseLattice>>>),
    /// 0.5 on the first half of a length of 2, this on the second: what a broken medium returns.
    Faulty(f64),
}

/// σ_t along a ray, with the bounds that are claimed for it, one for all and in cells.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    along: Along,
    cells: Vec<BoundCell>,
    bounds: (f64, f64),
}

impl Profile {
    fn new(along: Along, cells: Vec<BoundCell>) -> Self {
        let bounds = cells.iter().fold((0.0_f64, 0.0_f64), |(least, most), cell| {
            (least.min(cell.minorant), most.max(cell.majorant))
        });
        Self { along, cells, bounds }
    }

    /// A constant σ_t in one cell of these bounds; no cell where the length is 0.
    pub(crate) fn constant(sigma_t: f64, length: f64, (minorant, majorant): (f64, f64)) -> Self {
        let cell = BoundCell { to: length, minorant, majorant };
        let cells = if length > 0.0 { vec![cell] } else { Vec::new() };
        Self::new(Along::Constant(constant(sigma_t, length)), cells)
    }

    /// Steps, each of which is a cell from 0 to its value; a negative one from that to its magnitude.
    pub(crate) fn steps(edges: &[f64], values: &[f64]) -> Self {
        let cell =
            |(&to, &value): (&f64, &f64)| BoundCell { to, minorant: value.min(0.0), majorant: value.abs() };
        let cells = edges[1..].iter().zip(values).map(cell).collect();
        let steps = PiecewiseConstant::new(edges.to_vec(), values.to_vec()).expect(LAWFUL);
        Self::new(Along::Steps(steps), cells)
    }

    /// A ray through voxels, in the cells of a grid.
    pub(crate) fn voxels(ray: Ray<Voxels<DenseLattice>>, cells: Vec<BoundCell>) -> Self {
        Self::new(Along::Voxels(Arc::new(ray)), cells)
    }

    /// Claims a majorant of 1, and returns `value` on its second half.
    pub(crate) fn faulty(value: f64) -> Self {
        Self::new(Along::Faulty(value), vec![BoundCell { to: 2.0, minorant: 0.0, majorant: 1.0 }])
    }

    /// The optical thickness of its one majorant \[1\].
    pub(crate) fn depth(&self) -> f64 {
        self.majorant() * self.length()
    }

    /// The optical thickness of the majorants of its cells \[1\].
    pub(crate) fn depth_in_cells(&self) -> f64 {
        self.rates(1.0).optical_thickness(0.0, self.length())
    }

    /// Ends of its cells.
    fn ends(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().map(|cell| cell.to)
    }

    /// Distances at which a law of what is drawn is not smooth: ends of cells, and the first mean free paths of the majorant, beyond which a dense
    /// profile lets nothing through.
    pub(crate) fn borders(&self) -> Vec<f64> {
        let paths = (0..12).map(|k| 3.0_f64.powi(k) / self.majorant());
        self.ends().chain(paths.filter(|&s| s < self.length())).collect()
    }

    /// True if σ_t lies between 0 and the majorant in the middle of each cell.
    pub(crate) fn keeps_its_bounds(&self) -> bool {
        let mut from = 0.0;
        self.cells.iter().all(|cell| {
            let middle = 0.5 * (std::mem::replace(&mut from, cell.to) + cell.to);
            (0.0..=cell.majorant).contains(&self.sigma_t(middle))
        })
    }

    /// A sampling extinction: `factor` times the majorant of each cell.
    pub(crate) fn rates(&self, factor: f64) -> Self {
        let values: Vec<f64> = self.cells.iter().map(|cell| factor * cell.majorant).collect();
        if values.is_empty() {
            return Self::constant(0.0, 0.0, (0.0, 0.0));
        }
        let edges: Vec<f64> = std::iter::once(0.0).chain(self.ends()).collect();
        Self::steps(&edges, &values)
    }
}

impl Extinction for Profile {
    fn sigma_t(&self, s: f64) -> f64 {
        match &self.along {
            Along::Constant(field) => field.sigma_t(s),
            Along::Steps(field) => field.sigma_t(s),
            Along::Voxels(field) => field.sigma_t(s),
            Along::Faulty(value) => {
                if s < 1.0 {
                    0.5
                } else {
                    *value
                }
            }
        }
    }
    fn length(&self) -> f64 {
        match &self.along {
            Along::Constant(field) => field.length(),
            Along::Steps(field) => field.length(),
            Along::Voxels(field) => field.length(),
            Along::Faulty(_) => 2.0,
        }
    }
}

impl BoundedInCells for Profile {
    fn bound_cells(&self) -> &[BoundCell] {
        &self.cells
    }
}

impl Majorant for Profile {
    fn majorant(&self) -> f64 {
        self.bounds.1
    }
}

impl Minorant for Profile {
    fn minorant(&self) -> f64 {
        self.bounds.0
    }
}

impl OpticalThickness for Profile {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        match &self.along {
            Along::Constant(field) => field.optical_thickness(from, to),
            Along::Steps(field) => field.optical_thickness(from, to),
            Along::Voxels(field) => field.optical_thickness(from, to),
            Along::Faulty(value) => {
                0.5 * (to.min(1.0) - from.min(1.0)) + value * (to.max(1.0) - from.max(1.0))
            }
        }
    }
}

impl InvertOpticalThickness for Profile {
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        match &self.along {
            Along::Constant(field) => field.invert(from, depth),
            Along::Steps(field) => field.invert(from, depth),
            // Found by no sampler that is tried there.
            Along::Voxels(_) | Along::Faulty(_) => None,
        }
    }
}

impl Breakpoints for Profile {
    fn breakpoints(&self) -> Vec<f64> {
        match &self.along {
            Along::Constant(field) => field.breakpoints(),
            Along::Steps(field) => field.breakpoints(),
            Along::Voxels(field) => field.breakpoints(),
            Along::Faulty(_) => vec![1.0],
        }
    }
}

impl Cells for Profile {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.breakpoints().into_iter()
    }
}
