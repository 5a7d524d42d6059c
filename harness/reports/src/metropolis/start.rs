//! A3: bias of the start of a chain, and what is without one whatever its chains reach.

use super::toy::{self, Kernel, SET, Start, Steps, TRUTH, bias, eigenvalue, integrand};
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{
    Arrangement, Axis, Cell, Chart, Claim, ClaimVerdict, Curve, Panel, Section, Table,
};
use fairflight_harness::parallel::in_parallel;
use fairflight_sources::named_seed;
use fairflight_stats::Moments;

/// Steps of chains.
const LENGTHS: [u64; 6] = [1, 4, 16, 64, 256, 1024];
/// Starts with their names.
const STARTS: [(&str, Start); 3] = [
    ("first sample that finds light, b exact", Start::FirstLit),
    ("chosen from 16 samples, b exact", Start::Chosen),
    ("start and b from the same 16 samples", Start::WithItsSet),
];
/// Kernels of energy redistribution, chains per sample, and the most.
const KERNELS: [(&str, Steps); 2] = [("idle", Steps::Idle), ("small steps alone", Steps::Small)];
const CAPS: [(f64, Option<u64>); 2] = [(1.0, None), (3.0, Some(1))];
const CHAINS: [u64; 3] = [1, 10, 100];
/// Parts of a measurement, which threads share.
const PARTS: usize = 32;
/// Replicas of chains of one step; of longer ones fewer from as many steps in all as [`LONG`] have.
const REPLICAS: u64 = 1 << 16;
const LONG: u64 = 128;

pub(super) const STEPS: u64 =
    (LENGTHS.len() * STARTS.len() + KERNELS.len() * CAPS.len() * CHAINS.len()) as u64;

/// Mean scores by length of chain.
pub(super) struct Study {
    /// Relative biases by start, in the order of [`STARTS`] and [`LENGTHS`].
    starts: Vec<Vec<Measured>>,
    redistributed: Vec<Redistributed>,
}

/// Energy redistribution by chains of one kind and length.
struct Redistributed {
    kernel: &'static str,
    steps: u64,
    chains: f64,
    most: Option<u64>,
    bias: Measured,
}

/// Number of chains of so many steps.
fn replicas(run: &Run<'_>, length: u64) -> u64 {
    run.quick_or(REPLICAS / 16, REPLICAS) * LONG / length.max(LONG)
}

/// The relative bias of a score, over replicas.
fn measure(
    run: &Run<'_>,
    name: &str,
    (steps, length): (Steps, u64),
    score: &(dyn Fn(&mut Kernel<'_>, u64) -> f64 + Sync),
) -> Measured {
    let seed = run.seed(format_args!("start/{name}/{length} steps"));
    let each = replicas(run, length) / PARTS as u64;
    let parts = in_parallel(PARTS, &|part| {
        let mut integrand = integrand;
        let mut kernel = Kernel::new(&mut integrand, steps);
        let numbers = part as u64 * each..(part as u64 + 1) * each;
        numbers
            .map(|k| score(&mut kernel, named_seed(seed, &format!("replica {k}"))) / TRUTH - 1.0)
            .collect::<Moments>()
    });
    let mut all = Moments::new();
    parts.iter().for_each(|part| all.merge(part));
    run.advance();
    Measured::normal(all.mean().unwrap_or(f64::NAN), all.standard_error().unwrap_or(f64::NAN))
}

pub(super) fn study(run: &Run<'_>) -> Study {
    let by_length = |(name, start): (&str, Start)| {
        let of = |steps: u64| {
            measure(run, name, (Steps::Both, steps), &|kernel, seed| start.score(kernel, steps, seed))
        };
        LENGTHS.map(of).to_vec()
    };
    let mut redistributed = Vec::new();
    for (kernel, kind) in KERNELS {
        for (chains, most) in CAPS {
            for steps in CHAINS {
                let how = (steps, chains, most);
                let bias =
                    measure(run, &format!("{kernel}/{chains} chains"), (kind, steps), &|kernel, seed| {
                        toy::redistributed(kernel, how, seed)
                    });
                redistributed.push(Redistributed { kernel, steps, chains, most, bias });
            }
        }
    }
    Study { starts: STARTS.map(by_length).to_vec(), redistributed }
}

/// Standard errors of a measured number from another.
fn z(measured: &Measured, expected: f64) -> f64 {
    (measured.value - expected) / ((measured.interval[1] - measured.value) / 1.96)
}

/// Standard errors that are too many: of twice fifteen numbers one is as far off by chance once in fifty thousand runs.
const MOST: f64 = 5.0;

impl Study {
    /// Deviations from the closed form of all starts, and from 0 of energy redistribution, in standard errors.
    fn deviations(&self) -> Vec<(String, f64)> {
        let starts = STARTS.iter().zip(&self.starts).flat_map(|((name, start), measured)| {
            let of = |(steps, found): (&u64, &Measured)| {
                (format!("{name}, {steps} steps"), z(found, bias(start.first(), *steps as f64)))
            };
            LENGTHS.iter().zip(measured).map(of).collect::<Vec<_>>()
        });
        let redistributed = self.redistributed.iter().map(|row| {
            (format!("energy redistribution, {}, {} steps", row.kernel, row.steps), z(&row.bias, 0.0))
        });
        starts.chain(redistributed).collect()
    }

    /// Means that are not what theory says, one sentence each.
    pub(super) fn unsound(&self) -> Vec<String> {
        let far = self.deviations().into_iter().filter(|(_, z)| z.abs() > MOST);
        far.map(|(name, z)| format!("{name}: {z:.1} standard errors from theory")).collect()
    }

    /// The first and the last number of a start.
    fn ends(&self, start: usize) -> String {
        let percent = |k: usize| self.starts[start][k].map(|x| 100.0 * x).words(2);
        let last = LENGTHS.len() - 1;
        format!("{} % after {} step, {} % after {}", percent(0), LENGTHS[0], percent(last), LENGTHS[last])
    }

    /// A3: chains have a start-up bias that fades with their length, and that a start chosen from the set that b comes from has not; energy
    /// redistribution has none without ergodicity.
    ///
    /// Criterion: the bias of the naive start lies below 0 by its 95 % interval at each length up to 64, and all biases are those of theory within five standard
    /// errors: the closed form of naive starts, 0 of ours and of energy redistribution by idle chains and by those that stay in their mode, with a
    /// cap and without.
    pub(super) fn a3(&self) -> Claim {
        let is_biased = LENGTHS.iter().zip(&self.starts[0]).filter(|(steps, _)| **steps <= 64);
        let is_biased = is_biased.map(|(_, bias)| bias.exceeds(0.0)).all(|sign| sign == Some(false));
        let greatest = |rows: &mut dyn Iterator<Item = &Measured>| {
            rows.map(|found| z(found, 0.0).abs()).fold(0.0, f64::max)
        };
        let [ours, redistributed] = [
            greatest(&mut self.starts[2].iter()),
            greatest(&mut self.redistributed.iter().map(|row| &row.bias)),
        ];
        Claim::new(
            ("A3", "antwerpen-2011 6.5, 6.8"),
            "The start-up bias of chains fades with their length and can be avoided; energy redistribution has none without ergodicity",
            format!(
                "naive start: {}; start and b from one set: {}, |z| at most {ours:.1}; energy redistribution: |z| at most {redistributed:.1}",
                self.ends(0),
                self.ends(2)
            ),
            (
                ClaimVerdict::of(is_biased && self.unsound().is_empty()),
                "Two modes of which a chain changes one for the other by large steps only: the bias decays by the second eigenvalue of that, and \
                 how fast is a matter of the scene. A start that is chosen by its weight, with a b from elsewhere, is biased as well.",
            ),
        )
    }

    /// The finding, in words.
    pub(super) fn summary(&self) -> String {
        format!(
            "A chain that starts where light was found first is off by {}; with start and b from one set by {}.",
            self.ends(0),
            self.ends(2)
        )
    }

    pub(super) fn section(&self, run: &Run<'_>) -> Section {
        let text = format!(
            "Two modes of the unit interval, as wide and three times and once as bright, in the dark; measured is the light of the brighter one, relative to its \
             own. Small steps (at most 0.04) stay in their mode, large ones, a tenth of all, change it. Which mode a state lies in is then a reversible chain \
             of two states, whose second eigenvalue is λ = {:.2}: a start that lies in the brighter mode with the probability q has the bias \
             (q − π)/π · λ(1 − λ^N)/(N(1 − λ)), π = 3/4, after N steps. First lit: q = 1/2. Chosen by weight from {SET} samples: q = {:.4}, since a ratio of means \
             is biased. Multiplied with the b of that very set: none, for any N, by stationarity alone. 95 % intervals, {} replicas of chains of one step.",
            eigenvalue(),
            Start::Chosen.first(),
            replicas(run, 1),
        );
        let panel = |heading: &str, range: [f64; 2]| {
            let y = Axis::linear("relative bias [1]").within(range[0], range[1]);
            let curve = |((name, start), measured): (&(&str, Start), &Vec<Measured>)| {
                let marks = LENGTHS.iter().zip(measured).map(|(steps, bias)| bias.mark(*steps as f64));
                let line = (0..=100).map(|k| 1024_f64.powf(f64::from(k) / 100.0));
                let line = line.map(|steps| (steps, bias(start.first(), steps)));
                Curve::method(name).with_line(line).with_marks(marks)
            };
            let curves = STARTS.iter().zip(&self.starts).map(curve).collect();
            Panel { curves, ..Panel::new(heading, Axis::logarithmic("steps of a chain [1]"), y) }
        };
        let panels = vec![panel("all", [-0.35, 0.05]), panel("enlarged", [-0.04, 0.02])];
        let chart = Chart::of("start-bias", "Start-up bias by the length of a chain", panels)
            .with_caption("Lines are closed forms.");
        let chart = Chart { arrangement: Arrangement::Column, ..chart };
        let table = Table::of(
            ["redistribution-table", "Energy redistribution without ergodicity", ""],
            &self.redistributed,
            &[
                ("kernel", "", &|row| Cell::text(row.kernel)),
                ("steps of a chain", "1", &|row| Cell::Count(row.steps)),
                ("chains per sample, on average", "1", &|row| Cell::Number(row.chains)),
                ("at most", "1", &|row| row.most.map_or(Cell::Empty, Cell::Count)),
                ("relative bias", "1", &|row| row.bias.cell()),
            ],
        );
        Section::new("start", "A3: the start of a chain").with(text).with(chart).with(
            "The same modes, redistributed: each sample starts as many chains as it found light, of steps that stand still, or that never leave a \
             mode. Where there may be one chain at most, it carries more.",
        ).with(table)
    }
}
