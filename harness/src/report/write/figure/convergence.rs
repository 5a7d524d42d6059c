//! Root mean squared error against cost: unbiased estimators fall forever, biased baselines end on their floor.

use super::{FOOT, Figure, LEGEND_LEFT, LEGEND_WIDTH, frame};
use crate::report::result::{ConvergenceCurve, ConvergencePoint, MediumReport};
use crate::report::write::draw::{
    Axis, Canvas, Draw, Drawn, FAINT, Fill, INK, Labels, Legend, Panel, Sign, Stroke,
};
use crate::report::write::number::{listed, short};
use crate::report::write::palette::{label, look, rank};
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

/// What is paid.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    Lookups,
    Seconds,
}

pub(super) struct Convergence<'a> {
    pub(super) medium: &'a MediumReport,
    pub(super) cost: Cost,
}

const TOP: f64 = 24.0;
const HEIGHT: f64 = 760.0;
const FLOOR: &[f64] = &[3.0, 5.0];

impl Convergence<'_> {
    fn curves(&self) -> Vec<&ConvergenceCurve> {
        let mut curves: Vec<&ConvergenceCurve> = self.medium.convergence.iter().collect();
        curves.sort_by_key(|curve| rank(curve.series));
        curves
    }

    fn points(&self) -> impl Iterator<Item = &ConvergencePoint> {
        self.medium.convergence.iter().flat_map(|curve| &curve.points)
    }

    fn x(&self, point: &ConvergencePoint) -> f64 {
        match self.cost {
            Cost::Lookups => point.lookups.log10(),
            Cost::Seconds => point.seconds.log10(),
        }
    }

    fn panel(&self, legend: &Legend) -> Panel {
        let (rect, _) = frame(TOP, HEIGHT, legend);
        let title = if self.cost == Cost::Lookups { "look-ups" } else { "CPU time [s]" };
        let x = Axis::logarithmic(title, self.points().map(|point| self.x(point)));
        let errors = self.points().flat_map(|point| [Some(point.relative_rmse), point.predicted]);
        let y = Axis::decades("RMSE/T [1]", errors.flatten().map(f64::log10), [-8.0, 6.0]);
        Panel { rect, x, y }
    }

    fn legend(&self) -> Legend {
        let series = self.curves().into_iter().map(|curve| curve.series);
        let remarks = [
            (Sign::Interval, "measured, 95 % interval"),
            (Sign::Line(Stroke::solid(INK, 2.5)), "line: predicted in closed form"),
            (Sign::Line(Stroke { colour: FAINT, width: 2.0, dash: FLOOR }), "bias of a baseline"),
        ];
        Legend::new(series, &remarks, LEGEND_WIDTH)
    }
}

impl Draw for Convergence<'_> {
    fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &self.legend()).1
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let legend = self.legend();
        let panel = self.panel(&legend);
        panel.axes(canvas, Labels::Both)?;
        let curves = self.curves();
        for curve in curves.iter().rev() {
            let look = look(curve.series);
            let predicted = |point: &ConvergencePoint| Some((self.x(point), point.predicted?.log10()));
            let line: Vec<_> = curve.points.iter().map(predicted).collect();
            panel.curve(canvas, &line, Stroke { colour: look.colour, width: 2.5, dash: look.dash })?;
            let bias = |point: &ConvergencePoint| {
                (point.relative_bias > 0.0).then(|| (self.x(point), point.relative_bias.log10()))
            };
            let floor: Vec<_> = curve.points.iter().map(bias).collect();
            panel.curve(canvas, &floor, Stroke { colour: look.colour, width: 2.0, dash: FLOOR })?;
        }
        for curve in curves.iter().rev() {
            let look = look(curve.series);
            for point in &curve.points {
                let at = (self.x(point), point.relative_rmse.log10());
                let interval = point.interval.map(|x| x.max(0.0).log10());
                panel.mark(canvas, at, Some(interval), (look.marker, look.colour, Fill::Solid))?;
            }
        }
        legend.draw(canvas, (LEGEND_LEFT, panel.rect.bottom + FOOT))
    }
}

impl Figure for Convergence<'_> {
    fn id(&self) -> String {
        let cost = if self.cost == Cost::Lookups { "lookups" } else { "seconds" };
        format!("{}-error-against-{cost}", self.medium.id)
    }

    fn title(&self) -> String {
        let cost = if self.cost == Cost::Lookups { "look-ups" } else { "CPU time" };
        format!("Error against {cost}")
    }

    fn caption(&self) -> String {
        let mut caption = "Root mean squared error in units of T against cost: measured over independent replicas (marks) and predicted \
                           in closed form (lines). The error of an unbiased estimator falls with the square root of the cost."
            .to_owned();
        let floors: Vec<String> = self
            .curves()
            .into_iter()
            .filter(|curve| curve.series.is_baseline())
            .filter_map(|curve| {
                let last = curve.points.last()?;
                let name = look(curve.series).name;
                Some(format!("{} for {name}", short(last.relative_bias)))
            })
            .collect();
        if !floors.is_empty() {
            caption.push_str(&format!(" |bias|/T at the greatest cost: {}.", listed(&floors)));
        }
        let parameters: Vec<String> = self
            .curves()
            .into_iter()
            .filter(|curve| !curve.parameters.is_empty())
            .map(|curve| label(curve.series, &curve.parameters))
            .collect();
        if !parameters.is_empty() {
            caption.push_str(&format!(" Parameters — {}.", parameters.join("; ")));
        }
        caption
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "series",
            "parameters",
            "estimates",
            "replicas",
            "look-ups",
            "CPU time [s]",
            "RMSE/T [1]",
            "lower end of 95 % interval [1]",
            "upper end of 95 % interval [1]",
            "|bias|/T [1]",
            "predicted RMSE/T [1]",
        ]);
        for curve in self.curves() {
            for point in &curve.points {
                table.row(&[
                    Cell::Text(look(curve.series).name),
                    Cell::Text(&curve.parameters),
                    Cell::Count(point.estimates),
                    Cell::Count(point.replicas),
                    Cell::Number(point.lookups),
                    Cell::Number(point.seconds),
                    Cell::Number(point.relative_rmse),
                    Cell::Number(point.interval[0]),
                    Cell::Number(point.interval[1]),
                    Cell::Number(point.relative_bias),
                    Cell::Maybe(point.predicted),
                ]);
            }
        }
        table
    }
}
