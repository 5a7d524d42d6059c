//! Steps in primary sample space: they keep their target, for paths that draw any number of variates.

mod toys;

use fairflight_metropolis::laws::{Judged, Probes, Steps};
use fairflight_metropolis::{Mutation, Primary, Splats, Target, Which};
use fairflight_sources::{Layout, PathEnd, Row, SmallStep, UniformSource};
use std::cell::RefCell;
use toys::SEED;

/// A walk over [0, 1) that draws two variates per collision, and two at its end: the pixel is the number of collisions.
fn walk(splats: &mut Splats<f64>, source: &mut dyn UniformSource) {
    source.row(Row::flight(PathEnd::Camera, 1));
    let (mut s, mut collisions) = (0.0, 0);
    loop {
        s += source.next_exponential() / 3.0;
        if s >= 1.0 || source.next_uniform() < 0.2 {
            break;
        }
        collisions += 1;
    }
    source.row(Row::direction(PathEnd::Camera, 1));
    let [u, v] = [(); 2].map(|()| source.next_uniform());
    // Far from even in each of them, and of either sign.
    let value = (1.0 + f64::from(collisions)) * (1.2 + (6.0 * u).sin()) * (v - 0.2);
    splats.push([collisions, 0], value);
}

/// A state as probes see it.
#[derive(Default)]
struct State {
    collisions: f64,
    value: f64,
}

impl State {
    fn of(primary: &Primary<'_, f64>, which: Which) -> Self {
        let found = primary.splats(which).list().first();
        found.map_or_else(Self::default, |&([n, _], value)| Self { collisions: f64::from(n), value })
    }
}

/// Steps of a chain in primary sample space; `factor` is a mistake in the ratio.
struct Moves<'a, 'i, F> {
    primary: &'a RefCell<Primary<'i, f64>>,
    factor: F,
}

impl<F: FnMut(&State, &State) -> f64> Mutation<State> for Moves<'_, '_, F> {
    fn propose(&mut self, x: &State, y: &mut State, source: &mut dyn UniformSource) -> Option<f64> {
        let mut primary = self.primary.borrow_mut();
        let acceptance = primary.propose(source).acceptance;
        *y = State::of(&primary, Which::Proposed);
        Some((acceptance * (self.factor)(x, y)).ln())
    }
}

/// Judges the steps of `layout`: independent states, each with one proposal.
fn judged(
    layout: Layout,
    (samples, seed, large_step): (u64, u64, f64),
    factor: impl FnMut(&State, &State) -> f64,
) -> Judged {
    let mut walk = walk;
    let primary = Primary::new(&mut walk)
        .with_layout(layout)
        .with_small_step(SmallStep::new(0.01, 0.3).unwrap())
        .with_large_step(large_step)
        .unwrap();
    let primary = RefCell::new(primary);
    let probes = Probes::<State> {
        moved: &[&|x| x.collisions.min(5.0), &|x| x.value.tanh(), &|x| f64::from(u8::from(x.value > 0.3))],
        kept: &[],
    };
    let sample = |source: &mut fairflight_sources::Seeded,
                  each: &mut dyn FnMut(&State, f64, &mut fairflight_sources::Seeded)| {
        let mut borrowed = primary.borrow_mut();
        let weight = borrowed.draw(source);
        borrowed.accept();
        let x = State::of(&borrowed, Which::Present);
        drop(borrowed);
        if weight > 0.0 {
            each(&x, weight, source);
        }
    };
    let steps = Steps { samples, seed, alpha: 1e-6 };
    steps.judge(probes, sample, &mut Moves { primary: &primary, factor })
}

#[test]
fn paths_of_changing_length_keep_their_target() {
    for layout in [Layout::Rows, Layout::Flat] {
        for large_step in [0.0, 1.0] {
            let judged = judged(layout, (100_000, SEED, large_step), |_, _| 1.0);
            println!("{layout:?}, large steps {large_step}: {:?}", judged.worst());
            assert!(judged.agrees_within(0.15), "{layout:?}: {:#?}", judged.drifts);
        }
    }
}

#[test]
fn a_factor_for_the_number_of_variates_is_found() {
    // mlt_counts_variates: each collision more draws two variates, as if of a density of 0.8. Expected |z| 33.
    let twin =
        judged(Layout::Rows, (200_000, SEED, 0.0), |x, y| 0.8f64.powf(y.collisions - x.collisions).min(1.0));
    println!("{:?}", twin.worst());
    assert!(twin.is_rejected() && twin.worst().z.abs() > 8.5, "{:?}", twin.worst());
}
