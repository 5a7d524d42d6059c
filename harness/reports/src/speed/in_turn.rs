//! Loops that are timed in turn.

use crate::measured::Measured;
use crate::run::Run;
use cpu_time::ThreadTime;
use fairflight_document::{Cell, ColumnOf, Table};
use fairflight_elementary::InstructionSet;
use fairflight_harness::{Failure, interrupt};
use std::hint::black_box;

/// Work whose sum keeps the compiler from leaving it out.
pub(super) type Loop<'a> = &'a mut dyn FnMut() -> f64;

/// Loops that do the same work: the parts that it cannot do without, one after the other, and in lanes if it has them.
pub(super) struct Loops<'a> {
    pub(super) bare: Loop<'a>,
    pub(super) one_by_one: Loop<'a>,
    pub(super) in_lanes: &'a mut dyn FnMut(InstructionSet) -> f64,
}

/// Times of loops that do the same work.
pub(super) struct Row {
    pub(super) name: String,
    /// Look-ups, collisions or connections of a loop, per walk or point.
    pub(super) per_walk: f64,
    /// CPU time of the bare parts of one of them \[ns\].
    pub(super) bare: Measured,
    /// CPU time of one of them, one after the other \[ns\].
    pub(super) one_by_one: Measured,
    /// The second over the first.
    pub(super) over_bare: Measured,
    /// Times one after the other over those in lanes, by instruction set of this machine.
    pub(super) gains: Vec<Measured>,
}

impl Row {
    /// Times loops of so many `units` of work in turn.
    pub(super) fn of(
        run: &Run<'_>,
        name: impl Into<String>,
        (units, walks): (f64, f64),
        loops: Loops<'_>,
    ) -> Result<Self, Failure> {
        let Loops { bare, one_by_one, in_lanes } = loops;
        let sets: Vec<InstructionSet> = InstructionSet::of_this_machine().collect();
        let seconds = in_turn(run, || {
            let mut times = vec![time(bare), time(one_by_one)];
            times.extend(sets.iter().map(|&set| time(&mut || in_lanes(set))));
            times
        })?;
        let (bare, one_by_one, lanes) = (&seconds[0], &seconds[1], &seconds[2..]);
        let nanoseconds = |seconds: &[f64]| Measured::positive(&scaled(seconds, 1e9 / units));
        Ok(Self {
            name: name.into(),
            per_walk: units / walks,
            bare: nanoseconds(bare),
            one_by_one: nanoseconds(one_by_one),
            over_bare: ratio(one_by_one, bare),
            gains: lanes.iter().map(|seconds| ratio(one_by_one, seconds)).collect(),
        })
    }

    /// A table of rows; `unit` is the work that times are of, `walk` a group of it. Lanes are told as times as fast as one after the other.
    pub(super) fn table([id, title, caption]: [&str; 3], [unit, walk]: [&str; 2], rows: &[Self]) -> Table {
        let per_walk = format!("{unit}s per {walk}");
        let names: Vec<String> =
            InstructionSet::of_this_machine().map(|set| format!("lanes, {}", set.name())).collect();
        let gains: Vec<_> = (0..names.len()).map(|at| move |row: &&Self| row.gains[at].cell()).collect();
        let mut columns: Vec<ColumnOf<'_, &Self>> = vec![
            ("", "", &|row| Cell::text(&row.name)),
            (&per_walk, "1", &|row| Cell::Number(row.per_walk)),
            ("bare parts", "ns", &|row| row.bare.cell()),
            ("one after the other", "ns", &|row| row.one_by_one.cell()),
            ("ratio", "1", &|row| row.over_bare.cell()),
        ];
        columns.extend(
            names.iter().zip(&gains).map(|(name, gain)| -> ColumnOf<'_, &Self> { (name, "1", gain) }),
        );
        Table::of([id, title, caption], rows, &columns)
    }

    /// A sentence on what a unit of work costs over its bare parts, and what lanes gain at most.
    pub(super) fn finding(work: &str, rows: &[Self]) -> String {
        let range = |of: &dyn Fn(&Self) -> f64| {
            let values = rows.iter().map(of);
            values.fold([f64::INFINITY, 0.0], |[low, high], x| [x.min(low), x.max(high)])
        };
        let [low, high] = range(&|row| row.over_bare.value);
        let [least, most] = range(&|row| row.gains.last().map_or(1.0, |gain| gain.value));
        format!(
            "{work} costs {low:.2} to {high:.2} times its bare parts; in lanes, by the widest set, it is {least:.2} to {most:.2} times as fast."
        )
    }
}

/// CPU seconds of some loops in each round, by loop.
fn in_turn(run: &Run<'_>, mut round: impl FnMut() -> Vec<f64>) -> Result<Vec<Vec<f64>>, Failure> {
    // The first round fills caches, and counts for nothing.
    let mut seconds = vec![Vec::new(); round().len()];
    for _ in 0..run.quick_or(3, 15) {
        interrupt::check()?;
        seconds.iter_mut().zip(round()).for_each(|(all, seconds)| all.push(seconds));
    }
    run.advance();
    Ok(seconds)
}

/// The mean ratio of the times of two loops that run in turn.
pub(super) fn compare(run: &Run<'_>, a: Loop<'_>, b: Loop<'_>) -> Result<Measured, Failure> {
    let seconds = in_turn(run, || vec![time(a), time(b)])?;
    Ok(ratio(&seconds[0], &seconds[1]))
}

fn time(work: Loop<'_>) -> f64 {
    let clock = ThreadTime::now();
    black_box(work());
    clock.elapsed().as_secs_f64()
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// The mean ratio of times of the same rounds.
fn ratio(a: &[f64], b: &[f64]) -> Measured {
    let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
    Measured::positive(&ratios)
}
