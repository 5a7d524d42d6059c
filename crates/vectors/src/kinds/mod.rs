//! Kinds of estimators, samplers and functions that have vectors: a file each.

mod adaptive_ratio;
mod bounded_connection;
mod cells;
mod collision;
mod comb;
mod deflection;
mod double_particle;
mod double_particle_cells;
mod equiangular;
mod generalised_poisson;
mod henyey_greenstein;
mod inversion_flight;
mod jackknife;
mod jittered_flight;
mod jittered_ratio;
mod jittered_ratio_cells;
mod line_integral;
mod mis_weight;
mod next_flight;
mod p_series;
mod path_weights;
mod phase;
mod progressive_majorant;
mod ray_marching;
mod regular;
mod residual_cells;
mod single_particle;
mod spectral_flight;
mod spectral_tracking;
mod telescoping;
mod tracking_flight;
mod truncated_exponential;
mod unbiased_ray_marching;
mod unbiased_ray_marching_combs;
mod woodcock;
mod woodcock_flight;

use crate::bias::{Bias, Biases};
use crate::case::{Case, Sort, header, stated};
use crate::moments::Moments;
use crate::tolerance::Finished;
use crate::{Arithmetic, Draw, Noise, Outcome, Profile, Run, Script};
use serde_json::{Value, json};

/// An estimator, a sampler or a function with its parameters, written down over any arithmetic.
pub(crate) trait Model {
    /// The result of one run.
    fn run<A: Arithmetic>(&self, run: &mut Run<'_, A>) -> Outcome<A::Number>;

    /// The parameters, as a case states them; of estimators the spec that `harness estimate` reads. Nothing of models that only mistakes need.
    fn stated(&self) -> Value {
        Value::Null
    }

    /// True where the result takes e^x or an angle, of which libraries differ in the last place; else operations decide all bits.
    fn takes_functions(&self) -> bool {
        false
    }

    /// Runs of ports with a known mistake on the same variates, in doubles.
    fn mistakes(&self, _script: &Script, _profile: Profile) -> Vec<(&'static str, Finished)> {
        Vec::new()
    }

    /// Exact moments of its score on a profile, for a statistical test.
    fn moments(&self, _profile: Profile) -> Option<Moments> {
        None
    }

    /// True of what looks up a profile.
    fn looks_up(&self) -> bool {
        true
    }
}

/// A kind: its name, what it puts out, and its cases.
#[derive(Debug)]
pub struct Kind {
    /// Name, as specs have it.
    pub name: &'static str,
    /// Names of its results, in order.
    pub outputs: &'static [&'static str],
    /// Facts that decide bits or traps, by name.
    pub notes: &'static [(&'static str, &'static str)],
    cases: fn(&mut Cases),
}

impl Kind {
    /// All cases, in the order of their file.
    #[must_use]
    pub fn cases(&self) -> Vec<Case> {
        let mut cases = Cases::new();
        (self.cases)(&mut cases);
        cases.cases
    }

    /// Parameters with their exact moments: what a header has for a statistical test.
    #[must_use]
    pub fn moments(&self) -> Vec<Value> {
        self.cases().into_iter().filter_map(|case| case.moments).collect()
    }

    /// The bias of each known mistake at each set of parameters with an exact mean, measured on so many scripts of variates drawn at random.
    #[must_use]
    pub fn biases(&self, scripts: usize) -> Vec<Bias> {
        let mut cases = Cases { biases: Some(Biases::new(scripts, self.outputs)), ..Cases::new() };
        (self.cases)(&mut cases);
        cases.biases.map_or_else(Vec::new, Biases::found)
    }

    /// The file of the kind: a header, then a case a line.
    #[must_use]
    pub fn lines(&self) -> Vec<Value> {
        let (mut header, cases) = (header(self.name, self.outputs, self.notes), self.cases());
        let moments: Vec<&Value> = cases.iter().filter_map(|case| case.moments.as_ref()).collect();
        if !moments.is_empty() {
            header["moments"] = json!(moments);
        }
        std::iter::once(header).chain(cases.into_iter().map(|case| case.json)).collect()
    }
}

/// The registry of kinds, in the order of their files.
pub static KINDS: [&Kind; 34] = [
    &double_particle::KIND,
    &woodcock::KIND,
    &jittered_ratio::KIND,
    &unbiased_ray_marching::KIND,
    &spectral_tracking::KIND,
    &equiangular::KIND,
    &henyey_greenstein::KIND,
    &single_particle::KIND,
    &double_particle_cells::KIND,
    &residual_cells::KIND,
    &jittered_ratio_cells::KIND,
    &line_integral::KIND,
    &next_flight::KIND,
    &p_series::KIND,
    &generalised_poisson::KIND,
    &adaptive_ratio::KIND,
    &progressive_majorant::KIND,
    &ray_marching::KIND,
    &unbiased_ray_marching_combs::KIND,
    &telescoping::KIND,
    &jackknife::KIND,
    &regular::KIND,
    &woodcock_flight::KIND,
    &tracking_flight::KIND,
    &inversion_flight::KIND,
    &jittered_flight::KIND,
    &spectral_flight::KIND,
    &phase::KIND,
    &deflection::KIND,
    &collision::KIND,
    &truncated_exponential::KIND,
    &bounded_connection::KIND,
    &mis_weight::KIND,
    &path_weights::KIND,
];

/// Cases drawn of one set of parameters.
const DRAWN: usize = 60;
/// Variates that one case may draw.
pub(crate) const MOST_DRAWS: usize = 400;

/// Cases under a name KIND/PARAMETERS.
#[derive(Debug)]
struct Cases {
    cases: Vec<Case>,
    /// Instead of cases, the biases of mistakes at the parameters of those drawn at random.
    biases: Option<Biases>,
}

impl Cases {
    fn new() -> Self {
        Self { cases: Vec::new(), biases: None }
    }

    /// Adds cases drawn at random.
    fn draw(&mut self, name: &str, model: &impl Model, profile: Profile) {
        self.draw_some(DRAWN, name, model, profile);
    }

    /// Adds so many cases drawn at random, less those that a right port may decide otherwise.
    fn draw_some(&mut self, count: usize, name: &str, model: &impl Model, profile: Profile) {
        if let Some(biases) = &mut self.biases {
            biases.measure(name, model, profile);
            return;
        }
        let first = self.cases.len();
        for number in 0..count {
            let id = format!("{name}/{number:04}");
            let script = Script::of(&id, MOST_DRAWS);
            self.cases.extend(Case::of(id, Sort::Drawn, model, &script, profile));
        }
        if let Some(case) = self.cases.get_mut(first) {
            case.moments = model.moments(profile).map(|moments| stated(name, model, profile, &moments));
        }
    }

    /// Adds a case on a border.
    fn tie(&mut self, name: &str, model: &impl Model, profile: Profile, draws: Vec<Draw>) {
        self.by_hand(name, Sort::Tie, model, profile, draws);
    }

    /// Adds a case at an end of the variates.
    fn extreme(&mut self, name: &str, model: &impl Model, profile: Profile, draws: Vec<Draw>) {
        self.by_hand(name, Sort::Extreme, model, profile, draws);
    }

    fn by_hand(&mut self, name: &str, sort: Sort, model: &impl Model, profile: Profile, draws: Vec<Draw>) {
        if self.biases.is_none() {
            self.cases.extend(Case::of(name.to_owned(), sort, model, &Script::new(draws), profile));
        }
    }
}

/// A mistake of this name: what the model makes of the same variates in doubles, with functions of a library as ports have them.
fn mistake(
    name: &'static str,
    model: &impl Model,
    script: &Script,
    profile: Profile,
) -> (&'static str, Finished) {
    (name, Finished::of(model, &Noise::none(), script, profile))
}

/// Runs with each of these mistakes.
fn mistakes<S: Copy, M: Model>(
    slips: &[(&'static str, S)],
    with: impl Fn(S) -> M,
    script: &Script,
    profile: Profile,
) -> Vec<(&'static str, Finished)> {
    slips.iter().map(|&(name, slip)| mistake(name, &with(slip), script, profile)).collect()
}

/// The variate below 1.
const LARGEST: u64 = (1 << 53) - 1;

/// The exponential e, whatever variate has it.
fn given(exponential: f64) -> Draw {
    Draw::Given(exponential)
}

/// The variate u.
fn u(u: f64) -> Draw {
    Draw::uniform(u)
}
