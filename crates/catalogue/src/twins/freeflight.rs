//! Mistakes of free-flight samplers.

use super::trial::{Pretending, Wrong};
use super::{Evident, Rejection, Twin};
use crate::profiles::{constant, unit_cells};
use crate::vectors::{Answer, Variates, Vector};
use fairflight_collision::{Outcome, SingleOutcome, SingleParticle, Version};
use fairflight_freeflight::{ClosedForm, Flight, FreeFlight, Tracking, Woodcock};
use fairflight_laws::Run;
use fairflight_laws::freeflight::{FlightExpectation, Weights, check_flights};
use fairflight_media::{
    Breakpoints, Constant, Extinction, InvertOpticalThickness, PiecewiseConstant, RayQuadrature, Tolerance,
};
use fairflight_sources::{Scripted, UniformSource};

/// Woodcock tracking through majorant cells that divides by the majorant where the flight began.
struct PreviousCell(PiecewiseConstant);

impl<F: Extinction> Wrong<F, Flight> for PreviousCell {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let mut s = 0.0;
        while let Some(next) = self.0.invert(s, source.next_exponential()) {
            let majorant = self.0.sigma_t(s); // right: after s = next
            s = next;
            if source.next_uniform() * majorant < field.sigma_t(s) {
                return Flight::Collided { distance: s, weight: 1.0 };
            }
        }
        Flight::Escaped { weight: 1.0 }
    }
}

/// raab-2008 algorithm 1 accepts a collision at `ratio ≥ rand()`.
struct CollidesAsPrinted(Constant);

impl<F: Extinction> Wrong<F, Flight> for CollidesAsPrinted {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let mut s = 0.0;
        while let Some(next) = self.0.invert(s, source.next_exponential()) {
            s = next;
            // right: <
            if source.next_uniform() * self.0.sigma_t(s) <= field.sigma_t(s) {
                return Flight::Collided { distance: s, weight: 1.0 };
            }
        }
        Flight::Escaped { weight: 1.0 }
    }
}

/// Tracking in which one of the two energies is lost.
struct WithoutEnergy {
    model: SingleParticle,
    sampling: Constant,
    /// Replacements of a scattered and of a transmitted energy.
    taken_for: [fn(f64) -> f64; 2],
}

impl<F: Extinction> Wrong<F, Flight> for WithoutEnergy {
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let [scattered, transmitted] = self.taken_for;
        let (mut weight, mut s) = (1.0, 0.0);
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            s = next;
            match self.model.collide(field.sigma_t(s) / self.sampling.sigma_t(s), source) {
                Outcome::Scattered(energy) => {
                    return Flight::Collided { distance: s, weight: weight * scattered(energy) };
                }
                Outcome::Transmitted(energy) => weight *= transmitted(energy),
                Outcome::Absorbed => return Flight::Collided { distance: s, weight: 0.0 },
            }
        }
        Flight::Escaped { weight }
    }
}

/// Judges `twin` by the law and the closed forms of its sibling `right`; the z is that of the score `shows`.
pub(super) fn judged<
    F: Extinction + Breakpoints,
    E: for<'f> ClosedForm<&'f F>,
    T: for<'f> Wrong<&'f F, Flight>,
>(
    field: &F,
    (right, also): (&E, &[f64]),
    weights: Weights,
    twin: &T,
    shows: &str,
    run: Run,
) -> Rejection {
    let mut quadrature = RayQuadrature::new(field, also);
    let expected = FlightExpectation::new(&mut quadrature, right, weights, Tolerance::TIGHT);
    Rejection::of_flights(check_flights(field, Pretending(twin), &expected, run), shows)
}

/// Tracking without a control on a test vector.
fn tracked(taken_for: [fn(f64) -> f64; 2], vector: &Vector<'_>, source: &mut Variates<'_>) -> Option<Answer> {
    let field = vector.of("tracking_flight")?;
    let sampling = Constant::new(vector.sampler("sigma_samp")?, field.length()).ok()?;
    let version = match (vector.word)("/sampler/version")? {
        "non_terminating" => Version::NonTerminating,
        "adaptive" => Version::Adaptive,
        _ => Version::Terminating,
    };
    let model = *Tracking::new(version, sampling).model();
    vector.flown(WithoutEnergy { model, sampling, taken_for }.draw(field, source))
}

fn without_energy(taken_for: [fn(f64) -> f64; 2], shows: &str, run: Run) -> Rejection {
    let (field, sampling) = (constant(1.0, 1.0), constant(0.8, 1.0));
    let right = Tracking::new(Version::NonTerminating, sampling);
    let twin = WithoutEnergy { model: *right.model(), sampling, taken_for };
    judged(&field, (&right, &[]), Weights::Any, &twin, shows, run)
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        // The first tentative collision in the second cell is accepted with 1/4 for 1: escape has the probability
        // e^−1 (1 + 3/4 · 1/2) = 0.5058 for e^−1 = 0.3679.
        Twin::new(
            "free flight by woodcock",
            "majorant_of_the_previous_cell",
            "r = sigma_t over the majorant of the cell in which the flight began, for the one where it ended",
            "sigma_t 0.5, length 2, majorants 2, 0.5 (length 1 each)",
            (20_000, Evident::Mean { z: 40.4 }),
            |run| {
                let field = constant(0.5, 2.0);
                let cells = unit_cells(&[2.0, 0.5]);
                let (right, also) = (Woodcock::new(cells.clone()), cells.breakpoints());
                judged(&field, (&right, &also), Weights::One, &PreviousCell(cells), "escaped", run)
            },
        )
        .about(["woodcock_flight"])
        .answers(|vector, source| {
            let (field, cells) = (vector.of("woodcock_flight")?, vector.rates("/sampler/majorant")?);
            vector.flown(PreviousCell(cells).draw(field, source))
        }),
        // r = 5/4, energies ±3/2: E = (1 − e^−1)/1.5 = 0.4214 for 0.6321; the variance is 3 (1 − e^−½) − 0.6321² = 0.7808.
        Twin::new(
            "free flight by tracking",
            "flight_without_the_scattered_energy",
            "a collision counts the weight before it: E_scat = r/q_scat left out (szirmay-kalos-2017 eq. 9)",
            "sigma_t 1, length 1, sigma_samp 0.8, non-terminating",
            (50_000, Evident::Mean { z: 53.3 }),
            |run| without_energy([|_| 1.0, |energy| energy], "collided", run),
        )
        .about(["tracking_flight"])
        .answers(|vector, source| tracked([|_| 1.0, |energy| energy], vector, source)),
        // E = exp(−0.8 · 5/6) = 0.5134 for e^−1 = 0.3679; the variance is e^−½ − e^−2 = 0.4712.
        Twin::new(
            "free flight by tracking",
            "flight_without_the_transmitted_energy",
            "a flight goes on with its old weight: E_tran = (1 − r)/q_tran left out (szirmay-kalos-2017 eq. 9)",
            "sigma_t 1, length 1, sigma_samp 0.8, non-terminating",
            (50_000, Evident::Mean { z: 47.4 }),
            |run| without_energy([|energy| energy, |_| 1.0], "escaped", run),
        )
        .about(["tracking_flight"])
        .answers(|vector, source| tracked([|energy| energy, |_| 1.0], vector, source)),
        Twin::new(
            "free flight by woodcock",
            "flight_collides_in_empty_space",
            "ratio ≥ rand() for rand() < ratio (raab-2008 algorithm 1 as printed)",
            "sigma_t 0, majorant 1, variate 0",
            (0, Evident::Exactly),
            |_| {
                let empty = constant(0.0, 1.0);
                let majorant = constant(1.0, 1.0);
                // A first step of ln 2 lies on the profile; the variate 0 decides about the collision; then out.
                let source = || Scripted::new([0.5, 0.0, 0.5]);
                let ours = Woodcock::new(majorant).sample(&empty, &mut source());
                let twin = CollidesAsPrinted(majorant).draw(&empty, &mut source());
                let rejected = ours.distance().is_none() && twin.distance().is_some();
                Rejection::exact(rejected, "collides where there is nothing; ours goes on")
            },
        )
        .about(["woodcock_flight"])
        .answers(|vector, source| {
            let field = vector.of("woodcock_flight")?;
            let [value] = vector.numbers("/sampler/majorant/values")[..] else { return None };
            let majorant = Constant::new(value, field.length()).ok()?;
            vector.flown(CollidesAsPrinted(majorant).draw(field, source))
        }),
    ]
}
