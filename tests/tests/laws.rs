//! Every check of the catalogue, at the N of a quick run, under one family-wise false alarm.

use fairflight_catalogue::{FAMILY_SIZE, Kind, Law, catalogue};
use fairflight_tests::run_checks;

/// Nothing fails, and nothing is silently untested: every check of the catalogue is testable at its quick N.
fn holds_on(medium: &str) {
    let prefix = format!("{medium}/");
    let results = run_checks(|check| check.id.starts_with(&prefix));
    assert!(!results.is_empty(), "no check on {medium}");
    let not_holding: Vec<String> = results
        .iter()
        .filter(|(_, result)| result.holds != Some(true))
        .map(|(check, result)| format!("{}: {:?}: {}", check.id, result.holds, result.reason))
        .collect();
    assert!(not_holding.is_empty(), "{not_holding:#?}");
    // Acceptance needs power: a bias of a tenth would have shown in each, of a twentieth where only means are judged; and N a margin over
    // what the shape of the sample asks for, where no closed moments say it.
    let by_samples = ["paths", "vpl", "points"].contains(&medium);
    let most = if by_samples { 0.05 } else { 0.1 };
    for (check, result) in &results {
        let share = result.normal_share.filter(|_| by_samples);
        assert!(share.is_none_or(|share| share < 0.8), "{}: {share:?}", check.id);
        if check.law != Law::Collision {
            let detectable = result.detectable_relative_bias;
            assert!(detectable.is_some_and(|bias| bias < most), "{}: {detectable:?}", check.id);
        }
        assert!(check.law != Law::Variance || result.variance_is_tested, "{}", check.id);
    }
}

macro_rules! media {
    ($($medium:ident),* $(,)?) => {
        $(#[test]
        fn $medium() {
            holds_on(stringify!($medium));
        })*

        #[test]
        fn no_medium_is_forgotten() {
            let known = [$(concat!(stringify!($medium), "/")),*, "twin/", "hard/"];
            for check in catalogue() {
                assert!(known.iter().any(|prefix| check.id.starts_with(prefix)), "{}", check.id);
            }
        }
    };
}

media!(
    collision,
    phase,
    constant,
    piecewise_constant,
    piecewise_constant_negative,
    piecewise_linear,
    eq21_seed_ray,
    eq21_oblique_ray,
    perlin,
    rough_cells,
    voxels,
    expression,
    series,
    cells,
    hybrid,
    freeflight,
    spectral,
    points,
    paths,
    vpl,
    exact,
);

#[test]
fn the_family_has_room() {
    assert!(catalogue().len() <= FAMILY_SIZE, "{} checks", catalogue().len());
}

#[test]
fn every_kind_is_drawn_from_by_checks_that_say_so() {
    let all = catalogue();
    for kind in Kind::ALL {
        assert!(all.iter().any(|check| check.kinds.contains(&kind)), "{}", kind.name());
    }
    for check in &all {
        let of = |prefix: &str| check.id.starts_with(prefix);
        // Flights and phase functions are no estimators of transmittance, whatever they are called.
        if ["freeflight/", "spectral/", "phase/", "vpl/"].iter().any(|prefix| of(prefix)) {
            assert!(check.kinds.is_empty(), "{}: {:?}", check.id, check.kinds);
        }
        if check.kinds.contains(&Kind::Hybrid) {
            assert!(of("hybrid/") || of("hard/14 "), "{}", check.id);
        }
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<String> = catalogue().into_iter().map(|check| check.id).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn a_check_depends_on_its_seed_and_on_nothing_else() {
    let all = catalogue();
    let check = all.iter().find(|check| check.id == "constant/ratio_tracking").unwrap();
    let run = |seed| check.run(fairflight_catalogue::Effort::Quick, seed, 1e-8);
    assert_eq!(run(3), run(3));
    assert_ne!(run(3).mean_z, run(4).mean_z);
}
