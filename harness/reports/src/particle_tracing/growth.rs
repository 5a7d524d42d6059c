//! Where a walk has a second moment.

use crate::measured::Measured;
use crate::run::{Part, Run};
use fairflight_collision::Version;
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table, Vertical};
use fairflight_harness::Failure;
use fairflight_media::phase::{Isotropic, Rayleigh};
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Medium, PhaseFunction};
use fairflight_paths::{Criticality, Growth, Uniform, Walk, second_moment_growth};
use fairflight_scene::Volume;
use fairflight_sources::Seeded;
use glam::DVec3;

/// σ_samp over the greatest extinction.
const RATIOS: [f64; 9] = [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2];

pub(super) fn steps() -> u64 {
    3 * RATIOS.len() as u64
}

struct Row {
    medium: &'static str,
    ratio: f64,
    growth: Growth,
    closed_form: Option<f64>,
}

impl Row {
    fn factor(&self) -> Measured {
        Measured::normal(self.growth.factor, self.growth.standard_error)
    }
}

pub(super) fn study(run: &Run<'_>) -> Result<Part, Failure> {
    let mut rows = Vec::new();
    let endless = Volume {
        medium: Homogeneous::new(1.0).map_err(Failure::refused)?,
        bounds: Bounds::sphere(DVec3::ZERO, 1e4).map_err(Failure::refused)?,
        albedo: 0.7,
        phase: Isotropic,
    };
    let small = Volume { bounds: Bounds::sphere(DVec3::ZERO, 1.0).map_err(Failure::refused)?, ..endless };
    let analytic = Volume {
        medium: AnalyticCosine::new(1.0).map_err(Failure::refused)?,
        bounds: AnalyticCosine::default_bounds(),
        albedo: 0.7,
        phase: Rayleigh,
    };
    // E[q_sum²] with r = 1/ratio everywhere, of an endless medium.
    let endless_form = |ratio: f64| {
        let r = 1.0 / ratio;
        Some((0.7 * r + (1.0 - r).abs()).powi(2))
    };
    measure(run, &endless, "homogeneous, 10 000 mean free paths", endless_form, &mut rows)?;
    measure(run, &small, "homogeneous, 1 mean free path", |_| None, &mut rows)?;
    measure(run, &analytic, "eq. 21", |_| None, &mut rows)?;
    let unsound = rows
        .iter()
        .filter_map(|row| {
            let form = row.closed_form?;
            let off = (row.growth.factor - form).abs();
            // What leaks from the surface of the large ball lowers the factor by less than 1e-3 of it.
            let granted = 5.0 * row.growth.standard_error + 1e-3 * form;
            (off > granted).then(|| {
                format!(
                    "growth at r = {:.3} is {:.4}, closed form {form:.4}",
                    1.0 / row.ratio,
                    row.growth.factor
                )
            })
        })
        .collect();
    Ok(Part { section: section(&rows), unsound })
}

fn measure<M: Medium, P: PhaseFunction>(
    run: &Run<'_>,
    volume: &Volume<M, P, f64>,
    medium: &'static str,
    closed_form: impl Fn(f64) -> Option<f64>,
    rows: &mut Vec<Row>,
) -> Result<(), Failure> {
    for &ratio in &RATIOS {
        let walk = Walk::new(Version::NonTerminating, Uniform::new(ratio).map_err(Failure::refused)?);
        let mut source = Seeded::new(run.seed(format_args!("growth/{medium}/{ratio}")));
        let growth = second_moment_growth(volume, &walk, &mut source);
        if let Some(growth) = growth {
            rows.push(Row { medium, ratio, growth, closed_form: closed_form(ratio) });
        }
        run.advance();
    }
    Ok(())
}

fn section(rows: &[Row]) -> Section {
    let text = "The sampling extinction is free for transmittance, not for walks. Per collision the squared energy of the non-terminating \
         version grows by q_sum² = (a r + |1 − r|)², above 1 where r > 2/(1 + a). Whether the second moment of a pixel exists is a question \
         of criticality: the growth from collision to collision, leaking out of the bounds included, must stay below 1. It is measured by \
         power iteration on populations of particles. Where it is above 1 there is no second moment, later no first one: a mean squared \
         error measured there is a number about the sample, not about the estimator. `harness render` refuses such a walk unless told \
         otherwise, and warns where the measurement cannot tell.";
    let mut media: Vec<&str> = rows.iter().map(|row| row.medium).collect();
    media.dedup();
    let curve = |medium: &str| {
        let of_medium = || rows.iter().filter(|row| row.medium == medium);
        let marks = of_medium().map(|row| {
            let Measured { value, interval: [low, high] } = row.factor();
            Measured { value, interval: [low.max(f64::MIN_POSITIVE), high] }.mark(row.ratio)
        });
        let line = of_medium().filter_map(|row| Some((row.ratio, row.closed_form?)));
        Curve::method(medium).with_line(line).with_marks(marks)
    };
    let one = Curve::reference("growth 1", [(RATIOS[0], 1.0), (RATIOS[RATIOS.len() - 1], 1.0)]);
    let chart = Chart::new(
        "growth-factor",
        "Growth of the squared energy per collision",
        Axis::logarithmic("σ_samp / greatest σ_t [1]"),
        Axis::logarithmic("growth per collision [1]"),
    )
    .with_caption(
        "Albedo 0.7, non-terminating. Above 1 there is no second moment. The line is (a r + |1 − r|)².",
    )
    .with_curves(media.into_iter().map(curve).chain([one]).collect())
    .with_verticals(vec![Vertical { x: 0.85, label: "r = 2/(1 + a)".to_owned() }]);
    let table = Table::of(
        ["growth-table", "Growth per collision", ""],
        rows,
        &[
            ("medium", "", &|row| Cell::text(row.medium)),
            ("σ_samp / greatest σ_t", "1", &|row| Cell::Number(row.ratio)),
            ("growth", "1", &|row| row.factor().cell()),
            ("closed form", "1", &|row| Cell::maybe(row.closed_form)),
            ("second moment", "", &|row| {
                Cell::text(match row.growth.criticality() {
                    Criticality::Subcritical => "exists",
                    Criticality::Unclear => "this measurement cannot tell",
                    Criticality::Supercritical => "none",
                })
            }),
        ],
    );
    Section::new("growth", "Where a walk has a second moment").with(text).with(chart).with(table)
}
