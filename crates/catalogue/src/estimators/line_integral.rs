//! The line integral of raab-2008 algorithm 2: several flights, their first collisions stratified.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::add;
use super::woodcock::ENDING;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::unit_cells;
use crate::twins::trial::{Wrong, judged_as};
use crate::twins::{Evident, Twin};
use fairflight_media::{Bounded, Extinction, Majorant};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{LineIntegral, TransmittanceEstimator, Woodcock};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "line_integral", checks: Vec::new, twins, subjects, spared: &[ONE_MAJORANT] };

/// Flights of a line integral of several, whose look-ups have a skewed law of which only the mean is known.
const FLIGHTS: u64 = 800_000;

/// The law on a medium whose own majorant is one, with each of these numbers of flights.
pub(crate) fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>, splits: &[u32]) -> Vec<Check> {
    let of = |&splits: &u32| {
        // The look-ups of n flights are less skewed than those of one.
        let samples = if splits == 1 { ENDING } else { FLIGHTS / u64::from(splits) };
        let name = format!("line_integral_{splits}");
        add(specimen, &name, Law::Transmittance, samples, move |specimen, run| {
            specimen.line_integral(splits, run)
        })
        .about([KIND.name])
    };
    splits.iter().map(of).collect()
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("line integral of 4", above: false, below: false, |_| LineIntegral::new(4).expect(LAWFUL))
            .tried_where(one_lookup_a_mean_free_path),
    ]
}

/// Flights of each estimate of a twin.
const SPLITS: u32 = 4;

/// Algorithm 2 with the optical distance of the first collision as a function of u in \[0, 1) and p_V.
struct WrongFirstStep {
    splits: u32,
    majorant: f64,
    first: fn(f64, f64) -> f64,
}

impl<F: Extinction> Wrong<F> for WrongFirstStep {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let field = Bounded::new(field, self.majorant).expect(LAWFUL);
        let p_volume = -(-field.majorant() * field.length()).exp_m1();
        let n = f64::from(self.splits);
        let shift = source.next_uniform();
        let mut escaped = 0.0;
        for k in 0..self.splits {
            let depth = (self.first)((f64::from(k) + shift) / n, p_volume);
            escaped += flight(&field, depth, source);
        }
        1.0 - p_volume + p_volume * escaped / n
    }
}

/// 1 if a flight with this first step escapes.
fn flight<F: Majorant>(field: &F, first: f64, source: &mut impl UniformSource) -> f64 {
    let s = first / field.majorant();
    if s >= field.length() {
        return 1.0;
    }
    if source.next_uniform() * field.majorant() < field.sigma_t(s) {
        return 0.0;
    }
    // The rest is an ordinary flight through what is left.
    Woodcock.estimate(&Behind { field, from: s }, source)
}

/// The part of a field behind a point.
struct Behind<'a, F> {
    field: &'a F,
    from: f64,
}

impl<F: Extinction> Extinction for Behind<'_, F> {
    fn sigma_t(&self, s: f64) -> f64 {
        self.field.sigma_t(self.from + s)
    }
    fn length(&self) -> f64 {
        self.field.length() - self.from
    }
}

impl<F: Majorant> Majorant for Behind<'_, F> {
    fn majorant(&self) -> f64 {
        self.field.majorant()
    }
}

fn twin(id: &'static str, mistake: &'static str, z: f64, first: fn(f64, f64) -> f64) -> Twin {
    let profile = "sigma_t 1, 0.1 (length 1 each), majorant 1, 4 splits";
    Twin::new("line integral", id, mistake, profile, (50_000, Evident::Mean { z }), move |run| {
        let right = LineIntegral::new(SPLITS).expect(LAWFUL);
        let wrong = WrongFirstStep { splits: SPLITS, majorant: 1.0, first };
        judged_as(&right, &wrong, &unit_cells(&[1.0, 0.1]), run)
    })
    .answers(move |vector, source| {
        let field = vector.of(KIND.name)?;
        let (splits, majorant) = (vector.estimator("splits")? as u32, vector.estimator("majorant")?);
        Some(WrongFirstStep { splits, majorant, first }.draw(field, source).into())
    })
}

fn twins() -> Vec<Twin> {
    vec![
        // The flight may leave at once, which p_V has already excluded: E = (1 − p_V) + p_V T = 0.423 for 0.333.
        twin(
            "first_point_not_conditioned",
            "first variate in [0, 1) for [0, p_V): the first point may lie beyond the segment",
            214.0,
            |u, _p_volume| -(-u).ln_1p(),
        ),
        // −ln of a variate in [0, p_V): no first collision nearer than −ln p_V, and flights that leave at once. The z is
        // measured.
        twin(
            "printed_logarithm",
            "−log(u) for −ln(1 − u) with u in [0, p_V) (raab-2008 algorithm 1 put into algorithm 2: 0.420 for 0.331)",
            322.0,
            |u, p_volume| -(u * p_volume).ln(),
        ),
    ]
}
