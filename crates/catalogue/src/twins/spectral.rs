//! Mistakes of samplers of several wavelengths.

use super::trial::LAWFUL;
use super::{Evident, Rejection, Twin};
use crate::profiles::constant;
use crate::vectors::{Answer, Variates, Vector};
use fairflight_freeflight::ClosedForm;
use fairflight_freeflight::spectral::{
    HeroWavelength, MaxScheme, Scheme, SpectralFlight, SpectralFreeFlight, SpectralTracking,
};
use fairflight_laws::Run;
use fairflight_laws::freeflight::{FlightExpectation, Weights};
use fairflight_laws::spectral::check_flights;
use fairflight_media::{
    Constant, Extinction, InvertOpticalThickness, RayQuadrature, Scaled, SpectralExtinction, Tolerance,
    Wavelength,
};
use fairflight_sources::UniformSource;

type Spectrum = Scaled<Constant, 2>;

/// Spectral tracking by the max scheme with other weights: `weigh` has the ratio of the event, and the sizes of it and of the
/// other one.
struct Weighing(fn(f64, f64, f64) -> f64);

impl<F: SpectralExtinction<N>, const N: usize> SpectralFreeFlight<F, N> for Weighing {
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        let sampling = constant(1.0, field.length());
        let (mut weights, mut s) = (past, 0.0);
        while let Some(next) = sampling.invert(s, source.next_exponential()) {
            s = next;
            let ratios = field.sigma_t(s).map(|sigma| sigma / sampling.sigma_t(s));
            let [collides, passes] = MaxScheme.sizes(&weights, &ratios);
            if source.next_uniform() * (collides + passes) < collides {
                // right: (collides + passes) ratio / collides
                let weights = std::array::from_fn(|l| weights[l] * (self.0)(ratios[l], collides, passes));
                return SpectralFlight::Collided { distance: s, weights };
            }
            weights = std::array::from_fn(|l| weights[l] * (self.0)(1.0 - ratios[l], passes, collides));
        }
        SpectralFlight::Escaped { weights }
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: &[f64; N]) -> bool {
        true
    }
}

/// Hero wavelength sampling whose collision is weighed by the null collisions before it alone.
struct ForgetsTheCollision;

impl<F: SpectralExtinction<N>, const N: usize> SpectralFreeFlight<F, N> for ForgetsTheCollision {
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        let majorant = constant(1.0, field.length());
        let hero = (source.next_uniform() * N as f64) as usize;
        let (mut weights, mut s) = (past, 0.0);
        while let Some(next) = majorant.invert(s, source.next_exponential()) {
            s = next;
            let ratios = field.sigma_t(s);
            if source.next_uniform() < ratios[hero] {
                // right: the ratios enter here as 1 − r do below
                return SpectralFlight::Collided { distance: s, weights };
            }
            let after: [f64; N] = std::array::from_fn(|l| weights[l] * (1.0 - ratios[l]));
            let probability = after.iter().sum::<f64>() / weights.iter().sum::<f64>();
            weights = after.map(|weight| weight / probability);
        }
        SpectralFlight::Escaped { weights }
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: &[f64; N]) -> bool {
        true
    }
}

/// Ratios 3/4 and 1/2 at a majorant of 1, length 2.
fn spectrum() -> Spectrum {
    Scaled::new(constant(1.0, 2.0), [0.75, 0.5]).expect(LAWFUL)
}

/// Judges `twin` by the law and the closed forms of its sibling `right`, in the first wavelength.
fn judged<E: for<'f> ClosedForm<Wavelength<&'f Spectrum, 2>>, T: SpectralFreeFlight<Spectrum, 2>>(
    right: &E,
    weights: Weights,
    twin: &T,
    run: Run,
) -> Rejection {
    let field = spectrum();
    let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 0).expect(LAWFUL), &[]);
    let expected = FlightExpectation::new(&mut quadrature, right, weights, Tolerance::TIGHT);
    Rejection::of_flights(check_flights(&field, twin, 0, &expected, run), "collided")
}

fn weighed(weigh: fn(f64, f64, f64) -> f64, run: Run) -> Rejection {
    let right = SpectralTracking::new(MaxScheme, constant(1.0, 2.0));
    judged(&right, Weights::Any, &Weighing(weigh), run)
}

/// Spectral tracking by the max scheme, without a control, on a test vector.
fn answered(
    weigh: fn(f64, f64, f64) -> f64,
    vector: &Vector<'_>,
    source: &mut Variates<'_>,
) -> Option<Answer> {
    let field = vector.spectrum("spectral_tracking")?;
    let is_max = (vector.word)("/sampler/scheme")? == "max" && vector.sampler("control").is_none();
    is_max.then(|| Weighing(weigh).sample(&field, source)).and_then(|flight| vector.flown_together(&flight))
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    const PROFILE: &str = "sigma_t 0.75 and 0.5, length 2, majorant 1; the first";
    vec![
        // Sizes 3/4 and 1/2: collisions are drawn with probability 3/5. Right: 1 − e^−1.5 = 0.7769, its second moment
        // 3/5 (5/4)² (1 − M)/0.84375 = 0.9056 with M = exp(2 (2/5 (5/8)² − 1)) = e^−1.6875. The twin: 3/5 (1 − e^−1.6)/0.8 = 0.5986.
        Twin::new(
            "spectral flight, max scheme",
            "spectral_weights_without_their_sum",
            "an event weighs r/max r for r (max r + max(1 − r))/max r: probabilities that do not add up to 1",
            PROFILE,
            (20_000, Evident::Mean { z: 45.9 }),
            |run| weighed(|ratio, size, _| ratio / size, run),
        )
        .about(["spectral_tracking"])
        .answers(|vector, source| answered(|ratio, size, _| ratio / size, vector, source)),
        // 9/8 (1 − e^(−5/3))/(5/6) = 1.0950.
        Twin::new(
            "spectral flight, max scheme",
            "spectral_weights_of_the_other_event",
            "an event is weighed with the probability of the other one",
            PROFILE,
            (10_000, Evident::Mean { z: 57.9 }),
            |run| weighed(|ratio, size, other| ratio * (size + other) / other, run),
        )
        .about(["spectral_tracking"])
        .answers(|vector, source| {
            answered(|ratio, size, other| ratio * (size + other) / other, vector, source)
        }),
        // Over n null collisions before: Σ_n w P(n) with w = 2/(1 + 2^n), P(n) = (0.75 · 4^−n + 0.5 · 2^−n)/2 times the
        // probability that a Poisson variate of mean 2 exceeds n: 0.6394 for
        // 0.7769, at a standard deviation of 0.4405.
        Twin::new(
            "spectral flight, hero wavelength",
            "hero_forgets_the_collision",
            "the running ratios take in null collisions alone: a collision weighs what it did before it",
            PROFILE,
            (20_000, Evident::Mean { z: 44.1 }),
            |run| {
                let right = HeroWavelength::new(constant(1.0, 2.0));
                judged(&right, Weights::UpTo(2), &ForgetsTheCollision, run)
            },
        )
        .about(["hero_wavelength"])
        .answers(|vector, source| {
            let flight = ForgetsTheCollision.sample(&vector.spectrum("hero_wavelength")?, source);
            vector.flown_together(&flight)
        }),
    ]
}
