//! What the figures over σ_samp share: which curves belong to an albedo, and a row of panels, one per albedo.

use super::{LEGEND_LEFT, LEGEND_WIDTH, frame};
use crate::report::result::{MediumReport, SweepCurve};
use crate::report::write::draw::{Axis, Canvas, Drawn, Labels, Legend, Panel, Sign, Stroke, side_by_side};
use crate::report::write::palette::{look, rank};
use plotters::backend::DrawingBackend;

/// The axis title of all sweeps.
pub(super) const SIGMA_SAMP: &str = "σ_samp [1/length]";

/// The albedos for which there are curves of their own, increasing; a single none where no curve depends on it.
pub(super) fn albedos(medium: &MediumReport) -> Vec<Option<f64>> {
    let mut known: Vec<f64> = medium.sweeps.iter().filter_map(|curve| curve.albedo).collect();
    known.sort_by(f64::total_cmp);
    known.dedup();
    if known.is_empty() { vec![None] } else { known.into_iter().map(Some).collect() }
}

/// The curves at an albedo: its own, and those that do not depend on it, in the order of legends.
pub(super) fn curves(medium: &MediumReport, albedo: Option<f64>) -> Vec<&SweepCurve> {
    let mut curves: Vec<&SweepCurve> =
        medium.sweeps.iter().filter(|curve| curve.albedo.is_none() || curve.albedo == albedo).collect();
    curves.sort_by_key(|curve| rank(curve.series));
    curves
}

/// log10 of all σ_samp.
pub(super) fn positions(medium: &MediumReport) -> impl Iterator<Item = f64> {
    medium.sweeps.iter().flat_map(|curve| &curve.points).map(|point| point.sigma_samp.log10())
}

/// The line of a curve.
pub(super) fn stroke(curve: &SweepCurve, width: f64) -> Stroke {
    let look = look(curve.series);
    Stroke { colour: look.colour, width, dash: look.dash }
}

/// A row of panels with a common y axis and one legend.
pub(super) struct Row<'a> {
    medium: &'a MediumReport,
    y: Axis,
    legend: Legend,
}

const TOP: f64 = 56.0;
const HEIGHT: f64 = 640.0;

impl<'a> Row<'a> {
    pub(super) fn new(medium: &'a MediumReport, y: Axis, remarks: &[(Sign, &str)]) -> Self {
        let series = medium.sweeps.iter().map(|curve| curve.series);
        Self { medium, y, legend: Legend::new(series, remarks, LEGEND_WIDTH) }
    }

    pub(super) fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &self.legend).1
    }

    /// Draws axes and legend, and lets `data` fill each panel.
    pub(super) fn draw<DB: DrawingBackend>(
        self,
        canvas: &Canvas<DB>,
        data: impl Fn(&Panel, &SweepCurve) -> Drawn,
    ) -> Drawn {
        let albedos = albedos(self.medium);
        let (all, _) = frame(TOP, HEIGHT, &self.legend);
        for (k, (rect, &albedo)) in
            side_by_side(all, albedos.len(), 30.0).into_iter().zip(&albedos).enumerate()
        {
            let x = Axis::logarithmic(SIGMA_SAMP, positions(self.medium));
            let panel = Panel { rect, x, y: self.y.clone() };
            panel.axes(canvas, if k == 0 { Labels::Both } else { Labels::XOnly })?;
            if let Some(albedo) = albedo {
                panel.heading(canvas, &format!("albedo {albedo}"))?;
            }
            panel.vertical(canvas, self.medium.ray.maximum.log10())?;
            // The first series of the legend are drawn last, on top.
            for curve in curves(self.medium, albedo).into_iter().rev() {
                data(&panel, curve)?;
            }
        }
        self.legend.draw(canvas, (LEGEND_LEFT, all.bottom + super::FOOT))
    }
}
