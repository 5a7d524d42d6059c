//! R6: variates by the vertex that they are drawn for, against one flat vector.

use crate::compared::{Entry, Exact, REPLICAS};
use crate::measured::Measured;
use crate::run::Run;
use crate::scenes::MIXED;
use fairflight_document::{
    Arrangement, Axis, Cell, Chart, Claim, ClaimVerdict, Curve, Panel, Section, Table,
};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Extinctions \[1/length\].
const SIGMA_T: [f64; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];
/// σ_samp over σ_t: of 1.9 collisions 0.9 are null.
const MAJORANT: f64 = 1.9;
/// Samples per pixel of an image, and of each of the images of a reference; in the densest medium a quarter, which tells acceptance, where none tells efficiency.
const SAMPLES: u32 = 192;
const DENSEST: u32 = 48;
const REFERENCE: (u32, u32) = (1024, 4);
/// Measurements: for each extinction a reference and three methods.
pub(super) const STEPS: u64 = 4 * SIGMA_T.len() as u64;

/// Paths of one extinction: independent, and chains of either layout.
pub(super) struct Row {
    pub(super) sigma_t: f64,
    independent: Entry,
    flat: Entry,
    rows: Entry,
}

impl Row {
    fn chains(&self) -> [&Entry; 2] {
        [&self.flat, &self.rows]
    }

    /// Acceptance of small steps by rows over that of the flat vector.
    fn acceptance(&self) -> Measured {
        let [flat, rows] = self.chains().map(small_steps);
        rows.over(&flat)
    }

    /// The efficiency of rows, 1/(MSE · CPU s), over that of the flat vector.
    fn gain(&self) -> Option<Measured> {
        told(self.flat.cost.over(&self.rows.cost))
    }

    /// The same over that of independent paths.
    pub(super) fn over_paths(&self) -> Option<Measured> {
        told(self.independent.cost.over(&self.rows.cost))
    }

    /// That of the flat vector over independent paths.
    fn flat_over_paths(&self) -> Option<Measured> {
        told(self.independent.cost.over(&self.flat.cost))
    }
}

/// An efficiency as far as the images tell it: none where its interval spans a factor of a hundred, since a few samples make nearly all of the variance then.
fn told(efficiency: Measured) -> Option<Measured> {
    let [low, high] = efficiency.interval;
    (high < 100.0 * low).then_some(efficiency)
}

/// A cell of an efficiency, empty where none is told.
fn cell(efficiency: Option<Measured>) -> Cell {
    efficiency.map_or(Cell::Number(f64::NAN), |efficiency| efficiency.cell())
}

/// Mean probability to accept a small step; NaN for a method without any.
fn small_steps(entry: &Entry) -> Measured {
    let of = entry.images.moves().into_iter().find(|moves| moves.kind == "small_step");
    of.map_or(Measured::normal(f64::NAN, f64::NAN), |moves| moves.acceptance)
}

fn side(run: &Run<'_>) -> u32 {
    run.quick_or(12, 32)
}

pub(super) fn study(run: &Run<'_>) -> Result<Vec<Row>, Failure> {
    SIGMA_T.iter().map(|&sigma_t| row(run, sigma_t)).collect()
}

fn row(run: &Run<'_>, sigma_t: f64) -> Result<Row, Failure> {
    let subject = MIXED.subject(side(run))?.with("medium.sigma_t", sigma_t);
    // By the closed form, without null collisions: fewer variates and other ones.
    let seed = run.seed(format_args!("rows/{sigma_t}/reference"));
    let (samples, images) = REFERENCE;
    let exact = Exact::of(run, subject, (json!({ "kind": "path_tracer" }), samples), (seed, images))?;
    let entry = |name: &'static str, mut integrator: Value| {
        let sigma_samp = MAJORANT * sigma_t;
        integrator["sigma_samp"] = json!(sigma_samp);
        integrator["estimator"] = json!({ "kind": "double_particle", "sigma_samp": sigma_samp });
        let seed = run.seed(format_args!("rows/{sigma_t}/{name}"));
        let samples = if sigma_t < SIGMA_T[SIGMA_T.len() - 1] { SAMPLES } else { DENSEST };
        exact.entry(run, (name, integrator), (run.samples(samples), seed))
    };
    let chains =
        |rows: &str| json!({ "kind": "metropolis", "space": "primary", "over": "path_tracer", "rows": rows });
    Ok(Row {
        sigma_t,
        independent: entry("independent paths", json!({ "kind": "path_tracer" }))?,
        flat: entry("flat", chains("flat"))?,
        rows: entry("rows", chains("per_vertex"))?,
    })
}

/// Means that are too far above that of the reference.
pub(super) fn unsound(rows: &[Row]) -> Vec<String> {
    let far = rows.iter().flat_map(|row| {
        let entries = [&row.independent, &row.flat, &row.rows];
        entries.into_iter().filter_map(|entry| entry.too_bright(&format!("σ_t = {}", row.sigma_t)))
    });
    far.collect()
}

/// R6: variates by vertex are accepted more often than a flat vector.
///
/// Criterion: the acceptance of small steps by rows lies above that of the flat vector at each extinction, by 95 % intervals.
pub(super) fn r6(rows: &[Row]) -> Claim {
    let above: Vec<Option<bool>> = rows.iter().map(|row| row.acceptance().exceeds(1.0)).collect();
    let verdict = match (above.contains(&Some(true)), above.contains(&Some(false))) {
        _ if above.iter().all(|&it| it == Some(true)) => ClaimVerdict::Holds,
        (true, _) => ClaimVerdict::HoldsUnder,
        (false, true) => ClaimVerdict::DoesNotHold,
        (false, false) => ClaimVerdict::NotTestable,
    };
    let words = |row: &Row| {
        let [flat, by_vertex] = row.chains().map(|entry| small_steps(entry).value);
        let gain = row.gain().map_or_else(|| "not told".to_owned(), |gain| gain.words(2));
        format!("σ_t = {}: {flat:.3} to {by_vertex:.3}, efficiency {gain}", row.sigma_t)
    };
    Claim::new(
        ("R6", "raab-2008 4.4"),
        "Variates kept by vertex are accepted more often than one flat vector",
        rows.iter().map(words).collect::<Vec<_>>().join("; "),
        (
            verdict,
            "The more collisions a flight has, the more later variates a flat vector moves with each of them.",
        ),
    )
}

pub(super) fn section(run: &Run<'_>, rows: &[Row]) -> Section {
    let text = format!(
        "harness/scenes/mixed.json in gray, {side} x {side} pixels, with the extinction at the axis; path tracing with σ_samp = {MAJORANT} σ_t and ratio \
         tracking, so that a path draws as many variates as it meets collisions, of which some are null. States of a chain are these variates, one after the other \
         (flat), or by the vertex and the purpose that they are drawn for (rows). Large steps 0.3. Intervals are 95 %, from {REPLICAS} independent images of \
         {samples} samples per pixel, {fewer} in the densest, against {reference} by path tracing in closed form. No efficiency is told where its interval spans a factor of a hundred.",
        side = side(run),
        samples = run.samples(SAMPLES),
        fewer = run.samples(DENSEST),
        reference = run.samples(REFERENCE.0) * REFERENCE.1,
    );
    let x = || Axis::logarithmic("σ_t [1/length]");
    let curve = |name: &str, of: &dyn Fn(&Row) -> Option<Measured>| {
        Curve::joined(name, rows.iter().filter_map(|row| of(row).map(|measured| measured.mark(row.sigma_t))))
    };
    let acceptance = vec![
        curve("rows", &|row| Some(small_steps(&row.rows))),
        curve("flat", &|row| Some(small_steps(&row.flat))),
    ];
    let gain = vec![
        curve("rows", &Row::over_paths),
        curve("flat", &Row::flat_over_paths),
        Curve::reference("independent paths", [(SIGMA_T[0], 1.0), (SIGMA_T[SIGMA_T.len() - 1], 1.0)]),
    ];
    let panel = |curves: Vec<Curve>, y: Axis| Panel { curves, ..Panel::new("", x(), y) };
    let panels = vec![
        panel(acceptance, Axis::linear("acceptance of small steps [1]").within(0.0, 1.0)),
        panel(gain, Axis::logarithmic("efficiency over independent paths [1]")),
    ];
    let chart =
        Chart::of("rows-acceptance", "Acceptance and efficiency of a flat vector and of rows", panels);
    let chart = Chart { arrangement: Arrangement::Column, ..chart };
    let table = Table::of(
        ["rows-table", "Flat vector and rows", ""],
        rows,
        &[
            ("σ_t", "1/length", &|row| Cell::Number(row.sigma_t)),
            ("acceptance, flat", "1", &|row| small_steps(&row.flat).cell()),
            ("acceptance, rows", "1", &|row| small_steps(&row.rows).cell()),
            ("efficiency, rows over flat", "1", &|row| cell(row.gain())),
            ("efficiency, rows over independent paths", "1", &|row| cell(row.over_paths())),
            ("step over path, CPU time", "1", &|row| {
                Cell::Number(row.rows.seconds / row.independent.seconds)
            }),
        ],
    );
    Section::new("rows", "R6: variates by vertex").with(text).with(chart).with(table)
}
