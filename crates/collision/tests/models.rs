//! The law of every collision model, and the closed forms of szirmay-kalos-2017 3.4, by exact algebra.

use approx::assert_relative_eq;
use fairflight_collision::{
    Albedo, Branch, CollisionModel, DoubleParticle, Outcome, SingleOutcome, SingleParticle, Version, Woodcock,
};
use fairflight_sources::{LARGEST_VARIATE, Scripted};

const ALBEDOS: [f64; 5] = [0.0, 0.3, 0.5, 0.9, 1.0];
const RATIOS: [f64; 15] =
    [-1e3, -2.0, -0.5, -1e-9, 0.0, 1e-9, 0.25, 0.5, 1.0 - 1e-8, 1.0, 1.0 + 1e-8, 1.05, 1.5, 7.0, 1e3];

fn albedo(a: f64) -> Albedo {
    Albedo::new(a).unwrap()
}

fn single(version: Version, a: f64) -> SingleParticle {
    SingleParticle { version, albedo: albedo(a) }
}

/// E[scattered] = a r and E[transmitted] = 1 − r; probabilities are probabilities.
fn check_law(model: &impl CollisionModel, a: f64, exclusive: bool) {
    for r in RATIOS.into_iter().chain([2.0 / (1.0 + a)]).filter(|&r| model.admits(r)) {
        let (scattered, transmitted) = (model.scattered(r), model.transmitted(r));
        assert_relative_eq!(scattered.moment(1), a * r, max_relative = 1e-14, epsilon = 1e-300);
        assert_relative_eq!(transmitted.moment(1), 1.0 - r, max_relative = 1e-14);
        for branch in [scattered, transmitted] {
            assert!((0.0..=1.0 + 1e-15).contains(&branch.probability), "r = {r}: {branch:?}");
        }
        if exclusive {
            assert!(scattered.probability + transmitted.probability <= 1.0 + 1e-15, "r = {r}, a = {a}");
        }
    }
}

#[test]
fn every_model_obeys_equation_8() {
    for a in ALBEDOS {
        check_law(&Woodcock { albedo: albedo(a) }, a, true);
        check_law(&DoubleParticle { albedo: albedo(a) }, a, false);
        for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
            check_law(&single(version, a), a, true);
        }
    }
}

/// `collide` draws what `scattered` and `transmitted` state: with one variate in the middle of each of 4096 strata, the
/// shares of the outcomes are off by one stratum at most.
fn check_collide(model: &impl SingleOutcome, a: f64) {
    const STRATA: u32 = 4096;
    for r in RATIOS.into_iter().chain([2.0 / (1.0 + a)]).filter(|&r| model.admits(r)) {
        let (mut scattered, mut transmitted) = (0.0, 0.0);
        for i in 0..STRATA {
            let u = (f64::from(i) + 0.5) / f64::from(STRATA);
            match model.collide(r, &mut Scripted::new([u])) {
                Outcome::Scattered(energy) => scattered += energy / f64::from(STRATA),
                Outcome::Transmitted(energy) => transmitted += energy / f64::from(STRATA),
                Outcome::Absorbed => {}
            }
        }
        let granted = 1.01 / f64::from(STRATA) * (1.0 + 2.0 * r.abs());
        assert!((scattered - a * r).abs() <= granted, "a = {a}, r = {r}: {scattered}");
        assert!((transmitted - (1.0 - r)).abs() <= granted, "a = {a}, r = {r}: {transmitted}");
    }
}

#[test]
fn one_variate_draws_both_branches() {
    for a in ALBEDOS {
        check_collide(&Woodcock { albedo: albedo(a) }, a);
        for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
            check_collide(&single(version, a), a);
        }
    }
}

#[test]
fn decisions_of_lanes_are_those_of_one() {
    let u: [f64; 16] = std::array::from_fn(|lane| [0.0, 0.2, 0.7, LARGEST_VARIATE][lane / 4]);
    for a in ALBEDOS {
        for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
            let model = single(version, a);
            for ratios in RATIOS.chunks(4) {
                let r = std::array::from_fn(|lane| ratios[lane % ratios.len()]);
                let (energies, are_scattered) = model.collide_lanes(&r, &u);
                for lane in 0..16 {
                    let expected = model.collide(r[lane], &mut Scripted::new([u[lane]]));
                    let found = match (energies[lane], are_scattered[lane]) {
                        (0.0, _) => Outcome::Absorbed,
                        (energy, true) => Outcome::Scattered(energy),
                        (energy, false) => Outcome::Transmitted(energy),
                    };
                    assert_eq!(found, expected, "{version:?}, a = {a}, r = {}, u = {}", r[lane], u[lane]);
                }
            }
        }
    }
}

#[test]
fn no_variate_draws_what_has_no_probability() {
    for version in [Version::NonTerminating, Version::Adaptive] {
        for u in [0.0, LARGEST_VARIATE] {
            let at = |a: f64, r: f64| single(version, a).collide(r, &mut Scripted::new([u]));
            assert_eq!(at(0.5, 0.0), Outcome::Transmitted(1.0));
            assert!(matches!(at(0.0, 0.3), Outcome::Transmitted(_)));
            assert!(matches!(at(1.0, 1.0), Outcome::Scattered(_)));
            assert_eq!(at(0.0, 1.0), Outcome::Absorbed);
        }
    }
    // Woodcock's: neither what does not scatter nor where there is no matter.
    let woodcock =
        |a: f64, r: f64, u: f64| Woodcock { albedo: albedo(a) }.collide(r, &mut Scripted::new([u]));
    assert_eq!(woodcock(0.0, 0.5, 0.0), Outcome::Absorbed);
    assert_eq!(woodcock(0.5, 0.0, 0.0), Outcome::Transmitted(1.0));
    assert_eq!(woodcock(1.0, 1.0, LARGEST_VARIATE), Outcome::Scattered(1.0));
    assert_eq!(woodcock(0.0, 1.0, LARGEST_VARIATE), Outcome::Absorbed);
}

#[test]
fn terminating_ends_at_two_over_one_plus_albedo() {
    for a in ALBEDOS {
        let model = single(Version::Terminating, a);
        let end = 2.0 / (1.0 + a);
        assert!(model.admits(end) && model.admits(0.0));
        assert!(!model.admits(end * (1.0 + 1e-12)) && !model.admits(-1e-300) && !model.admits(f64::NAN));
    }
}

/// The variance introduction density over σ_samp, that is E[(W − 1)^2] (szirmay-kalos-2017 eq. 15).
fn density(branch: Branch) -> f64 {
    branch.moment_about_one(2)
}

#[test]
fn variance_introduction_densities_are_those_of_the_paper() {
    for a in ALBEDOS {
        for r in RATIOS {
            // eq. 17
            assert_relative_eq!(density(DoubleParticle { albedo: albedo(a) }.transmitted(r)), r * r);
            // eq. 20, in units of σ_samp: |σ_diff| = |r| σ_samp
            let non_terminating = single(Version::NonTerminating, a);
            let eq20 = r.abs() * (r.abs() + a * (1.0 - r).abs());
            assert_relative_eq!(density(non_terminating.transmitted(r)), eq20, max_relative = 1e-12);
            // eq. 19
            let terminating = single(Version::Terminating, a);
            if terminating.admits(r) {
                let eq19 = if r <= 1.0 { r } else { r * (3.0 - 2.0 / r) };
                assert_relative_eq!(density(terminating.transmitted(r)), eq19, max_relative = 1e-12);
            }
        }
        // Equations 19 and 20 meet at r = 1 and at the end of the terminating domain.
        for r in [1.0, 2.0 / (1.0 + a)] {
            let [terminating, non_terminating] = [Version::Terminating, Version::NonTerminating]
                .map(|version| density(single(version, a).transmitted(r)));
            assert_relative_eq!(terminating, non_terminating, max_relative = 1e-12);
        }
    }
}

#[test]
fn moments_about_zero_and_about_one_agree() {
    for a in ALBEDOS {
        agree_about_one(&Woodcock { albedo: albedo(a) });
        agree_about_one(&DoubleParticle { albedo: albedo(a) });
        for version in [Version::Terminating, Version::NonTerminating, Version::Adaptive] {
            agree_about_one(&single(version, a));
        }
    }
}

/// E[(W − 1)^k] expanded, for both particles and even and odd k, within the rounding of its greatest term.
fn agree_about_one(model: &impl CollisionModel) {
    for r in RATIOS.into_iter().filter(|&r| model.admits(r)) {
        for branch in [model.scattered(r), model.transmitted(r)] {
            let raw = |k: i32| if k == 0 { 1.0 } else { branch.moment(k) };
            for (k, binomials) in [(2, [1.0, 2.0, 1.0].as_slice()), (3, &[1.0, 3.0, 3.0, 1.0])] {
                let terms: Vec<f64> = (0..=k)
                    .zip(binomials)
                    .map(
                        |(i, binomial)| if (k - i) % 2 == 0 { binomial * raw(i) } else { -binomial * raw(i) },
                    )
                    .collect();
                let size: f64 = terms.iter().map(|term| term.abs()).sum();
                let off = branch.moment_about_one(k) - terms.iter().sum::<f64>();
                assert!(off.abs() <= 1e-14 * size, "r = {r}, k = {k}: {branch:?}");
            }
        }
    }
}

#[test]
fn moments_are_smooth_but_for_the_kinks_that_are_told() {
    for a in ALBEDOS {
        for version in [Version::NonTerminating, Version::Adaptive] {
            let model = single(version, a);
            let moments = |r: f64| {
                [model.scattered(r), model.transmitted(r)]
                    .map(|branch| [branch.moment(2), branch.moment_about_one(2)])
            };
            // A jump of the slope is one of the second difference over the step; a curvature is a step less.
            const STEP: f64 = 1e-6;
            let has_kink = |r: f64| {
                let [low, at, high] = [r - STEP, r, r + STEP].map(moments);
                (0..4).any(|i| {
                    let [low, at, high] = [low, at, high].map(|moments| moments[i / 2][i % 2]);
                    ((high - at) - (at - low)).abs() > 1e-3 * STEP
                })
            };
            let everywhere = (-30..30).map(|i| f64::from(i) / 10.0 + 0.05).chain([0.0, 1.0, 2.0 / (1.0 + a)]);
            for r in everywhere.filter(|&r| has_kink(r)) {
                assert!(model.kinks().contains(&r), "{version:?}, a = {a}: a kink at {r}");
            }
        }
    }
    assert!(Woodcock { albedo: albedo(0.5) }.kinks().is_empty());
}

#[test]
fn a_tiny_ratio_keeps_its_digits() {
    let r = 1e-9;
    assert_relative_eq!(density(single(Version::NonTerminating, 0.0).transmitted(r)), r * r);
    assert_relative_eq!(density(DoubleParticle { albedo: albedo(0.0) }.transmitted(r)), r * r);
}

#[test]
fn draws_follow_the_stated_probabilities_at_both_ends_of_the_lattice() {
    let ends = || Scripted::new([0.0, LARGEST_VARIATE]);
    let woodcock = Woodcock { albedo: albedo(0.5) };
    let mut source = ends();
    // No matter: no variate collides. Nothing but matter: every variate does.
    assert_eq!([0, 1].map(|_| woodcock.transmit(0.0, &mut source)), [Some(1.0); 2]);
    let mut source = ends();
    assert_eq!([0, 1].map(|_| woodcock.transmit(1.0, &mut source)), [None; 2]);

    let model = single(Version::NonTerminating, 0.5);
    let transmitted = model.transmitted(3.0);
    let below = transmitted.probability - 1e-12;
    let above = transmitted.probability + 1e-12;
    assert_eq!(model.transmit(3.0, &mut Scripted::new([below])), Some(transmitted.energy));
    assert_eq!(model.transmit(3.0, &mut Scripted::new([above])), None);
    assert!(transmitted.energy < 0.0, "above r = 1 the transmitted energy is negative (eq. 11)");
    // 0/0 at r = 1, a = 0: the walk ends.
    assert_eq!(single(Version::NonTerminating, 0.0).transmit(1.0, &mut Scripted::new([0.0])), None);
}

#[test]
fn adaptive_takes_the_version_of_simulate_particle() {
    for a in [0.0, 0.5, 0.9] {
        let [terminating, non_terminating, adaptive] =
            [Version::Terminating, Version::NonTerminating, Version::Adaptive].map(|v| single(v, a));
        let inside = 1.0 + 0.5 * (2.0 / (1.0 + a) - 1.0);
        assert_eq!(adaptive.transmitted(inside), terminating.transmitted(inside));
        for r in [-1.0, 0.5, 2.5] {
            assert_eq!(adaptive.transmitted(r), non_terminating.transmitted(r));
        }
    }
}

#[test]
fn a_wrong_sign_of_the_transmitted_energy_breaks_the_law() {
    // Wrong twin: |1 − r| for 1 − r (eq. 11 without its sign).
    let r = 1.5;
    let twin = |r: f64| (1.0 - r).abs();
    assert_eq!(DoubleParticle { albedo: albedo(0.5) }.transmitted(r).moment(1), 1.0 - r);
    assert_eq!(twin(r) - (1.0 - r), 1.0, "the twin is wrong by 2 (r − 1)");
}

#[test]
fn albedos_outside_the_unit_interval_are_refused() {
    for bad in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
        assert!(Albedo::new(bad).is_err());
    }
}
