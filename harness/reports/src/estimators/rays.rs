//! Sixty rays per medium: the gain of every estimator over ratio tracking, per look-up and per second.

use super::sets::Arena;
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::comparison::{Bout, Contest, Entrant, Gain, Unit, contest, entrants, gain, pooled};
use fairflight_sources::named_seed;

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

pub(super) fn study(run: &Run<'_>, arena: &Arena) -> Result<Standings, Failure> {
    let seed = run.seed(format_args!("rays/{}", arena.id));
    let taking_part: Vec<Entrant> = entrants().into_iter().filter(|entrant| can(entrant, arena)).collect();
    let contest = contest(&arena.set, taking_part, arena.effort, seed, &|| run.advance())?;
    let baseline = contest.bouts[0].clone();
    let standing = |(entrant, bouts): (&Entrant, &Vec<Bout>)| {
        let of = |unit| gain(bouts, &baseline, unit, named_seed(seed, "bootstrap"));
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
    !entrant.needs_cells || entrant.on(ray, &fairflight_harness::comparison::Facts::default()).is_ok()
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
    let effort = arena.effort;
    let text = format!(
        "Gain is variance times cost of ratio tracking over that of the estimator, on the same ray: its geometric mean over rays, with an \
         interval over the choice of rays, and its least value. Variances are {} on {} samples per ray and estimator. The pilots of the \
         hybrid and of tuned roulettes, {:.0} look-ups on each earlier ray, are not charged; nor is the finding of cells.",
        if effort.closed { "closed forms where there are any, else measured" } else { "measured" },
        effort.samples,
        contest.pilot_lookups,
    );
    Section::new(
        &format!("rays-{}", arena.id),
        &format!("{} random rays: {}", arena.set.rays.len(), arena.set.name),
    )
    .with(arena.description.clone())
    .with(text)
    .with(chart(arena, rows))
    .with(table(arena, contest, rows))
}

/// A gain with its interval.
fn measured(gain: &Gain) -> Measured {
    Measured { value: gain.mean, interval: gain.interval }
}

fn chart(arena: &Arena, rows: &[Standing]) -> Chart {
    let curve = |label: &str, mark: &dyn Fn(f64, &Standing) -> Mark| {
        Curve::method(label).with_marks((1_u32..).zip(rows).map(|(i, row)| mark(f64::from(i), row)))
    };
    Chart::new(
            &format!("rays-{}-gain", arena.id),
            &format!("Gain over ratio tracking: {}", arena.set.name),
            Axis::linear("estimator, in the order of the table"),
            Axis::logarithmic("gain [1]"),
        ).with_caption("Per look-up and per second, geometric mean with its interval; and the worst ray per look-up. Above 1 is better than ratio tracking.").with_curves(vec![
            curve("per look-up", &|x, row| measured(&row.per_lookup).mark(x)),
            curve("per second", &|x, row| measured(&row.per_second).mark(x)),
            curve("worst ray, per look-up", &|x, row| Mark::at(x, row.per_lookup.worst)),
            Curve::reference("ratio tracking", [(0.0, 1.0), (rows.len() as f64 + 1.0, 1.0)]),
        ])
}

fn table(arena: &Arena, contest: &Contest, rows: &[Standing]) -> Table {
    let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
    Table::of(
        [
            &format!("gains-{}", arena.id),
            &format!("Estimators on {} rays", arena.set.name),
            "Negative share, greatest estimate and kurtosis are those of the worst ray. Ours: not published before, as far as we know. Telescoping at level ratio 0.9 on noise has a closed form that does not converge: what is measured there is what happened to be met.",
        ],
        (1..).zip(rows).zip(&contest.bouts).map(|((number, row), bouts)| (number, row, bouts)),
        &[
            ("number", "", &|(number, ..)| Cell::Count(*number)),
            ("estimator", "", &|(_, row, _)| Cell::text(row.name)),
            ("ours", "", &|(_, row, _)| Cell::Flag(!row.published)),
            ("look-ups", "1", &|(_, row, _)| Cell::Number(row.lookups)),
            ("gain per look-up", "1", &|(_, row, _)| measured(&row.per_lookup).cell()),
            ("worst", "1", &|(_, row, _)| Cell::Number(row.per_lookup.worst)),
            ("gain per second", "1", &|(_, row, _)| measured(&row.per_second).cell()),
            ("worst", "1", &|(_, row, _)| Cell::Number(row.per_second.worst)),
            ("time", "ns", &|(.., bouts)| Cell::Number(1e9 * mean(bouts, |bout| bout.seconds))),
            ("negative", "1", &|(.., bouts)| {
                Cell::Number(greatest(&mut bouts.iter().map(|bout| bout.negative)))
            }),
            ("maximum / T", "1", &|(.., bouts)| {
                Cell::Number(greatest(&mut bouts.iter().map(|bout| bout.maximum)))
            }),
            ("excess kurtosis", "1", &|(.., bouts)| {
                let kurtosis = greatest(&mut bouts.iter().filter_map(|bout| bout.kurtosis));
                Cell::maybe(kurtosis.is_finite().then_some(kurtosis))
            }),
            ("mean / T", "1", &|(.., bouts)| Cell::Number(mean(bouts, |bout| bout.relative_mean))),
        ],
    )
}
