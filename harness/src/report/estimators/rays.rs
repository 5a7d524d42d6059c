//! Sixty rays per medium: the gain of every estimator over ratio tracking, per look-up and per second.

use super::sets::Arena;
use crate::Failure;
use crate::comparison::{Bout, Contest, Entrant, Gain, Unit, contest, entrants, gain, pooled};
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::run::Run;

/// The part of the report, for its seeds.
const PART: u64 = 20;

/// What an estimator did on a set.
pub(super) struct Standing {
    pub(super) name: &'static str,
    pub(super) published: bool,
    pub(super) lookups: f64,
    pub(super) per_lookup: Gain,
    pub(super) per_second: Gain,
    pub(super) unsound: Option<String>,
}

/// All estimators on a set.
pub(super) struct Standings {
    pub(super) id: &'static str,
    pub(super) set: String,
    pub(super) rows: Vec<Standing>,
    pub(super) section: Section,
}

impl Standings {
    pub(super) fn of(&self, name: &str) -> Option<&Standing> {
        self.rows.iter().find(|row| row.name == name)
    }

    /// The published estimator with the greatest geometric mean per look-up.
    pub(super) fn best_published(&self) -> Option<&Standing> {
        let published = self.rows.iter().filter(|row| row.published);
        published.max_by(|a, b| a.per_lookup.mean.total_cmp(&b.per_lookup.mean))
    }
}

/// Bouts of a set.
pub(super) fn steps(arena: &Arena) -> u64 {
    (entrants().len() * arena.set.rays.len()) as u64
}

pub(super) fn study(run: &Run<'_>, arena: &Arena, k: u64) -> Result<Standings, Failure> {
    let seed = run.seed(PART, k);
    let taking_part: Vec<Entrant> = entrants().into_iter().filter(|entrant| can(entrant, arena)).collect();
    let contest = contest(&arena.set, taking_part, arena.effort, seed, &|| run.advance())?;
    let baseline = contest.bouts[0].clone();
    let standing = |(entrant, bouts): (&Entrant, &Vec<Bout>)| {
        let of = |unit| gain(bouts, &baseline, unit, seed);
        Some(Standing {
            name: entrant.name,
            published: entrant.published,
            lookups: mean(bouts, |bout| bout.lookups),
            per_lookup: of(Unit::Lookups)?,
            per_second: of(Unit::Seconds)?,
            unsound: unsound(entrant.name, &arena.set.name, bouts),
        })
    };
    let rows: Vec<Standing> = contest.entrants.iter().zip(&contest.bouts).filter_map(standing).collect();
    let section = section(arena, &contest, &rows);
    Ok(Standings { id: arena.id, set: arena.set.name.clone(), rows, section })
}

/// Whether an entrant can take part: cells are not to be had of every medium.
fn can(entrant: &Entrant, arena: &Arena) -> bool {
    let Some(ray) = arena.set.rays.first() else { return false };
    !entrant.needs_cells || entrant.on(ray, &crate::comparison::Facts::default()).is_ok()
}

fn mean(bouts: &[Bout], of: impl Fn(&Bout) -> f64) -> f64 {
    bouts.iter().map(of).sum::<f64>() / bouts.len() as f64
}

/// The mean of all rays is off by more than chance would have it.
fn unsound(name: &str, set: &str, bouts: &[Bout]) -> Option<String> {
    let pooled = pooled(bouts.iter());
    (!pooled.is_sound()).then(|| {
        format!(
            "{name} on the {set} rays: its mean is off by {:.1} standard errors over {} rays",
            pooled.z, pooled.bouts
        )
    })
}

fn section(arena: &Arena, contest: &Contest, rows: &[Standing]) -> Section {
    let mut section = Section::new(
        &format!("rays-{}", arena.id),
        &format!("{} random rays: {}", arena.set.rays.len(), arena.set.name),
    );
    section.text = vec![
        arena.description.clone(),
        format!(
            "Gain is variance times cost of ratio tracking over that of the estimator, on the same ray: its geometric mean over rays, with an \
             interval over the choice of rays, and its least value. Variances are {} on {} samples per ray and estimator. The pilots of the \
             hybrid and of tuned roulettes, {:.0} look-ups on each earlier ray, are not charged; nor is the finding of cells.",
            if arena.effort.closed { "closed forms where there are any, else measured" } else { "measured" },
            arena.effort.samples,
            contest.pilot_lookups,
        ),
    ];
    section.charts = vec![chart(arena, rows)];
    section.tables = vec![table(arena, contest, rows)];
    section
}

/// A value with its interval, if it has one.
type Shown = (f64, Option<[f64; 2]>);

fn chart(arena: &Arena, rows: &[Standing]) -> Chart {
    let mut chart = Chart::new(
        &format!("rays-{}-gain", arena.id),
        &format!("Gain over ratio tracking: {}", arena.set.name),
        Axis::linear("estimator, in the order of the table"),
        Axis::logarithmic("gain [1]"),
    );
    chart.caption =
        "Per look-up and per second, geometric mean with its interval; and the worst ray per look-up. Above 1 is better than ratio tracking."
            .to_owned();
    let marks = |of: &dyn Fn(&Standing) -> Shown| {
        rows.iter()
            .enumerate()
            .map(|(i, row)| {
                let (value, interval) = of(row);
                let x = (i + 1) as f64;
                interval.map_or_else(|| Mark::at(x, value), |interval| Mark::measured(x, value, interval))
            })
            .collect::<Vec<_>>()
    };
    chart.curves = vec![
        Curve::method("per look-up")
            .with_marks(marks(&|row| (row.per_lookup.mean, Some(row.per_lookup.interval)))),
        Curve::method("per second")
            .with_marks(marks(&|row| (row.per_second.mean, Some(row.per_second.interval)))),
        Curve::method("worst ray, per look-up").with_marks(marks(&|row| (row.per_lookup.worst, None))),
        Curve::reference("ratio tracking", [(0.0, 1.0), (rows.len() as f64 + 1.0, 1.0)]),
    ];
    chart
}

fn table(arena: &Arena, contest: &Contest, rows: &[Standing]) -> Table {
    let mut table = Table::new(
        &format!("gains-{}", arena.id),
        &format!("Estimators on {} rays", arena.set.name),
        "Negative share, greatest estimate and kurtosis are those of the worst ray. Ours: not published before, as far as we know. Telescoping at level ratio 0.9 on noise has a closed form that does not converge: what is measured there is what happened to be met.",
        &[
            ("number", ""),
            ("estimator", ""),
            ("ours", ""),
            ("look-ups", "1"),
            ("gain per look-up", "1"),
            ("worst", "1"),
            ("gain per second", "1"),
            ("worst", "1"),
            ("time", "ns"),
            ("negative", "1"),
            ("maximum / T", "1"),
            ("excess kurtosis", "1"),
            ("mean / T", "1"),
        ],
    );
    for (i, (row, bouts)) in rows.iter().zip(&contest.bouts).enumerate() {
        let most = |of: &dyn Fn(&Bout) -> f64| bouts.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let kurtosis = bouts.iter().filter_map(|bout| bout.kurtosis).fold(f64::NEG_INFINITY, f64::max);
        table.rows.push(vec![
            Cell::Count(i as u64 + 1),
            Cell::text(row.name),
            Cell::Flag(!row.published),
            Cell::Number(row.lookups),
            Cell::measured(row.per_lookup.mean, row.per_lookup.interval),
            Cell::Number(row.per_lookup.worst),
            Cell::measured(row.per_second.mean, row.per_second.interval),
            Cell::Number(row.per_second.worst),
            Cell::Number(1e9 * mean(bouts, |bout| bout.seconds)),
            Cell::Number(most(&|bout| bout.negative)),
            Cell::Number(most(&|bout| bout.maximum)),
            Cell::maybe(kurtosis.is_finite().then_some(kurtosis)),
            Cell::Number(mean(bouts, |bout| bout.relative_mean)),
        ]);
    }
    table
}
