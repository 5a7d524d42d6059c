//! The canonical plane of georgiev-2019: six profiles over transmittance and tightness of the majorant.

use crate::run::Run;
use fairflight_document::{Axis, Cell, Content, Grid, HeatMap, Numbers, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::comparison::{
    Bout, Effort, Entrant, Facts, TestRay, entrants, facts_of, fight, pooled,
};
use fairflight_harness::field::{ExpressionSpec, ProfileKind};
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::reference::Truth;
use fairflight_media::Tolerance;
use fairflight_sources::named_seed;

/// A profile: its name, and σ_t on a ray of length 1 up to a factor, the greatest value 1.
struct Shape {
    name: &'static str,
    formula: &'static str,
    /// ∫ of it.
    integral: f64,
}

/// As in georgiev-2019, whose widths are not printed: ours are a tenth for the bump and the hole.
const SHAPES: [Shape; 6] = [
    Shape { name: "const", formula: "1", integral: 1.0 },
    Shape { name: "cos", formula: "0.5 + 0.5*cos(6.283185307179586*s)", integral: 0.5 },
    Shape { name: "gauss", formula: "exp(-50*(s - 0.5)^2)", integral: 0.250_662_683_757_567_95 },
    Shape { name: "hole", formula: "1 - exp(-50*(s - 0.5)^2)", integral: 0.749_337_316_242_432 },
    Shape { name: "lin_inc", formula: "s", integral: 0.5 },
    Shape { name: "lin_dec", formula: "1 - s", integral: 0.5 },
];

/// What came of the plane.
pub(super) struct Plane {
    pub(super) sections: Vec<Section>,
    /// How many cells of all are won by whom, most first.
    pub(super) wins: Vec<(&'static str, usize)>,
    pub(super) cells: usize,
    pub(super) unsound: Vec<String>,
}

struct Centres {
    transmittances: Vec<f64>,
    tightnesses: Vec<f64>,
}

impl Centres {
    /// Transmittances are even in −ln T towards both ends, tightnesses in their logarithm.
    fn of(run: &Run<'_>) -> Self {
        let (columns, rows) = run.quick_or((3, 2), (16, 10));
        let logit = |x: f64| (x / (1.0 - x)).ln();
        let [low, high] = [logit(0.01), logit(0.99)];
        let along = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        Self {
            transmittances: (0..columns)
                .map(|i| 1.0 / (1.0 + (-(low + (high - low) * along(i, columns))).exp()))
                .collect(),
            tightnesses: (0..rows).map(|j| 0.05_f64.powf(1.0 - along(j, rows))).collect(),
        }
    }

    fn points(&self) -> usize {
        self.transmittances.len() * self.tightnesses.len()
    }
}

/// Estimates at a point of the plane.
fn samples(run: &Run<'_>) -> u64 {
    run.quick_or(1024, 2048)
}

/// Who meets the plane: all that need no cells.
fn players() -> Vec<Entrant> {
    entrants().into_iter().filter(|entrant| !entrant.needs_cells).collect()
}

pub(super) fn steps(run: &Run<'_>) -> u64 {
    (SHAPES.len() * players().len() * Centres::of(run).points()) as u64
}

/// A point of the plane.
fn point(shape: &Shape, transmittance: f64, tightness: f64) -> Result<TestRay, Failure> {
    let maximum = -transmittance.ln() / shape.integral;
    let sigma_t = format!("{maximum}*({})", shape.formula);
    let spec = ExpressionSpec { sigma_t, length: 1.0, majorant: None };
    let profile = spec.build(&fairflight_harness::field::MediumLibrary::default())?;
    let truth = Truth::of(&profile, Tolerance::TIGHT)?;
    // The rounding of the formula may lie above its exact maximum.
    Ok(TestRay { profile, truth, majorant: maximum * (1.0 + 1e-12) / tightness })
}

pub(super) fn study(run: &Run<'_>) -> Result<Plane, Failure> {
    let grid = Centres::of(run);
    let players = players();
    let samples = samples(run);
    let effort = Effort { samples, counted: samples / 4, closed: true };
    let points: Vec<(usize, f64, f64)> = (0..SHAPES.len())
        .flat_map(|shape| {
            let grid = &grid;
            grid.tightnesses.iter().flat_map(move |&tightness| {
                grid.transmittances.iter().map(move |&transmittance| (shape, transmittance, tightness))
            })
        })
        .collect();
    // Each point is a ray of its own, met by all: the pilot of a point teaches that point, with variates of its own.
    let bouts = try_in_parallel(points.len(), &|i| {
        let (shape, transmittance, tightness) = points[i];
        let ray = point(&SHAPES[shape], transmittance, tightness)?;
        let name = SHAPES[shape].name;
        let seed = run.seed(format_args!("plane/{name}/{transmittance:.6}/{tightness:.6}"));
        let facts: Facts = facts_of(&ray, named_seed(seed, "facts"));
        let bout = |player: &Entrant| {
            run.advance();
            fight(&ray, &player.on(&ray, &facts)?, effort, named_seed(seed, player.name))
        };
        players.iter().map(bout).collect::<Result<Vec<Bout>, Failure>>()
    })?;
    Ok(results(&grid, &players, &bouts, samples))
}

/// Variance times look-ups, in units of T²; what no variance is told apart from.
fn price(bout: &Bout) -> f64 {
    bout.relative_variance.max(1e-20) * bout.lookups.max(1.0)
}

/// A panel for each profile, of a value for each point.
fn panels<T>(grid: &Centres, bouts: &[Vec<Bout>], of: &dyn Fn(&[Bout]) -> Option<T>) -> Vec<Grid<Option<T>>> {
    let of_shape = |(shape, bouts): (&Shape, &[Vec<Bout>])| Grid {
        label: shape.name.to_owned(),
        x: grid.transmittances.clone(),
        y: grid.tightnesses.clone(),
        values: bouts.iter().map(|bouts| of(bouts)).collect(),
    };
    SHAPES.iter().zip(bouts.chunks(grid.points())).map(of_shape).collect()
}

fn results(grid: &Centres, players: &[Entrant], bouts: &[Vec<Bout>], samples: u64) -> Plane {
    let x = || Axis::linear("transmittance [1]").within(0.0, 1.0);
    let y = || Axis::logarithmic("tightness of the majorant [1]");
    let best =
        |bouts: &[Bout]| (0..bouts.len()).min_by(|&a, &b| price(&bouts[a]).total_cmp(&price(&bouts[b])));
    let mut wins: Vec<(&'static str, usize)> = players.iter().map(|player| (player.name, 0)).collect();
    for bouts in bouts {
        if let Some(winner) = best(bouts) {
            wins[winner].1 += 1;
        }
    }
    let gain = |bouts: &[Bout]| best(bouts).map(|winner| price(&bouts[0]) / price(&bouts[winner]));
    let winners = Content::Names {
        names: players.iter().map(|player| player.name.to_owned()).collect(),
        panels: panels(grid, bouts, &best),
        numbers: Some(Numbers {
            axis: Axis::logarithmic("gain of the winner over ratio tracking [1]"),
            isolines: vec![1.0, 10.0, 1e2, 1e4, 1e6, 1e8],
            panels: panels(grid, bouts, &gain).into_iter().map(|panel| panel.values).collect(),
        }),
    };
    wins.sort_by_key(|&(_, cells)| std::cmp::Reverse(cells));
    let caption = format!(
        "The estimator with the least variance times look-ups at each point, and how much it gains over ratio tracking (lines). Tightness is \
         the greatest extinction over the majorant. On const, cos and the lines combs have no variance but rounding: there the cheapest of them wins. {} of \
         {} points are won by {}.",
        wins[0].1,
        bouts.len(),
        wins[0].0
    );
    let title = "Who wins the canonical plane, per look-up";
    let winners = HeatMap { caption, ..HeatMap::new("plane-winners", title, x(), y(), winners) };
    let (table, unsound) = summary(players, bouts);
    let overview = Section::new("plane", "The canonical plane: who wins").with("georgiev-2019 compares estimators on six profiles over a plane: the transmittance, and how tight the majorant is. Each estimator has \
             the parameters that follow from the ray (its majorant, its length); hybrid and self-tuned roulettes know eight pilots of the same ray, \
             from variates of its own."
                .to_owned()).with(format!("Variances are closed forms where there are any; the others are measured on {samples} samples, and {samples} on every point test the mean.")).with(winners).with(table);
    let mut prices =
        Section::new("plane-efficiency", "The canonical plane: variance times look-ups of each estimator")
            .folded();
    let mut quantities =
        Section::new("plane-quantities", "The canonical plane: variance and look-ups of each estimator")
            .folded();
    for (e, player) in players.iter().enumerate() {
        let id = player.name.to_lowercase().replace(", ", "-").replace([' ', ','], "-");
        let map = |quantity: &str, title: &str, isolines: Vec<f64>, of: &dyn Fn(&Bout) -> f64| {
            let panels = panels(grid, bouts, &|bouts| Some(of(&bouts[e])).filter(|value| *value > 0.0));
            let content = Content::Values { colours: Axis::logarithmic(title), isolines, panels };
            HeatMap::new(
                &format!("plane-{quantity}-{id}"),
                &format!("{}: {title}", player.name),
                x(),
                y(),
                content,
            )
        };
        let decades = |from: i32, to: i32| (from..=to).map(|decade| 10_f64.powi(decade)).collect::<Vec<_>>();
        prices.blocks.push(map("price", "Var · look-ups/T² [1]", decades(-12, 6), &price).into());
        quantities
            .blocks
            .push(map("variance", "Var/T² [1]", decades(-14, 6), &|bout| bout.relative_variance).into());
        quantities.blocks.push(
            map("lookups", "look-ups [1]", vec![1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0], &|bout| {
                bout.lookups
            })
            .into(),
        );
    }
    Plane { sections: vec![overview, prices, quantities], wins, cells: bouts.len(), unsound }
}

/// Each estimator over the whole plane: points won, the middle of its gains, and whether its means are right.
fn summary(players: &[Entrant], bouts: &[Vec<Bout>]) -> (Table, Vec<String>) {
    let row = |(e, player): (usize, &Entrant)| {
        let mut gains: Vec<f64> = bouts.iter().map(|bouts| price(&bouts[0]) / price(&bouts[e])).collect();
        gains.sort_unstable_by(f64::total_cmp);
        let won =
            bouts.iter().filter(|bouts| bouts.iter().all(|other| price(other) >= price(&bouts[e]))).count();
        (player.name, gains, won, pooled(bouts.iter().map(|bouts| &bouts[e])))
    };
    let rows: Vec<_> = players.iter().enumerate().map(row).collect();
    let unsound = rows.iter().filter(|(.., pooled)| !pooled.is_sound()).map(|(name, .., pooled)| {
        format!("{name} on the canonical plane: means are off by {:.1} standard errors", pooled.z)
    });
    let table = Table::of(
        [
            "plane-summary",
            "The plane as a whole",
            "Gains per look-up over ratio tracking at the same point; the mean over all points whose law is mild enough, with its standard error.",
        ],
        &rows,
        &[
            ("estimator", "", &|(name, ..)| Cell::text(*name)),
            ("points won", "1", &|(_, _, won, _)| Cell::Count(*won as u64)),
            ("least gain", "1", &|(_, gains, ..)| Cell::Number(gains[0])),
            ("median gain", "1", &|(_, gains, ..)| Cell::Number(gains[gains.len() / 2])),
            ("greatest gain", "1", &|(_, gains, ..)| Cell::Number(gains[gains.len() - 1])),
            ("z of all means", "1", &|(.., pooled)| Cell::maybe((pooled.bouts > 0).then_some(pooled.z))),
            ("points in z", "1", &|(.., pooled)| Cell::Count(pooled.bouts as u64)),
        ],
    );
    (table, unsound.collect())
}
