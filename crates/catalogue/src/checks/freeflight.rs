//! The free-flight samplers, each on every medium that admits it.

use super::media::{LAWFUL, analytic_cosine, voxels};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_collision::Version;
use fairflight_freeflight::{
    ClosedForm, FreeFlight, Inversion, JitteredFlight, Newton, Regular, Tracking, Woodcock,
};
use fairflight_laws::freeflight::{FlightExpectation, ObservedFlight, Weights, check};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{
    Breakpoints, Cells, Constant, FieldError, InvertOpticalThickness, OpticalThickness, PiecewiseConstant,
    PiecewiseLinear,
};
use glam::DVec3;
use std::sync::Arc;

/// Flights of a quick run: of a sampler with weights of 1 (and of the jittered one, whose look-ups are many); and of one whose
/// weights and look-ups want more.
const WITHOUT_LOOKUPS: u64 = 100_000;
const WITH_LOOKUPS: u64 = 200_000;

/// A medium, a greatest value on it, and the borders of two majorant cells with a majorant for each.
struct Medium<F> {
    specimen: Arc<Specimen<F>>,
    majorant: f64,
    cells: (f64, [f64; 2]),
}

/// All checks of free flights.
pub(super) fn checks() -> Vec<Check> {
    let constant = Constant::new(0.7, 3.0).expect(LAWFUL);
    let constant = Medium::new("constant", constant, 0.7, (1.0, [1.4, 0.7]));
    let mut checks = constant.by_lookups();
    checks.extend([constant.inversion(), constant.newton(), constant.regular()]);

    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let steps = Medium::new("piecewise_constant", steps, 1.2, (1.0, [1.2, 0.6]));
    checks.extend(steps.by_lookups());
    checks.extend([steps.inversion(), steps.newton(), steps.regular()]);

    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let tent = Medium::new("piecewise_linear", tent, 1.5, (2.0, [1.5, 0.9]));
    checks.extend(tent.by_lookups());
    checks.extend([tent.inversion(), tent.newton(), tent.regular(), tent.steep_majorant()]);

    let seed_ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let seed_ray = Medium::new("eq21_seed_ray", seed_ray, 1.0, (7.0, [1.0, 1.2]));
    checks.extend(seed_ray.by_lookups());
    checks.push(seed_ray.newton());

    let voxels = Medium::new("voxels", voxels(), 0.6, (3.0, [0.7, 0.6]));
    checks.extend(voxels.by_lookups());
    checks.extend([voxels.newton(), voxels.regular()]);

    // Section 3.3: negative extinction, for which only weights are left.
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let signed = Medium::new("piecewise_constant_negative", signed, 1.0, (1.0, [1.0, 0.8]));
    checks.push(signed.tracking("tracking_non_terminating", Version::NonTerminating, 3.0));
    checks.push(signed.tracking("tracking_adaptive", Version::Adaptive, 3.0));
    checks
}

impl<F: SpecimenField + OpticalThickness> Medium<F> {
    fn new(name: &'static str, field: F, majorant: f64, cells: (f64, [f64; 2])) -> Self {
        Self { specimen: Arc::new(Specimen::closed(name, field)), majorant, cells }
    }

    /// The samplers that look σ_t up and know nothing else of the field.
    fn by_lookups(&self) -> Vec<Check> {
        let (majorant, length) = (self.majorant, self.specimen.field.length());
        let (border, values) = self.cells;
        vec![
            self.check("woodcock_flight", "woodcock", WITH_LOOKUPS, Weights::One, move || {
                Ok((Woodcock::new(Constant::new(majorant, length)?), Vec::new()))
            }),
            self.check("woodcock_flight", "woodcock_in_cells", WITH_LOOKUPS, Weights::One, move || {
                let cells = PiecewiseConstant::new(vec![0.0, border, length], values.to_vec())?;
                let borders = cells.breakpoints();
                Ok((Woodcock::new(cells), borders))
            }),
            self.check("jittered_flight", "jittered", WITHOUT_LOOKUPS, Weights::One, || {
                Ok((JitteredFlight::new(0.5).expect(LAWFUL), Vec::new()))
            }),
            self.tracking("tracking_terminating_above", Version::Terminating, 1.25),
            self.tracking("tracking_non_terminating_above", Version::NonTerminating, 1.25),
            self.tracking("tracking_adaptive_above", Version::Adaptive, 1.25),
            self.tracking("tracking_non_terminating_below", Version::NonTerminating, 0.7),
            self.tracking("tracking_adaptive_below", Version::Adaptive, 0.7),
            // Mild weights: the variance of the scores is tested.
            self.tracking("tracking_adaptive_slightly_below", Version::Adaptive, 0.95),
        ]
    }

    /// Tracking with `share` of the majorant as sampling extinction.
    fn tracking(&self, name: &str, version: Version, share: f64) -> Check {
        let (sampling, length) = (share * self.majorant, self.specimen.field.length());
        self.check("tracking_flight", name, WITH_LOOKUPS, Weights::Any, move || {
            Ok((Tracking::new(version, Constant::new(sampling, length)?), Vec::new()))
        })
    }

    /// A majorant that is linear in pieces, and far above the field in places.
    fn steep_majorant(&self) -> Check {
        let (majorant, length) = (self.majorant, self.specimen.field.length());
        self.check("woodcock_flight", "woodcock_in_linear_pieces", WITH_LOOKUPS, Weights::One, move || {
            let nodes = vec![0.0, 0.5 * length, length];
            let pieces = PiecewiseLinear::new(nodes, vec![majorant, 1.2 * majorant, 0.5 * majorant])?;
            let borders = pieces.breakpoints();
            Ok((Woodcock::new(pieces), borders))
        })
    }

    fn newton(&self) -> Check {
        self.check("newton_flight", "newton", WITHOUT_LOOKUPS, Weights::One, || Ok((Newton, Vec::new())))
    }

    fn inversion(&self) -> Check
    where
        F: InvertOpticalThickness,
    {
        self.check("inversion_flight", "inversion", WITHOUT_LOOKUPS, Weights::One, || {
            Ok((Inversion, Vec::new()))
        })
    }

    fn regular(&self) -> Check
    where
        F: Cells,
    {
        self.check("regular_flight", "regular", WITH_LOOKUPS, Weights::One, || Ok((Regular, Vec::new())))
    }

    /// A check of the sampler of this kind that `build` makes together with the borders of what it knows.
    fn check<E: ClosedForm<F>>(
        &self,
        kind: &'static str,
        name: &str,
        samples: u64,
        weights: Weights,
        build: impl Fn() -> Result<(E, Vec<f64>), FieldError> + Send + Sync + 'static,
    ) -> Check
    where
        for<'f, 'e> &'e E: FreeFlight<&'f F> + FreeFlight<ObservedFlight<&'f F, &'e E>>,
    {
        let specimen = Arc::clone(&self.specimen);
        let id = format!("freeflight/{}/{name}", specimen.name);
        let (sampler, medium) = (format!("free flight by {}", name.replace('_', " ")), specimen.name);
        Check::new(id, Law::FreeFlight, sampler, medium.replace('_', " "), samples, move |run| {
            match build() {
                Ok((sampler, borders)) => examine(&specimen, &sampler, &borders, weights, run),
                Err(error) => CheckResult::exact(false, format!("refused: {error}")),
            }
        })
        .about([kind])
    }
}

pub(super) fn examine<F: SpecimenField, E: ClosedForm<F>>(
    specimen: &Specimen<F>,
    sampler: &E,
    borders: &[f64],
    weights: Weights,
    run: Run,
) -> CheckResult
where
    for<'f, 'e> &'e E: FreeFlight<&'f F> + FreeFlight<ObservedFlight<&'f F, &'e E>>,
{
    let (mut quadrature, _) = specimen.prepared();
    quadrature.split_at(borders);
    let expected = FlightExpectation::new(&mut quadrature, sampler, weights, specimen.tolerance);
    CheckResult::of_flights(&check(&specimen.field, sampler, &expected, expected.sufficient(run)))
}
