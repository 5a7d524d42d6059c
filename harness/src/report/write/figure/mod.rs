//! The figures: each has a drawing, a caption and a table, all from the same part of the report.

mod anatomy;
mod convergence;
mod efficiency;
mod functions;
mod lookups;
mod sweep;
mod variance;

use super::draw::{Draw, Drawing, Legend, Rect, both};
use super::table::Table;
use crate::report::result::{MediumReport, Report};
use rayon::prelude::*;

/// A figure of a medium.
pub(crate) trait Figure: Draw {
    /// File name without ending.
    fn id(&self) -> String;
    /// One line.
    fn title(&self) -> String;
    /// What is seen, with numbers from the data.
    fn caption(&self) -> String;
    /// All that is drawn, one row per point.
    fn table(&self) -> Table;
}

/// A figure on its way into files and the page.
pub(crate) struct Finished {
    pub(crate) medium: String,
    pub(crate) id: String,
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) csv: String,
    pub(crate) drawing: Drawing,
}

type Painter<'a> = Box<dyn Fn() -> Result<Finished, String> + Send + Sync + 'a>;

/// All figures, in the order of the page, drawn in parallel.
pub(crate) fn all(report: &Report) -> Result<Vec<Finished>, String> {
    let painters: Vec<Painter<'_>> = report.media.iter().flat_map(of_medium).collect();
    painters.par_iter().map(|painter| painter()).collect()
}

fn of_medium(medium: &MediumReport) -> Vec<Painter<'_>> {
    let mut painters: Vec<Painter<'_>> = sweep::albedos(medium)
        .into_iter()
        .map(|albedo| painter(medium, variance::Variance { medium, albedo }))
        .collect();
    painters.push(painter(medium, lookups::Lookups { medium }));
    painters.push(painter(medium, efficiency::Efficiency { medium, cost: efficiency::Cost::Lookups }));
    painters.push(painter(medium, efficiency::Efficiency { medium, cost: efficiency::Cost::Seconds }));
    painters.push(painter(medium, convergence::Convergence { medium, cost: convergence::Cost::Lookups }));
    painters.push(painter(medium, convergence::Convergence { medium, cost: convergence::Cost::Seconds }));
    painters.push(painter(medium, anatomy::AnatomyFigure { medium }));
    painters.push(painter(medium, functions::Functions { medium }));
    painters
}

fn painter<'a>(medium: &'a MediumReport, figure: impl Figure + Send + 'a) -> Painter<'a> {
    Box::new(move || {
        let named = |error: String| format!("figure {}: {error}", figure.id());
        Ok(Finished {
            medium: medium.id.clone(),
            id: figure.id(),
            title: figure.title(),
            caption: figure.caption(),
            csv: figure.table().into_csv(),
            drawing: both(&figure).map_err(named)?,
        })
    })
}

/// Width of every figure in pixels.
pub(super) const WIDTH: u32 = 1600;
/// Left of the panels: labels and title of the y axis.
pub(super) const LEFT: f64 = 144.0;
/// Where the panels end.
pub(super) const RIGHT: f64 = 1600.0 - 28.0;
/// Below the panels: labels and title of the x axis.
pub(super) const FOOT: f64 = 100.0;
/// Where a legend begins.
pub(super) const LEGEND_LEFT: f64 = 40.0;
pub(super) const LEGEND_WIDTH: f64 = 1600.0 - 2.0 * LEGEND_LEFT;

/// The rectangle of the panels, and the size of a figure that has a legend below them.
pub(super) fn frame(top: f64, height: f64, legend: &Legend) -> (Rect, [u32; 2]) {
    let bottom = top + height;
    let whole = bottom + FOOT + legend.height() + 16.0;
    (Rect { left: LEFT, top, right: RIGHT, bottom }, [WIDTH, whole as u32])
}
