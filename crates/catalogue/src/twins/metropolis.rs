//! Mistakes in chains: of their start, of what scores are multiplied with, of what may be learnt, and of the energy that samples hand on.
//!
//! Tried on two modes of which the image is known ([`modes`]), with small steps that never lead from one to the other.

use super::trial::LAWFUL;
use super::{Evident, Rejection, Twin};
use fairflight_laws::Run;
use fairflight_metropolis::laws::modes;
use fairflight_metropolis::{
    Acceptance, Bootstrap, Chain, Film, Importance, Integrand, Plan, Primary, Proposed, Target, Which,
};
use fairflight_sources::{Seeded, SmallStep, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, judge};

const PROFILE: &str = "two modes on a line";

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let chains = of_starts().into_iter().chain(of_learning()).map(|twin| twin.about(["metropolis"]));
    chains.chain(of_energy().into_iter().map(|twin| twin.about(["energy_redistribution"]))).collect()
}

/// A twin that is judged by what it scores on average, with each seed, in the left pixel.
fn twin(
    (of, id): (&'static str, &'static str),
    mistake: &'static str,
    (samples, z): (u64, f64),
    scores: fn(u64, &mut dyn FnMut(u64) -> u64) -> Vec<f64>,
) -> Twin {
    Twin::new(of, id, mistake, PROFILE, (samples, Evident::Mean { z }), move |run: Run| {
        let moments = Moments::from_slice(&scores(run.samples, &mut |index| derive_seed(run.seed, index)));
        let right = Reference::exact(modes::image()[0]).with_mild_tails();
        Rejection::of_mean(judge(&moments, &right, run.alpha))
    })
}

/// Small steps alone: each chain stays in its mode.
fn primary(integrand: &mut dyn Integrand<f64>) -> Primary<'_, f64> {
    let small = SmallStep::new(0.002, 0.04).expect(LAWFUL);
    Primary::new(integrand).with_small_step(small).with_large_step(0.0).expect(LAWFUL)
}

/// A stream of its own.
fn stream(seed: u64, index: u64) -> Seeded {
    Seeded::new(derive_seed(seed, 1000 + index))
}

/// What `run` deposits in the left pixel.
fn left(run: impl FnOnce(&mut Film<'_, f64>)) -> f64 {
    let mut sum = 0.0;
    run(&mut |pixel, value| sum += if pixel == [0, 0] { value } else { 0.0 });
    sum
}

/// The score of a chain of so many steps from the present state of `target`, each of which scores `energy`.
fn chain(target: &mut dyn Target<f64>, (steps, energy): (u64, f64), source: &mut Seeded) -> f64 {
    let mut chain = Chain::new(target, energy);
    left(|film| {
        for _ in 0..steps {
            chain.step(film, &mut [Acceptance::default(); 2], source).expect(LAWFUL);
        }
        chain.finish(film);
    })
}

/// Steps of a chain, of the mean score 1 over all pixels.
const STEPS: (u64, f64) = (20, 1.0 / 20.0);

/// The score of one chain, started by `choose` from a set of so many samples, and their b̂.
fn started(
    target: &mut Primary<'_, f64>,
    (samples, seed): (u64, u64),
    choose: impl FnOnce(&Bootstrap, &mut Primary<'_, f64>) -> u64,
) -> (f64, f64) {
    let set = Bootstrap::draw(target, samples, seed).expect(LAWFUL);
    let start = choose(&set, target);
    set.start(target, start);
    (chain(target, STEPS, &mut stream(seed, 0)), set.brightness())
}

/// The right choice.
fn by_weight(seed: u64) -> impl FnOnce(&Bootstrap, &mut Primary<'_, f64>) -> u64 {
    move |set, _| set.choose(&mut stream(seed, 1)).expect("some sample is bright")
}

/// Samples of a set.
const SET: u64 = 16;

fn of_starts() -> Vec<Twin> {
    let of = "start of chains";
    vec![
        twin(
            (of, "mlt_independent_b"),
            "b from another set than that of the start, because it is a better estimate",
            (150_000, 22.3),
            |samples, seed| {
                let mut integrand = modes::integrand;
                let mut target = primary(&mut integrand);
                let scores = (0..samples).map(|index| {
                    let seed = seed(index);
                    let (score, _) = started(&mut target, (SET, seed), by_weight(seed));
                    let other = Bootstrap::draw(&mut target, SET, derive_seed(seed, 7)).expect(LAWFUL);
                    score * other.brightness() // right: that of the same set
                });
                scores.collect()
            },
        ),
        twin((of, "mlt_first"), "the first of the set as the start", (50_000, 82.7), |samples, seed| {
            let mut integrand = modes::integrand;
            let mut target = primary(&mut integrand);
            let scores = (0..samples).map(|index| {
                let (score, b) = started(&mut target, (SET, seed(index)), |_, _| 0);
                score * b
            });
            scores.collect()
        }),
        twin(
            (of, "mlt_brightest"),
            "the brightest of the set as the start",
            (10_000, 80.3),
            |samples, seed| {
                let mut integrand = modes::integrand;
                let mut target = primary(&mut integrand);
                let scores = (0..samples).map(|index| {
                    let seed = seed(index);
                    let (score, b) = started(&mut target, (SET, seed), |_, target| {
                        let mut weight =
                            |index: &u64| target.draw(&mut Seeded::new(derive_seed(seed, *index)));
                        (0..SET).max_by(|a, b| weight(a).total_cmp(&weight(b))).expect("there are some")
                    });
                    score * b
                });
                scores.collect()
            },
        ),
        twin(
            (of, "mlt_own_mean"),
            "images averaged first, and then scaled by the mean of all b",
            (120_000, 24.1),
            |samples, seed| {
                let mut integrand = modes::integrand;
                let mut target = primary(&mut integrand);
                let runs: Vec<(f64, f64)> = (0..samples)
                    .map(&mut *seed)
                    .map(|seed| started(&mut target, (SET, seed), by_weight(seed)))
                    .collect();
                let pooled = runs.iter().map(|(_, b)| b).sum::<f64>() / runs.len() as f64;
                runs.iter().map(|(score, _)| score * pooled).collect() // right: each by its own
            },
        ),
    ]
}

/// Scores of chains that find the left half six times as important, unscaled, with their b̂ and that of brightness alone, as `scale` has them.
fn important(
    (samples, seed): (u64, &mut dyn FnMut(u64) -> u64),
    scale: fn(f64, f64, f64) -> f64,
) -> Vec<f64> {
    let importance = Importance::new([2, 1], vec![6.0, 1.0]).expect(LAWFUL);
    let (mut first, mut second) = (modes::integrand, modes::integrand);
    let (mut target, mut plain) = (primary(&mut first).with_importance(&importance), primary(&mut second));
    let scores = (0..samples).map(|index| {
        let seed = seed(index);
        let (score, b) = started(&mut target, (SET, seed), by_weight(seed));
        // The same variates, another target.
        scale(score, b, Bootstrap::draw(&mut plain, SET, seed).expect(LAWFUL).brightness())
    });
    scores.collect()
}

fn of_learning() -> Vec<Twin> {
    let of = "noise-aware chains";
    vec![
        twin(
            (of, "aware_no_importance"),
            "scores are not divided by the importance of their pixel, which six times is that of the other",
            (10_000, 150.9),
            |samples, seed| important((samples, seed), |score, b, _| 6.0 * score * b), // right: score · b
        ),
        twin(
            (of, "aware_plain_brightness"),
            "b of the brightness, where the start was chosen by brightness · importance",
            (50_000, 1715.7),
            |samples, seed| important((samples, seed), |score, _, plain| score * plain), // right: score · b
        ),
        twin(
            ("population Monte Carlo", "mlt_own_adaptation"),
            "a chain that learns from its own steps: it turns to the least of them once a large one was accepted",
            (50_000, 61.5),
            |samples, seed| {
                let sizes = [[1e-5, 1e-4], [0.1, 0.5]]
                    .map(|[least, largest]| SmallStep::new(least, largest).expect(LAWFUL));
                let mut target = Own { sizes, present: 0.0, proposed: 0.0, size: 1, is_start: true };
                let plan = Plan::new(SET, 1, 40).expect(LAWFUL);
                let scores = (0..samples).map(|index| {
                    left(|film| {
                        plan.replica(&mut target, (0, seed(index)), film).expect(LAWFUL);
                    })
                });
                scores.collect()
            },
        ),
    ]
}

/// A chain with sizes of steps of its own.
struct Own {
    sizes: [SmallStep; 2],
    present: f64,
    proposed: f64,
    size: usize,
    is_start: bool,
}

impl Target<f64> for Own {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        self.proposed = source.next_uniform();
        (self.size, self.is_start) = (1, true);
        modes::height(self.proposed)
    }
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        self.is_start = false;
        self.proposed = self.sizes[self.size].from(self.present, source.next_uniform());
        let ratio = modes::height(self.proposed) / modes::height(self.present);
        Proposed { kind: 0, acceptance: ratio.min(1.0) }
    }
    fn accept(&mut self) {
        self.size = usize::from(self.is_start); // right: a size that does not look at what was accepted
        self.present = self.proposed;
    }
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, f64>) {
        film(modes::pixel(if which == Which::Present { self.present } else { self.proposed }), energy);
    }
    fn kinds(&self) -> &[&'static str] {
        &["step"]
    }
}

/// Scores of samples that hand their energy on to chains, so many on average: their number, and the energy of each over the right one, as `rule` makes
/// them of the number that is expected of a sample and of a variate.
fn handed_on(
    (samples, seed): (u64, &mut dyn FnMut(u64) -> u64),
    chains: f64,
    rule: fn(f64, f64) -> (u64, f64),
) -> Vec<f64> {
    const LENGTH: u64 = 10;
    let mut integrand = modes::integrand;
    let mut target = primary(&mut integrand);
    let energy = modes::image().iter().sum::<f64>() / (LENGTH as f64 * chains);
    let scores = (0..samples).map(|index| {
        let seed = seed(index);
        let (mut source, start) = (stream(seed, 0), derive_seed(seed, 0));
        let weight = target.draw(&mut Seeded::new(start));
        let (count, scale) = rule(weight / (LENGTH as f64 * energy), source.next_uniform());
        (0..count)
            .map(|_| {
                target.draw(&mut Seeded::new(start));
                target.accept();
                chain(&mut target, (LENGTH, energy * scale), &mut source)
            })
            .sum()
    });
    scores.collect()
}

/// ⌊x⌋ chains.
fn floor(x: f64) -> u64 {
    x.floor() as u64
}

fn of_energy() -> Vec<Twin> {
    let of = "energy redistribution";
    vec![
        twin(
            (of, "erpt_at_least_one"),
            "one chain at least of each sample",
            (200_000, 162.8),
            |samples, seed| {
                // Right: ⌊U + x⌋.
                handed_on((samples, seed), 0.5, |expected, u| (floor(u + expected).max(1), 1.0))
            },
        ),
        twin(
            (of, "erpt_capped"),
            "a greatest number of chains, and energy that is not raised for it",
            (150_000, 914.7),
            // Right: an energy of max(x, 1).
            |samples, seed| {
                handed_on((samples, seed), 2.0, |expected, u| (floor(u + expected.min(1.0)), 1.0))
            },
        ),
        twin(
            (of, "erpt_rounded"),
            "the number of chains rounded: antwerpen-2011 eq. 6.12 lost its floor",
            (2_000_000, 57.7),
            // Half a chain and more in the middle of the left mode alone: rounding makes none elsewhere.
            |samples, seed| handed_on((samples, seed), 0.14, |expected, _| (floor(0.5 + expected), 1.0)),
        ),
    ]
}
