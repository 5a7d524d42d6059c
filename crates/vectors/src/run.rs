//! One run of an estimator over one arithmetic, and all that it did.

use crate::number::Number;
use crate::{Arithmetic, Profile, Script};

/// Use of a variate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// As it is.
    Uniform,
    /// Its exponential.
    Exponential,
}

/// Outcome of a free flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// At a collision.
    Collided,
    /// At the end of the profile.
    Escaped,
}

impl Event {
    /// Name in cases.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Collided => "collided",
            Self::Escaped => "escaped",
        }
    }
}

/// A result.
#[derive(Clone, Debug)]
pub struct Outcome<N> {
    /// Of free flights: where it ended.
    pub event: Option<Event>,
    /// The numbers that the kind names.
    pub values: Vec<N>,
}

impl<N> Outcome<N> {
    /// One number.
    pub fn of(value: N) -> Self {
        Self { event: None, values: vec![value] }
    }

    /// Several numbers.
    pub fn all(values: impl Into<Vec<N>>) -> Self {
        Self { event: None, values: values.into() }
    }

    /// A flight that collided at a distance.
    pub fn collided(distance: N, weight: N) -> Self {
        Self { event: Some(Event::Collided), values: vec![distance, weight] }
    }

    /// A flight that escaped at the end of a profile of this length.
    pub fn escaped(length: N, weight: N) -> Self {
        Self { event: Some(Event::Escaped), values: vec![length, weight] }
    }
}

/// A look-up.
#[derive(Clone, Debug)]
pub(crate) struct Lookup<N> {
    /// Its distance \[length\].
    pub s: N,
    /// σ_t there \[1/length\].
    pub sigma_t: N,
    /// The weight behind it, of walks that carry one.
    pub weight: Option<N>,
}

/// A run: what an estimator draws and looks up.
#[derive(Debug)]
pub struct Run<'a, A: Arithmetic> {
    arithmetic: A,
    script: &'a Script,
    profile: Profile,
    /// Uses of the variates drawn so far.
    pub(crate) uses: Vec<Use>,
    /// Decisions so far that neither variates nor look-ups show.
    pub(crate) decisions: Vec<bool>,
    /// Look-ups so far.
    pub(crate) lookups: Vec<Lookup<A::Number>>,
}

impl<'a, A: Arithmetic> Run<'a, A> {
    /// A run that has done nothing yet.
    pub fn new(arithmetic: A, script: &'a Script, profile: Profile) -> Self {
        Self { arithmetic, script, profile, uses: Vec::new(), decisions: Vec::new(), lookups: Vec::new() }
    }

    /// The number x.
    pub fn number(&self, x: f64) -> A::Number {
        A::Number::of(x)
    }

    /// An input of a function.
    pub fn input(&self, x: f64) -> A::Number {
        self.arithmetic.input(x)
    }

    /// The profile.
    pub fn profile(&self) -> Profile {
        self.profile
    }

    /// Variates drawn so far.
    pub(crate) fn drawn_so_far(&self) -> usize {
        self.uses.len()
    }

    /// The length of the profile \[length\].
    pub fn length(&self) -> f64 {
        self.profile.length()
    }

    /// The majorant of the profile \[1/length\].
    pub fn majorant(&self) -> f64 {
        self.profile.majorant()
    }

    /// The next variate; 1/2 for an exponential that no variate has, which only a mistaken run asks for.
    pub fn uniform(&mut self) -> A::Number {
        let k = self.script.get(self.uses.len()).k().unwrap_or(1 << 52);
        self.uses.push(Use::Uniform);
        self.arithmetic.uniform(k)
    }

    /// A decision that neither a variate more nor a look-up shows: a port must make the same.
    pub(crate) fn decided(&mut self, is_so: bool) -> bool {
        self.decisions.push(is_so);
        is_so
    }

    /// The uniform variate of this number once more.
    pub(crate) fn drawn(&self, number: usize) -> A::Number {
        self.arithmetic.uniform(self.script.get(number).k().expect("a uniform variate is one of the lattice"))
    }

    /// The exponential of the next variate.
    pub fn exponential(&mut self) -> A::Number {
        let exact = self.script.get(self.uses.len()).exponential();
        self.uses.push(Use::Exponential);
        self.arithmetic.exponential(&exact)
    }

    /// σ_t at a distance \[1/length\].
    pub fn look_up(&mut self, s: A::Number) -> A::Number {
        let sigma_t = self.arithmetic.looked_up(self.profile.at(&s));
        self.lookups.push(Lookup { s, sigma_t: sigma_t.clone(), weight: None });
        sigma_t
    }

    /// The weight behind the last look-up, for the trace.
    pub fn weighs(&mut self, weight: &A::Number) {
        if let Some(last) = self.lookups.last_mut() {
            last.weight = Some(weight.clone());
        }
    }
}
