//! The samplers of several wavelengths, each wavelength judged by itself; and decomposition tracking.

use super::freeflight::examine;
use super::media::{LAWFUL, analytic_cosine};
use super::specimen::Specimen;
use super::{Check, Law};
use fairflight_collision::Version;
use fairflight_freeflight::ClosedForm;
use fairflight_freeflight::spectral::{
    AverageScheme, DecompositionTracking, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance,
    SpectralFreeFlight, SpectralTracking,
};
use fairflight_laws::freeflight::{FlightExpectation, Weights};
use fairflight_laws::spectral::{ObservedSpectrum, check};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{
    Constant, PiecewiseConstant, PiecewiseLinear, Profiles, RayQuadrature, Scaled, SpectralBreakpoints,
    SpectralExtinction, SpectralOpticalThickness, Tolerance, Wavelength,
};
use glam::DVec3;
use std::sync::Arc;

/// Flights of a quick run, for each wavelength.
const SAMPLES: u64 = 100_000;

/// Wavelengths of all media here.
const N: usize = 3;

/// All checks of spectral flights.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = decomposition();

    // Weights that nothing bounds want wavelengths that differ little.
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.2, 1.0, 0.3]).expect(LAWFUL);
    let haze = Medium {
        name: "piecewise_linear_tinted",
        field: Arc::new(Scaled::new(tent, [1.0, 0.85, 0.7]).expect(LAWFUL)),
        majorants: [1.0, 0.85, 0.7],
    };
    checks.extend(haze.by_product_law());
    checks.extend(haze.within_bounds(1.2));
    checks.push(haze.shared(0.6));

    // The ray of eq. 21 in three colours, thin enough that what escapes is no rare event.
    let seed_ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let seed_ray = Medium {
        name: "eq21_seed_ray_tinted",
        field: Arc::new(Scaled::new(seed_ray, [0.5, 0.3, 0.125]).expect(LAWFUL)),
        majorants: [0.5, 0.3, 0.125],
    };
    checks.extend(seed_ray.within_bounds(1.0));

    // Three kinds of particles in their own places; nothing attenuates the last one in half of the profile.
    let steps = |border: f64, values: [f64; 2]| {
        PiecewiseConstant::new(vec![0.0, border, 3.0], values.to_vec()).expect(LAWFUL)
    };
    let profiles = [steps(1.0, [1.2, 0.3]), steps(2.0, [0.2, 0.9]), steps(1.5, [0.0, 0.7])];
    let kinds = Medium {
        name: "piecewise_constant_of_three_kinds",
        field: Arc::new(Profiles::new(profiles).expect(LAWFUL)),
        majorants: [1.2, 0.9, 0.7],
    };
    checks.extend(kinds.within_bounds(1.1));
    checks.push(kinds.shared(0.8));
    checks
}

/// A medium, and a majorant for each wavelength.
struct Medium<F> {
    name: &'static str,
    field: Arc<F>,
    majorants: [f64; N],
}

impl<F> Medium<F>
where
    F: SpectralExtinction<N> + SpectralOpticalThickness<N> + SpectralBreakpoints<N> + Send + Sync + 'static,
{
    fn constant(&self, sigma: f64) -> Constant {
        Constant::new(sigma, self.field.length()).expect(LAWFUL)
    }

    fn majorant(&self) -> f64 {
        self.majorants.into_iter().fold(0.0, f64::max)
    }

    /// Spectral tracking by the max scheme: with the tightest majorant of all, and with a control that all share.
    fn by_product_law(&self) -> [Check; 2] {
        let majorant = self.majorant();
        let (control, rest) = (self.constant(0.1 * majorant), self.constant(0.9 * majorant));
        let tracking = SpectralTracking::new(MaxScheme, self.constant(majorant));
        [
            self.check("spectral_tracking", "max_scheme", Weights::Any, tracking),
            self.check(
                "spectral_tracking",
                "max_scheme_with_a_shared_part",
                Weights::Any,
                SpectralTracking::with_control(MaxScheme, control, rest),
            ),
        ]
    }

    /// Checks of the samplers whose weights are bounded by N; the average scheme at `loose` times the majorant.
    fn within_bounds(&self, loose: f64) -> [Check; 3] {
        let bound = Weights::UpTo(N as u32);
        let majorants = self.majorants.map(|majorant| self.constant(majorant));
        let average = SpectralTracking::new(AverageScheme, self.constant(loose * self.majorant()));
        [
            self.check("spectral_tracking", "average_scheme", bound, average),
            self.check(
                "hero_wavelength",
                "hero_wavelength",
                bound,
                HeroWavelength::new(self.constant(self.majorant())),
            ),
            self.check("separate_solve", "separate_solve", bound, SeparateSolve::new(majorants)),
        ]
    }

    fn shared(&self, sampling: f64) -> Check {
        self.check(
            "shared_distance",
            "shared_distance",
            Weights::Any,
            SharedDistance::new(self.constant(sampling)),
        )
    }

    fn check<E>(&self, kind: &'static str, name: &str, weights: Weights, sampler: E) -> Check
    where
        E: Send + Sync + 'static,
        for<'f> E: ClosedForm<Wavelength<&'f F, N>> + SpectralFreeFlight<F, N>,
        for<'f> E: SpectralFreeFlight<ObservedSpectrum<'f, F, E>, N>,
    {
        let field = Arc::clone(&self.field);
        let id = format!("spectral/{}/{name}", self.name);
        let (words, medium) = (format!("spectral flight, {}", name.replace('_', " ")), self.name);
        Check::new(id, Law::FreeFlight, words, medium.replace('_', " "), SAMPLES, move |run| {
            const NAMES: [&str; N] = ["wavelength 0", "wavelength 1", "wavelength 2"];
            CheckResult::of_all(NAMES.into_iter().enumerate().map(|(wavelength, name)| {
                (name, one_wavelength(&*field, &sampler, wavelength, weights, run))
            }))
        })
        .about([kind])
    }
}

/// The flights of one wavelength, at its share of the false alarm and with variates of its own.
fn one_wavelength<F: SpectralBreakpoints<N>, E>(
    field: &F,
    sampler: &E,
    wavelength: usize,
    weights: Weights,
    run: Run,
) -> CheckResult
where
    for<'f> E: ClosedForm<Wavelength<&'f F, N>> + SpectralFreeFlight<F, N>,
    for<'f> E: SpectralFreeFlight<ObservedSpectrum<'f, F, E>, N>,
{
    let wave = Wavelength::new(field, wavelength).expect(LAWFUL);
    let mut quadrature = RayQuadrature::new(wave, &[]);
    let expected = FlightExpectation::new(&mut quadrature, sampler, weights, Tolerance::TIGHT);
    let seed = fairflight_sources::derive_seed(run.seed, wavelength as u64);
    let run = Run { seed, alpha: run.alpha / N as f64, ..run };
    CheckResult::of_flights(&check(field, sampler, wavelength, &expected, expected.sufficient(run)))
}

/// Decomposition tracking of gray media: a control below the field, one that is above it in places, and none.
fn decomposition() -> Vec<Check> {
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let tent = Arc::new(Specimen::closed("piecewise_linear", tent));
    let steps = Arc::new(Specimen::closed("piecewise_constant", steps));
    let of_tent = |name: &'static str, weights, version, control: f64, sampling: f64| {
        let specimen = Arc::clone(&tent);
        let id = format!("spectral/{}/{name}", specimen.name);
        let words = format!("free flight by {}", name.replace('_', " "));
        Check::new(id, Law::FreeFlight, words, "piecewise linear", 2 * SAMPLES, move |run| {
            let constant = |sigma| Constant::new(sigma, 3.0).expect(LAWFUL);
            let sampler = DecompositionTracking::new(version, constant(control), constant(sampling));
            // Where the residual changes its sign, and its moments their form.
            let borders = [(control - 0.1) / 1.4, 1.0 + (1.5 - control) / 0.65];
            examine(&specimen, &sampler, &borders, weights, run)
        })
        .about(["decomposition_tracking"])
    };
    let exact_control = {
        let specimen = Arc::clone(&steps);
        let id = "spectral/piecewise_constant/decomposition_tracking_in_pieces";
        let words = "free flight by decomposition tracking in pieces";
        Check::new(id, Law::FreeFlight, words, "piecewise constant", 2 * SAMPLES, move |run| {
            let pieces = |values: [f64; 2]| {
                PiecewiseConstant::new(vec![0.0, 2.0, 4.0], values.to_vec()).expect(LAWFUL)
            };
            let sampler =
                DecompositionTracking::new(Version::Terminating, pieces([0.1, 0.1]), pieces([1.1, 0.5]));
            examine(&specimen, &sampler, &[2.0], Weights::One, run)
        })
        .about(["decomposition_tracking"])
    };
    vec![
        of_tent("decomposition_tracking", Weights::One, Version::Terminating, 0.1, 1.4),
        of_tent("decomposition_tracking_too_much_taken_off", Weights::Any, Version::Adaptive, 0.4, 1.3),
        exact_control,
    ]
}
