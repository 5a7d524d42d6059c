//! Every check of the catalogue, at the N of a quick run, under one family-wise false alarm.

use fairflight_catalogue::{Check, Effort, FAMILY_SIZE, Law, SAMPLERS, catalogue};
use fairflight_tests::{repository, run_checks};
use std::collections::BTreeSet;
use std::fs;

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
    let by_samples =
        ["paths", "vpl", "bidirectional", "extensions", "metropolis", "points"].contains(&medium);
    // Of two strategies that share the light of one length either sees a part.
    let most = if by_samples && !["bidirectional", "extensions", "metropolis"].contains(&medium) {
        0.05
    } else {
        0.1
    };
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
    bidirectional,
    extensions,
    metropolis,
    exact,
);

#[test]
fn the_family_has_room() {
    let draws = |check: &Check| check.samples(Effort::Quick) > 0;
    let count = catalogue().iter().filter(|check| draws(check)).count();
    assert!(count <= FAMILY_SIZE, "{count} checks that draw");
}

#[test]
fn checks_say_what_they_draw_from() {
    for check in catalogue() {
        let of = |prefix: &str| check.id.starts_with(prefix);
        // Where nothing else is drawn from, it is a sampler or an integrator that a check draws from, whatever it is called.
        if of("freeflight/") || of("spectral/") {
            assert!(
                check.kinds.len() == 1 && SAMPLERS.contains(&check.kinds[0]),
                "{}: {:?}",
                check.id,
                check.kinds
            );
        }
        if of("vpl/") {
            assert!(check.kinds.contains(&"vpl"), "{}: {:?}", check.id, check.kinds);
        }
        if of("bidirectional/") {
            assert!(check.kinds.contains(&"bidirectional"), "{}: {:?}", check.id, check.kinds);
        }
        if of("phase/") {
            assert!(check.kinds.is_empty(), "{}: {:?}", check.id, check.kinds);
        }
        let once: BTreeSet<&str> = check.kinds.iter().copied().collect();
        assert_eq!(once.len(), check.kinds.len(), "{}: {:?}", check.id, check.kinds);
    }
}

/// The name of a type, in words.
fn name_of(kind: &str) -> String {
    let mut name = String::new();
    for letter in kind.chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

#[test]
fn every_sampler_of_free_flights_is_in_the_catalogue() {
    let mut found = BTreeSet::new();
    for (folder, of_lines) in [("crates/freeflight/src", true), ("crates/freeflight/src/spectral", false)] {
        for entry in fs::read_dir(repository().join(folder)).unwrap().flatten() {
            let code = fs::read_to_string(entry.path()).unwrap_or_default();
            let code = code.split_whitespace().collect::<Vec<_>>().join(" ");
            for implementation in code.split("impl<").skip(1) {
                let header = implementation.split('{').next().unwrap();
                let Some((before, kind)) = header.rsplit_once(" for ") else { continue };
                // The trait itself, not a bound on one of its types.
                let arguments = before.rsplit_once("FreeFlight<").map_or("", |(_, arguments)| arguments);
                let kind = kind.split(['<', ' ']).next().unwrap();
                if arguments.find('>') != Some(arguments.len().wrapping_sub(1)) || kind.starts_with('&') {
                    continue;
                }
                let name = name_of(kind);
                let is_flight = of_lines && !name.ends_with("_flight");
                found.insert(if is_flight { format!("{name}_flight") } else { name });
            }
        }
    }
    let known: BTreeSet<String> = SAMPLERS.iter().map(|name| (*name).to_owned()).collect();
    assert_eq!(found, known);
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
    let run = |seed| check.run(Effort::Quick, seed, 1e-8);
    assert_eq!(run(3), run(3));
    assert_ne!(run(3).mean_z, run(4).mean_z);
}
