//! Closed variances on steps of constant extinction, where each is an expression of a line, a sum, or an average over all draws.

use super::{Check, LAWFUL, check};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_laws::CheckResult;
use fairflight_laws::exact::decisions::expectations;
use fairflight_laws::exact::{agree, greatest};
use fairflight_media::{
    Bounded, Constant, OpticalThickness, PiecewiseConstant, RayQuadrature, Tolerance, Vacuum,
};
use fairflight_sources::{LARGEST_VARIATE, Scripted};
use fairflight_transmittance::{
    ClosedForm, CombShape, GeneralisedPoisson, PSeries, PSeriesVersion, Telescoping, Tracking,
    TransmittanceEstimator, Woodcock,
};

/// Rounding, and quadrature where it meets nothing but steps.
const GRANTED: f64 = 1e-10;

/// Borders and values of the steps: of one sign, below [`MAJORANT`].
const EDGES: [f64; 4] = [0.0, 0.7, 1.5, 2.0];
const VALUES: [f64; 3] = [0.9, 0.2, 0.6];
const MAJORANT: f64 = 1.1;

pub(super) fn checks() -> Vec<Check> {
    vec![
        on_steps("variance of woodcock", "woodcock", || {
            // A success of probability T.
            [(theory(&Woodcock), thickness().exp_m1())]
        })
        .about(["woodcock"]),
        on_steps("variance of tracking", "double particle, single particle", || {
            let double = DoubleParticle { albedo: Albedo::default() };
            // szirmay-kalos-2017 eq. 16: E[W²] − 1 = r² − 2r, r² above the square of the mean.
            let ratio = Tracking::new(double, Vacuum::new(2.0), constant(MAJORANT));
            let residual = Tracking::new(double, constant(0.4), constant(0.5));
            // One particle survives for sure, with the energy a r + |1 − r| of which the transmitted share is |1 − r|.
            let albedo = 0.4;
            let version = Version::NonTerminating;
            let single = SingleParticle { version, albedo: Albedo::new(albedo).expect(LAWFUL) };
            let survives = Tracking::new(single, Vacuum::new(2.0), constant(MAJORANT));
            let of_single = integral(|sigma| {
                let r = sigma / MAJORANT;
                MAJORANT * ((1.0 - r) * (albedo * r + 1.0 - r) - 1.0 + 2.0 * r)
            });
            [
                (theory(&ratio), integral(|sigma| sigma * sigma / MAJORANT).exp_m1()),
                (theory(&residual), integral(|sigma| (sigma - 0.4).powi(2) / 0.5).exp_m1()),
                (theory(&survives), of_single.exp_m1()),
            ]
        })
        .about(["double_particle", "single_particle"]),
        on_steps("variance of points", "generalised poisson, p_series", || {
            // Points anywhere, X = 2 σ_t: of N ~ Poisson(λ) factors (p − X)/λ, and of N ~ Poisson(p) factors 1 − X/p.
            let (pivot, rate, length) = (1.3, 0.8, 2.0);
            let square = integral(|sigma| (pivot - length * sigma).powi(2)) / length;
            let poisson = rate - 2.0 * pivot + 2.0 * thickness() + square / rate;
            let ratio = integral(|sigma| length * sigma * sigma) / pivot;
            [
                (theory(&GeneralisedPoisson::new(pivot, rate).expect(LAWFUL)), poisson.exp_m1()),
                (theory(&series(PSeriesVersion::Ratio, pivot)), ratio.exp_m1()),
                (theory(&series(PSeriesVersion::NextFlight, pivot)), double_sum(pivot)),
            ]
        })
        .about(["generalised_poisson", "p_series"]),
        check("mean and variance of telescoping", "telescoping", "four cells", telescoping)
            .about(["telescoping"]),
    ]
}

fn constant(sigma: f64) -> Constant {
    Constant::new(sigma, 2.0).expect(LAWFUL)
}

fn series(version: PSeriesVersion, pivot: f64) -> PSeries {
    PSeries::new(version, pivot).expect(LAWFUL)
}

type Steps = Bounded<PiecewiseConstant>;

fn steps() -> Steps {
    let steps = PiecewiseConstant::new(EDGES.to_vec(), VALUES.to_vec()).expect(LAWFUL);
    Bounded::new(steps, MAJORANT).expect(LAWFUL)
}

/// ∫ g(σ_t) ds.
fn integral(g: impl Fn(f64) -> f64) -> f64 {
    EDGES.windows(2).zip(VALUES).map(|(cell, sigma)| (cell[1] - cell[0]) * g(sigma)).sum()
}

fn thickness() -> f64 {
    integral(|sigma| sigma)
}

/// Var/T² as the estimator states it.
fn theory<E: for<'f> ClosedForm<&'f Steps>>(estimator: &E) -> f64 {
    let steps = steps();
    let mut quadrature = RayQuadrature::new(&steps, &[]);
    estimator.theory(&mut quadrature, thickness(), Tolerance::TIGHT).relative_central[0]
}

/// Compares pairs of what is stated and what is right.
fn on_steps<const N: usize>(
    name: &str,
    estimator: &str,
    pairs: impl Fn() -> [(f64, f64); N] + Send + Sync + 'static,
) -> Check {
    check(name, estimator, "steps", move || {
        agree(greatest(pairs().map(|(stated, right)| (stated / right - 1.0).abs())), GRANTED)
    })
}

/// Var/T² of the power series whose orders are those of a Poisson number K of mean `pivot`, as its double sum: with Y of mean y and mean
/// square q, E\[A_k A_l\] = q^min y^(max − min)/(k! l!), and the sum over both orders of that times P_max/(P_k P_l).
fn double_sum(pivot: f64) -> f64 {
    const ORDERS: usize = 60;
    let y = pivot - thickness();
    let q = integral(|sigma| (pivot - 2.0 * sigma).powi(2)) / 2.0;
    let mass: Vec<f64> = (0..2 * ORDERS)
        .scan((-pivot).exp(), |mass, k| {
            let this = *mass;
            *mass *= pivot / (k + 1) as f64;
            Some(this)
        })
        .collect();
    let reached: Vec<f64> = (0..ORDERS).map(|k| mass[k..].iter().rev().sum()).collect();
    let factorials: Vec<f64> = (0..ORDERS)
        .scan(1.0, |factorial, k| {
            *factorial *= k.max(1) as f64;
            Some(*factorial)
        })
        .collect();
    let term = |k: usize, l: usize| {
        let (least, most) = (k.min(l), k.max(l));
        let product = q.powi(least as i32) * y.powi((most - least) as i32);
        product / (factorials[k] * factorials[l]) * reached[most] / (reached[k] * reached[l])
    };
    let square: f64 =
        (0..ORDERS).flat_map(|k| (0..ORDERS).map(move |l| (k, l))).map(|(k, l)| term(k, l)).sum();
    square * (-2.0 * y).exp() - 1.0
}

/// **Law.** Averaged over levels and the shift, an estimate is the transmittance and has the variance of its theory. On four equal cells
/// each tooth of a comb of four, eight, … stands in a cell of its own: these all have the same thickness, no level above the second has a
/// difference, and the average over levels ends. Within a level the estimate is constant in pieces of the shift.
fn telescoping() -> CheckResult {
    let field =
        PiecewiseConstant::new(vec![0.0, 0.5, 1.0, 1.5, 2.0], vec![0.4, 1.0, 0.2, 0.7]).expect(LAWFUL);
    let thickness = field.optical_thickness(0.0, 2.0);
    let estimator = Telescoping::new(1, 0.8, CombShape::Uniform).expect(LAWFUL);
    const MOST: usize = 9;
    let (mut mean, mut square, mut reached) = (0.0, 0.0, 1.0);
    for level in 0..=MOST {
        let goes_on = |u: f64| {
            // What is drawn tells the level: a source of just these variates would be exhausted or not.
            let script = [vec![LARGEST_VARIATE; level], vec![u, 0.0, 0.5]].concat();
            let mut source = Scripted::new(script);
            let _ = estimator.estimate(&field, &mut source);
            [if source.remaining() == 0 { 1.0 } else { 0.0 }]
        };
        let [further] = if level == MOST { [0.0] } else { expectations(goes_on) };
        let [first, second] = expectations(|u| {
            let script = [vec![LARGEST_VARIATE; level], vec![0.0, u]].concat();
            let estimate = thickness.exp() * estimator.estimate(&field, &mut Scripted::new(script));
            [estimate, (estimate - 1.0) * (estimate - 1.0)]
        });
        let probability = reached * (1.0 - further);
        reached *= further;
        mean += probability * first;
        square += probability * second;
    }
    let variance = square - (mean - 1.0) * (mean - 1.0);
    let theory = estimator.theory(&mut RayQuadrature::new(&field, &[]), thickness, Tolerance::TIGHT);
    agree(greatest([mean - 1.0, variance / theory.relative_central[0] - 1.0].map(f64::abs)), GRANTED)
}
