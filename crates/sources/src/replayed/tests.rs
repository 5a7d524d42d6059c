//! What a proposal draws of the state and what afresh, and that nothing but the state's path matters.

use super::*;
use crate::{PathEnd, Scripted, Seeded};

const ROWS: [Row; 3] = [
    Row { end: PathEnd::Camera, vertex: 1, purpose: Purpose::Flight },
    Row { end: PathEnd::Light, vertex: 1, purpose: Purpose::Flight },
    Row { end: PathEnd::Camera, vertex: 70, purpose: Purpose::Connection },
];

/// Draws so many variates of each row.
fn draw<S: UniformSource + ?Sized>(source: &mut Replayed<'_, S>, counts: [usize; 3]) -> [Vec<f64>; 3] {
    std::array::from_fn(|index| {
        source.row(ROWS[index]);
        (0..counts[index]).map(|_| source.next_uniform()).collect()
    })
}

/// Variates with a state that has drawn these.
fn state(layout: Layout, counts: [usize; 3]) -> (Variates, [Vec<f64>; 3]) {
    let mut variates = Variates::new(layout);
    let drawn = draw(&mut variates.step(Step::Large, &mut Seeded::new(5)), counts);
    variates.accept();
    (variates, drawn)
}

/// True if `next` is a small step from `before`.
fn is_near(before: f64, next: f64) -> bool {
    let distance = (next - before).rem_euclid(1.0);
    distance.min(1.0 - distance) <= 1.0 / 16.0
}

#[test]
fn a_state_is_replayed_bit_for_bit() {
    for layout in [Layout::Rows, Layout::Flat] {
        let (mut variates, drawn) = state(layout, [3, 5, 2]);
        assert_eq!((variates.len(), variates.is_empty()), (10, false));
        // Nothing fresh is drawn, and rejected proposals leave no trace.
        for _ in 0..3 {
            let small = Step::Small(SmallStep::default());
            let _ = draw(&mut variates.step(small, &mut Seeded::new(6)), [9, 1, 9]);
            assert_eq!(draw(&mut variates.step(Step::Again, &mut Scripted::new([])), [3, 5, 2]), drawn);
        }
        variates.accept();
        assert_eq!(draw(&mut variates.step(Step::Again, &mut Scripted::new([])), [3, 5, 2]), drawn);
    }
}

#[test]
fn one_variate_more_moves_no_other_row() {
    let (mut variates, drawn) = state(Layout::Rows, [2, 3, 2]);
    let small = Step::Small(SmallStep::default());
    let mut source = Seeded::new(7);
    let next = draw(&mut variates.step(small, &mut source), [4, 1, 2]);
    for (row, (before, next)) in drawn.iter().zip(&next).enumerate() {
        for (&before, &next) in before.iter().zip(next) {
            assert!(is_near(before, next) && before != next, "row {row}");
        }
    }
    // In one vector all behind the first row are moved: the first variate of the second row is near the third of the state.
    let (mut variates, drawn) = state(Layout::Flat, [2, 3, 2]);
    let flat = drawn.concat();
    let next = draw(&mut variates.step(small, &mut source), [3, 3, 1]).concat();
    assert!(flat.iter().zip(&next).all(|(&before, &next)| is_near(before, next)));
}

#[test]
fn what_is_not_drawn_is_forgotten() {
    let (mut variates, drawn) = state(Layout::Rows, [1, 2, 1]);
    // Two variates less, and accepted: they are drawn afresh afterwards.
    let _ = draw(&mut variates.step(Step::Again, &mut Scripted::new([])), [1, 1, 0]);
    variates.accept();
    assert_eq!(variates.len(), 2);
    let mut fresh = Scripted::new([0.125, 0.25]);
    let again = draw(&mut variates.step(Step::Again, &mut fresh), [1, 2, 1]);
    assert_eq!(again, [drawn[0].clone(), vec![drawn[1][0], 0.125], vec![0.25]]);
    assert_eq!(fresh.remaining(), 0);
}

#[test]
fn a_row_that_is_opened_again_goes_on() {
    let mut variates = Variates::new(Layout::Rows);
    let mut script = Scripted::new([0.1, 0.2, 0.3, 0.4, 0.5]);
    let opened = |source: &mut Replayed<'_, Scripted>| {
        let mut row = |index: usize, count: usize| {
            source.row(ROWS[index]);
            (0..count).map(|_| source.next_uniform()).collect::<Vec<_>>()
        };
        [row(0, 1), row(1, 1), row(0, 0), row(0, 2), row(1, 1)]
    };
    let drawn = opened(&mut variates.step(Step::Large, &mut script));
    variates.accept();
    assert_eq!(opened(&mut variates.step(Step::Again, &mut script)), drawn);
    // The same in another order of the rows: 0.1, 0.3, 0.4 belong to the first, 0.2 and 0.5 to the second.
    let mut source = variates.step(Step::Again, &mut script);
    source.row(ROWS[1]);
    assert_eq!([source.next_uniform(), source.next_uniform()], [0.2, 0.5]);
    source.row(ROWS[0]);
    assert_eq!([(); 3].map(|()| source.next_uniform()), [0.1, 0.3, 0.4]);
}

#[test]
fn choices_are_kept_or_made_anew() {
    let [kept, redrawn] = [Purpose::Kept, Purpose::Redrawn].map(|purpose| Row { purpose, ..Row::FIRST });
    let mut variates = Variates::new(Layout::Rows);
    let mut one = |step, script: &[f64]| {
        let mut script = Scripted::new(script.iter().copied());
        let mut source = variates.step(step, &mut script);
        source.row(kept);
        let first = source.next_uniform();
        source.row(redrawn);
        let found = [first, source.next_uniform()];
        assert_eq!(script.remaining(), 0);
        variates.accept();
        found
    };
    let small = Step::Small(SmallStep::default());
    assert_eq!(one(Step::Large, &[0.3, 0.6]), [0.3, 0.6]);
    // Of the steps that the two are given first, neither is taken.
    assert_eq!(one(small, &[0.7, 0.7, 0.1]), [0.3, 0.6]);
    assert_eq!(one(small, &[0.7, 0.7, 0.09, 0.9]), [0.3, 0.9]);
    assert_eq!(one(Step::Large, &[0.7, 0.8]), [0.7, 0.8]);
}

/// Chi square with 15 degrees of freedom of the counts in 16 cells.
fn chi_square(counts: [u32; 16]) -> f64 {
    let expected = f64::from(counts.iter().sum::<u32>()) / 16.0;
    counts.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum()
}

#[test]
fn variates_stay_uniform_and_on_the_lattice() {
    // A uniform state, then steps that are all accepted, of paths of changing lengths: the law of the source holds at each. One chain per
    // stream, so that what is counted is independent.
    for layout in [Layout::Rows, Layout::Flat] {
        let mut counts = [0; 16];
        for seed in 0..4000 {
            let (mut variates, mut source) = (Variates::new(layout), Seeded::new(seed));
            for step in 0..5 {
                let lengths = [1 + step % 2, 2, step % 3];
                let small = Step::Small(SmallStep::new(0.2, 0.5).unwrap());
                let drawn = draw(&mut variates.step(small, &mut source), lengths);
                variates.accept();
                for &u in drawn.iter().flatten() {
                    assert!((0.0..1.0).contains(&u) && (u * (1_u64 << 53) as f64).fract() == 0.0);
                }
                if step == 4 {
                    counts[(drawn[1][1] * 16.0) as usize] += 1;
                }
            }
        }
        // The quantile of 1e-6 is 58.
        assert!(chi_square(counts) < 58.0, "{layout:?}: {counts:?}");
    }
}
