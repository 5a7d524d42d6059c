//! Cases of the test vectors, as estimators and wrong twins replay them.

use fairflight_freeflight::Flight;
use fairflight_freeflight::spectral::SpectralFlight;
use fairflight_media::{
    BoundCell, Bounded, BoundedInCells, Cells, Constant, Extinction, InvertOpticalThickness, Majorant,
    OpticalThickness, PiecewiseConstant, PiecewiseLinear, Scaled,
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

impl Vector<'_> {
    /// The profile of a case of this kind.
    pub(crate) fn of(&self, kind: &str) -> Option<&Seen> {
        self.field.filter(|_| self.kind == kind)
    }

    /// A parameter of the estimator.
    pub(crate) fn estimator(&self, key: &str) -> Option<f64> {
        (self.number)(&format!("/estimator/{key}"))
    }

    /// A parameter of the sampler.
    pub(crate) fn sampler(&self, key: &str) -> Option<f64> {
        (self.number)(&format!("/sampler/{key}"))
    }

    /// Numbers of the case by the path of their list.
    pub(crate) fn numbers(&self, path: &str) -> Vec<f64> {
        (0..).map_while(|i| (self.number)(&format!("{path}/{i}"))).collect()
    }

    /// Profile, constant sampling extinction and constant control of a case of tracking of this kind.
    pub(crate) fn tracked(&self, kind: &str) -> Option<(&Seen, Constant, Constant)> {
        let field = self.of(kind)?;
        let constant = |sigma_t: f64| Constant::new(sigma_t, field.length()).ok();
        let control = ["control/sigma_main", "control/sigma_t"].iter().find_map(|key| self.estimator(key));
        Some((field, constant(self.estimator("sigma_samp")?)?, constant(control.unwrap_or(0.0))?))
    }

    /// Rates in cells, by the path of their edges and values.
    pub(crate) fn rates(&self, path: &str) -> Option<PiecewiseConstant> {
        let [edges, values] = ["edges", "values"].map(|key| self.numbers(&format!("{path}/{key}")));
        PiecewiseConstant::new(edges, values).ok()
    }

    /// The profile with the majorant that the estimator claims.
    pub(crate) fn bounded(&self, kind: &str) -> Option<Bounded<&Seen>> {
        Bounded::new(self.of(kind)?, self.estimator("majorant")?).ok()
    }

    /// The answer of a flight on the profile of the case.
    pub(crate) fn flown(&self, flight: Flight) -> Option<Answer> {
        let (length, distance) = (self.field?.length(), flight.distance());
        let values = vec![distance.unwrap_or(length), flight.weight()];
        Some(Answer { values, collided: Some(distance.is_some()) })
    }

    /// The answer of a flight for several wavelengths on the profile of the case.
    pub(crate) fn flown_together<const N: usize>(&self, flight: &SpectralFlight<N>) -> Option<Answer> {
        let mut answer = self.flown(flight.of(0))?;
        answer.values.splice(1.., flight.weights());
        Some(answer)
    }

    /// The profile times the coefficients of three wavelengths.
    pub(crate) fn spectrum(&self, kind: &str) -> Option<Scaled<&Seen, 3>> {
        let coefficients = self.numbers("/coefficients").try_into().ok()?;
        Scaled::new(self.of(kind)?, coefficients).ok()
    }
}

type Answering = dyn Fn(&Vector<'_>, &mut Variates<'_>) -> Option<Answer> + Send + Sync;

/// Answers of a wrong twin to cases. To a reader of a debug print it is a function.
pub(crate) struct Replay(Box<Answering>);

impl Replay {
    pub(crate) fn new(
        answer: impl Fn(&Vector<'_>, &mut Variates<'_>) -> Option<Answer> + Send + Sync + 'static,
    ) -> Self {
        Self(Box::new(answer))
    }

    pub(crate) fn answer(&self, vector: &Vector<'_>, source: &mut Variates<'_>) -> Option<Answer> {
        (self.0)(vector, source)
    }
}

impl fmt::Debug for Replay {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Fn(Vector)")
    }
}
