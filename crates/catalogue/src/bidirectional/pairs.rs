//! Any two strategies find the same light, of paths of each length by themselves.

use super::scenes::{View, sample};
use fairflight_bidirectional::laws::Path;
use fairflight_bidirectional::{Bidirectional, Exact, Strategy, Subpath, Walking};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::LineThickness;
use fairflight_paths::Heuristic;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;

/// Two strategies that make paths of one length: number of edges, and of vertices from the camera of either.
pub type Pair = (u32, u32, u32);

/// Estimates of w_a w_b C_a and w_a w_b C_b for each pair, by one sample after the other. `splat` changes what the light image finds of
/// a path: a mistake, or none.
fn products<M: LineThickness>(
    view: &View<M>,
    pairs: &[Pair],
    (samples, seed): (u64, u64),
    splat: &dyn Fn(&Path<'_>) -> f64,
    mut each: impl FnMut(&[[f64; 2]]),
) {
    let emitters = view.emitters::<Regular>();
    let world = view.world::<Regular>();
    let laws = view.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let weigh = view.weigh(&emitters, Heuristic::Balance, Exact);
    let mut integrator = Bidirectional::new(weigh, Walking::new(view.walk), Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(seed));
    let mut sums = vec![[0.0; 2]; pairs.len()];
    for _ in 0..samples {
        sums.fill([0.0; 2]);
        sample(&mut integrator, &mut light, [0, 0], &mut source, |found, eye, light| {
            let Strategy { light: s, eye: t } = found.strategy;
            let concerned = |&(edges, a, b): &Pair| edges == s + t - 1 && (t == a || t == b);
            if !pairs.iter().any(concerned) {
                return;
            }
            let path = Path::of((&world, &emitters), found, eye, light);
            let value = if t == 1 { splat(&path) * found.value } else { found.value };
            let weights = laws.recursive(&path, |_, _, _| {});
            for (sums, pair) in sums.iter_mut().zip(pairs).filter(|(_, pair)| concerned(pair)) {
                let &(_, a, b) = pair;
                let (side, other) = if t == a { (0, b) } else { (1, a) };
                sums[side] += value * weights[other as usize - 1];
            }
        });
        each(&sums);
    }
}

/// **Law.** E_a\[w_a w_b C_a\] = E_b\[w_a w_b C_b\]: both are ∫ w_a w_b f. The products of weights are bounded where one strategy alone
/// has no second moment.
///
/// One sample is the difference of both, whose expectation is 0; a constant is added so that power can be told as a relative bias: the
/// mean of the first in a run of its own.
#[must_use]
pub fn check<M: LineThickness>(
    view: &View<M>,
    pairs: &[Pair],
    splat: &dyn Fn(&Path<'_>) -> f64,
    run: Run,
) -> CheckResult {
    let pilot = (run.samples / 4, derive_seed(run.seed, 1));
    let mut scales = vec![0.0; pairs.len()];
    products(view, pairs, pilot, splat, |found| {
        scales.iter_mut().zip(found).for_each(|(scale, [a, _])| *scale += a / pilot.0 as f64);
    });
    let mut moments = vec![Moments::new(); pairs.len()];
    products(view, pairs, (run.samples, derive_seed(run.seed, 2)), splat, |found| {
        for ((moments, scale), [a, b]) in moments.iter_mut().zip(&scales).zip(found) {
            moments.push(scale + a - b);
        }
    });
    let share = run.alpha / pairs.len() as f64;
    CheckResult::of_all(pairs.iter().zip(&scales).zip(&moments).map(|((&(edges, a, b), &scale), moments)| {
        let verdict = judge(moments, &Reference::exact(scale).with_mild_tails(), share);
        (format!("{edges} edges, t = {a} and {b}"), CheckResult::of_verdict(&verdict, run.samples))
    }))
}
