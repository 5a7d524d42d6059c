//! Every check of the catalogue, at the N of a quick run, under one family-wise false alarm.

use fairflight_laws::{Law, catalogue};
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
    // Acceptance needs power: a bias of half would have shown in each, of a twentieth where only means are judged.
    let most = if ["paths", "vpl"].contains(&medium) { 0.05 } else { 0.5 };
    for (check, result) in &results {
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
    let run = |seed| check.run(fairflight_laws::Effort::Quick, seed, 1e-8);
    assert_eq!(run(3), run(3));
    assert_ne!(run(3).mean_z, run(4).mean_z);
}
