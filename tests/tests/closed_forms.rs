//! Theory against independent numbers: simulations by other code, formulas derived by hand.

use approx::assert_relative_eq;
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_media::{
    AnalyticCosine, Bounded, Breakpoints, Constant, Extinction, InvertOpticalThickness, OpticalThickness,
    PiecewiseConstant, Ray, Tolerance, Vacuum, adaptive_integral,
};
use fairflight_transmittance::{
    Explorers, LineIntegral, Offset, RayMarching, Theory, Tracking, Woodcock, theory_on,
};
use glam::DVec3;

/// szirmay-kalos-2017 eq. 21 from the origin along z through the sphere: length 20, τ = 3.41568.
fn seed_ray() -> Ray<AnalyticCosine> {
    let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
    Ray::new(AnalyticCosine::new(1.0).unwrap(), &clip)
}

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

fn single(version: Version, albedo: f64) -> SingleParticle {
    SingleParticle { version, albedo: Albedo::new(albedo).unwrap() }
}

fn on_the_seed_ray<C: OpticalThickness + Breakpoints, R: InvertOpticalThickness>(
    control: C,
    sampling: R,
) -> Theory {
    let also = control.breakpoints();
    theory_on(seed_ray(), &Tracking::new(double_particle(), control, sampling), &also)
}

/// A number printed with three digits.
fn assert_printed(ours: f64, printed: f64) {
    assert_relative_eq!(ours, printed, max_relative = 6e-3);
}

#[test]
fn the_seed_ray_of_the_survey() {
    let ray = seed_ray();
    assert_printed(ray.optical_thickness(0.0, 20.0), 3.41568);
    let constant = |sigma| Constant::new(sigma, 20.0).unwrap();

    let ratio = on_the_seed_ray(Vacuum::new(20.0), constant(1.0));
    assert_printed(ratio.relative_central[0], 6.11);
    assert_relative_eq!(ratio.lookups, 20.0, max_relative = 1e-12);

    let track_length = theory_on(ray, &Woodcock, &[]);
    assert_printed(track_length.relative_central[0], 29.4);
    assert_printed(track_length.lookups, 5.21);

    let mean = ray.optical_thickness(0.0, 20.0) / 20.0;
    for (rate, printed) in [(1.0, 2.97), (2.0, 0.991)] {
        assert_printed(on_the_seed_ray(constant(mean), constant(rate)).relative_central[0], printed);
    }

    for (pieces, collisions, printed) in [(10, 10.0, 7.31), (16, 16.0, 0.919), (24, 8.0, 0.0984)] {
        let control = Explorers::through(&ray, pieces + 1).unwrap();
        let explorers = control.count() as f64;
        let theory = on_the_seed_ray(control, constant(collisions / 20.0));
        assert_printed(theory.relative_central[0], printed);
        assert_relative_eq!(
            theory.lookups + explorers,
            collisions + pieces as f64 + 1.0,
            max_relative = 1e-12
        );
    }
}

#[test]
fn equations_19_and_20_meet_at_both_ends_of_the_terminating_domain() {
    let field = Constant::new(1.0, 1.5).unwrap();
    for a in [0.0, 0.5, 0.9, 1.0] {
        for r in [1.0, 2.0 / (1.0 + a)] {
            let sampling = Constant::new(1.0 / r, 1.5).unwrap();
            let [terminating, non_terminating] =
                [Version::Terminating, Version::NonTerminating].map(|version| {
                    let estimator = Tracking::new(single(version, a), Vacuum::new(1.5), sampling);
                    theory_on(field, &estimator, &[]).relative_central[0]
                });
            assert_relative_eq!(terminating, non_terminating, max_relative = 1e-12);
        }
    }
}

#[test]
fn terminating_never_has_less_variance_where_both_are_legal() {
    // Against the sentence behind eq. 20: the difference of the densities is sigma (r − 1)((2 − r)/r − a) >= 0.
    for a in [0.0, 0.4, 0.8] {
        let end = 2.0 / (1.0 + a);
        for i in 0..=20 {
            let r = 1.0 + (end - 1.0) * f64::from(i) / 20.0;
            let density = |version| single(version, a).transmitted(r).moment_about_one(2) / r;
            let difference = density(Version::Terminating) - density(Version::NonTerminating);
            assert_relative_eq!(difference, (r - 1.0) * ((2.0 - r) / r - a), epsilon = 1e-12);
            assert!(difference > -1e-12);
        }
    }
}

#[test]
fn woodcock_is_the_terminating_particle_above_the_extinction() {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.5], vec![0.9, 0.3]).unwrap();
    let bounded = Bounded::new(field.clone(), 1.2).unwrap();
    let woodcock = theory_on(bounded, &Woodcock, &[]);
    let sampling = Constant::new(1.2, 2.5).unwrap();
    for a in [0.0, 0.7] {
        let estimator = Tracking::new(single(Version::Terminating, a), Vacuum::new(2.5), sampling);
        let terminating = theory_on(&field, &estimator, &[]);
        assert_relative_eq!(woodcock.lookups, terminating.lookups, max_relative = 1e-12);
        for (ours, theirs) in woodcock.relative_central.iter().zip(terminating.relative_central) {
            assert_relative_eq!(*ours, theirs, max_relative = 1e-9);
        }
    }
}

#[test]
fn woodcock_s_cost_is_the_majorant_times_the_mean_distance() {
    // Constant: M ∫ exp(−σ s) = M (1 − T)/σ.
    let field = Bounded::new(Constant::new(0.7, 3.0).unwrap(), 1.3).unwrap();
    let exact = 1.3 * (1.0 - (-2.1_f64).exp()) / 0.7;
    assert_relative_eq!(theory_on(field, &Woodcock, &[]).lookups, exact, max_relative = 1e-12);
}

#[test]
fn a_line_integral_of_one_flight_is_a_coin_in_disguise() {
    // T̂ = p_S + p_V X with X = 1 for an escape: P(X) = (T − p_S)/p_V, Var = p_V² P (1 − P) = (T − p_S)(1 − T).
    let (sigma, majorant, length) = (0.4_f64, 1.1_f64, 2.0);
    let field = Bounded::new(Constant::new(sigma, length).unwrap(), majorant).unwrap();
    let (t, p_surface) = ((-sigma * length).exp(), (-majorant * length).exp());
    let theory = theory_on(field, &LineIntegral::new(1).unwrap(), &[]);
    let variance = (t - p_surface) * (1.0 - t) / t / t;
    assert_relative_eq!(theory.relative_central[0], variance, max_relative = 1e-10);
    let (high, p) = (1.0 - p_surface, (t - p_surface) / (1.0 - p_surface));
    let third = high.powi(3) * p * (1.0 - p) * (1.0 - 2.0 * p) / t.powi(3);
    assert_relative_eq!(theory.relative_central[1], third, max_relative = 1e-9);
    // A flight that collides at all has the Woodcock cost, n times.
    let flight = majorant * (1.0 - t) / sigma / (1.0 - p_surface);
    assert_relative_eq!(theory.lookups, flight, max_relative = 1e-10);
    let four = theory_on(field, &LineIntegral::new(4).unwrap(), &[]);
    assert_relative_eq!(four.lookups, 4.0 * flight, max_relative = 1e-10);
    // Stratifying never costs variance against independent flights.
    assert!(four.relative_central[0] <= variance / 4.0 * (1.0 + 1e-12));
}

#[test]
fn the_bias_of_jittered_ray_marching_is_that_of_jensen() {
    // A step of σ = 1 on [0, 1/2) and 0 on [1/2, 1), one sample: X is 1 or 0 with equal probability.
    let field = PiecewiseConstant::new(vec![0.0, 0.5, 1.0], vec![1.0, 0.0]).unwrap();
    let theory = theory_on(field, &RayMarching::new(1, Offset::Jittered).unwrap(), &[]);
    let exact = 0.5 * (1.0 + (-1.0_f64).exp()) / (-0.5_f64).exp();
    assert_relative_eq!(theory.relative_mean, exact, max_relative = 1e-12);
    assert!(theory.relative_mean > 1.0);
}

#[test]
fn equation_16_by_independent_quadrature() {
    // exp(∫ (σ − c)²/σ_samp) − 1 for a σ_samp that varies.
    let ray = seed_ray();
    let rate = PiecewiseConstant::new(vec![0.0, 7.0, 20.0], vec![1.5, 0.6]).unwrap();
    let integral = adaptive_integral(20.0, &[7.0], Tolerance::TIGHT, |s| {
        [(ray.sigma_t(s) - 0.2).powi(2) / if s < 7.0 { 1.5 } else { 0.6 }]
    });
    let control = Constant::new(0.2, 20.0).unwrap();
    let estimator = Tracking::new(double_particle(), control, rate.clone());
    let theory = theory_on(ray, &estimator, &rate.breakpoints());
    assert_relative_eq!(theory.relative_central[0], integral.value[0].exp_m1(), max_relative = 1e-10);
    assert_relative_eq!(theory.lookups, 1.5 * 7.0 + 0.6 * 13.0, max_relative = 1e-12);
}
