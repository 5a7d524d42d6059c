//! Woodcock tracking, which scores 0 or 1.

use super::Kind;
use super::on_profile::{ONE_MAJORANT, estimator, one_lookup_a_mean_free_path};
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use crate::profiles::{constant, unit_cells};
use crate::twins::trial::{Pretending, Wrong, judged_with_scores, theory_on};
use crate::twins::{Evident, Rejection, Twin};
use fairflight_laws::scores;
use fairflight_laws::transmittance::Admitted;
use fairflight_media::{Bounded, Extinction, Majorant, Watched};
use fairflight_sources::{Scripted, UniformSource};
use fairflight_transmittance::{TransmittanceEstimator, Woodcock};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "woodcock", checks: Vec::new, twins, subjects, spared: &[ONE_MAJORANT] };

/// Samples of a quick run of a walk that ends: more where closed moments ask for them.
pub(super) const ENDING: u64 = 160_000;

/// The law on a medium whose own majorant is one.
pub(crate) fn on<F: SpecimenField>(specimen: &Arc<Specimen<F>>) -> Check {
    add(specimen, "woodcock", Law::Transmittance, ENDING, Specimen::woodcock).about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("woodcock", above: false, below: false, |_| Woodcock)
            .tried_where(one_lookup_a_mean_free_path),
    ]
}

/// The right flight, in a majorant that is none.
struct TooLow(f64);

impl<F: Extinction> Wrong<F> for TooLow {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let claimed = Bounded::new(field, self.0).expect(LAWFUL); // right: a value that sigma_t nowhere exceeds
        Woodcock.estimate(&claimed, source)
    }
}

/// raab-2008 algorithm 1 accepts a collision at `ratio ≥ rand()`.
fn collides_as_printed(sigma_t: f64, majorant: f64, u: f64) -> bool {
    sigma_t / majorant >= u // right: u < sigma_t / majorant
}

fn twins() -> Vec<Twin> {
    vec![
        // E = exp(−∫ min(σ_t, majorant)) = exp(−1.6) for exp(−2): (0.2019 − 0.1353)/sqrt(0.1353·0.8647/N).
        Twin::new(
            "woodcock",
            "majorant_too_low",
            "Woodcock tracking through a majorant below the maximum (a renderer's camera path: 0.368 in hard case 3)",
            "sigma_t 0.5, 1.5 (length 1 each), majorant 1.1",
            (50_000, Evident::Mean { z: 43.5 }),
            |run| {
                let field = unit_cells(&[0.5, 1.5]);
                let theory = theory_on(&field, &Woodcock, &[]);
                let statistical =
                    judged_with_scores(&field, &Pretending(&TooLow(1.1)), (theory, scores::woodcock), run);
                // A watched run does not even need statistics: a first step of 1.5/1.1 ends where sigma_t is 1.5.
                let claimed = Bounded::new(&field, 1.1).expect(LAWFUL);
                let admitted = Admitted { field: claimed, estimator: Woodcock };
                let watched = Watched::new(claimed, admitted);
                Woodcock.estimate(&watched, &mut Scripted::new([-(-1.5_f64).exp_m1(), 0.0]));
                let rejected = statistical.rejected && watched.violation().is_some();
                // Of scores of 0 and 1 the variance says what the mean does.
                Rejection { rejected, variance_z: None, ..statistical }
            },
        )
        .answers(|vector, source| {
            let field = vector.of("woodcock")?;
            Some(TooLow(0.7 * field.majorant()).draw(field, source).into())
        }),
        Twin::new(
            "woodcock",
            "collides_in_empty_space",
            "ratio ≥ rand() for rand() < ratio (raab-2008 algorithm 1 as printed)",
            "sigma_t 0, majorant 1, variate 0",
            (0, Evident::Exactly),
            |_| {
                let empty = Bounded::new(constant(0.0, 1.0), 1.0).expect(LAWFUL);
                // A first step of ln 2 lies on the profile; the variate 0 decides about the collision; then out.
                let ours = Woodcock.estimate(&empty, &mut Scripted::new([0.5, 0.0, 0.5]));
                let rejected = ours == 1.0 && collides_as_printed(0.0, 1.0, 0.0);
                Rejection::exact(rejected, "collides where there is nothing; ours goes on")
            },
        )
        .answers(|vector, source| {
            let (field, mut s) = (vector.of("woodcock")?, 0.0);
            let majorant = field.majorant();
            loop {
                s += source.next_exponential() / majorant;
                if s >= field.length() {
                    return Some(1.0.into());
                }
                if collides_as_printed(field.sigma_t(s), majorant, source.next_uniform()) {
                    return Some(0.0.into());
                }
            }
        }),
    ]
}
