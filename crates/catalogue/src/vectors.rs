//! Cases of the test vectors, as estimators and wrong twins replay them.

use fairflight_media::{
    BoundCell, BoundedInCells, Cells, Extinction, InvertOpticalThickness, Majorant, OpticalThickness,
    PiecewiseLinear,
};
use fairflight_sources::UniformSource;
use std::cell::RefCell;
use std::fmt;

/// A variate of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variate {
    /// u \[1\]; 1/2 for an exponential that no variate has.
    pub uniform: f64,
    /// −ln(1 − u), where it is used as an exponential \[1\].
    pub exponential: Option<f64>,
}

/// The variates of a case, in order: a source that remembers what they were used for. Behind the last all are 1/2.
#[derive(Clone, Debug)]
pub struct Variates<'a> {
    variates: &'a [Variate],
    are_exponential: Vec<bool>,
}

impl<'a> Variates<'a> {
    /// A source of these.
    #[must_use]
    pub fn new(variates: &'a [Variate]) -> Self {
        Self { variates, are_exponential: Vec::new() }
    }

    /// The number of variates drawn.
    #[must_use]
    pub fn drawn(&self) -> usize {
        self.are_exponential.len()
    }

    /// True if so many were drawn as there are, each for its use.
    #[must_use]
    pub fn is_used_up(&self) -> bool {
        self.are_exponential.iter().copied().eq(self.variates.iter().map(|v| v.exponential.is_some()))
    }

    fn next(&mut self, is_exponential: bool) -> Variate {
        let next = self.variates.get(self.drawn()).copied();
        self.are_exponential.push(is_exponential);
        next.unwrap_or(Variate { uniform: 0.5, exponential: None })
    }
}

impl UniformSource for Variates<'_> {
    fn next_uniform(&mut self) -> f64 {
        self.next(false).uniform
    }

    fn next_exponential(&mut self) -> f64 {
        let Variate { uniform, exponential } = self.next(true);
        exponential.unwrap_or_else(|| -(1.0 - uniform).ln())
    }
}

/// The profile of a case, which remembers where it was looked up.
#[derive(Debug)]
pub struct Seen {
    profile: PiecewiseLinear,
    cells: Vec<BoundCell>,
    lookups: RefCell<Vec<f64>>,
}

impl Seen {
    /// A profile with bounds in cells, of which there may be none.
    #[must_use]
    pub fn new(profile: PiecewiseLinear, cells: Vec<BoundCell>) -> Self {
        Self { profile, cells, lookups: RefCell::default() }
    }

    /// Distances of look-ups so far \[length\].
    #[must_use]
    pub fn lookups(&self) -> Vec<f64> {
        self.lookups.borrow().clone()
    }
}

impl Extinction for Seen {
    fn sigma_t(&self, s: f64) -> f64 {
        self.lookups.borrow_mut().push(s);
        self.profile.sigma_t(s)
    }
    fn length(&self) -> f64 {
        self.profile.length()
    }
}

impl Majorant for Seen {
    fn majorant(&self) -> f64 {
        self.profile.majorant()
    }
}

impl OpticalThickness for Seen {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        self.profile.optical_thickness(from, to)
    }
}

impl InvertOpticalThickness for Seen {
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        self.profile.invert(from, depth)
    }
}

impl Cells for Seen {
    fn borders(&self) -> impl Iterator<Item = f64> {
        self.profile.borders()
    }
}

impl BoundedInCells for Seen {
    fn bound_cells(&self) -> &[BoundCell] {
        &self.cells
    }
}

/// A case: its kind, its numbers, its profile.
pub struct Vector<'a> {
    /// Kind of estimator, sampler, phase function or collision model.
    pub kind: &'a str,
    /// A number of the case by its path, as "/estimator/sigma_samp"; of truth values 1 and 0.
    pub number: &'a dyn Fn(&str) -> Option<f64>,
    /// A word of the case by its path.
    pub word: &'a dyn Fn(&str) -> Option<&'a str>,
    /// Its profile, where it has one.
    pub field: Option<&'a Seen>,
}

impl fmt::Debug for Vector<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Vector").field("kind", &self.kind).finish_non_exhaustive()
    }
}

/// An answer to a case: its values, and for flights true if it collided.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The values, in the order of the kind.
    pub values: Vec<f64>,
    /// True for a flight that collided, false for one that escaped.
    pub collided: Option<bool>,
}

impl From<f64> for Answer {
    fn from(value: f64) -> Self {
        Self { values: vec![value], collided: None }
    }
}
