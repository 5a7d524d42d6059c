//! Look-ups per estimate against σ_samp.

use super::Figure;
use super::sweep::{Row, stroke};
use crate::report::result::{MediumReport, SweepPoint};
use crate::report::write::draw::{Axis, Canvas, Draw, Drawn, FAINT, Fill, Legend, Sign};
use crate::report::write::number::short;
use crate::report::write::palette::{Marker, look};
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

pub(super) struct Lookups<'a> {
    pub(super) medium: &'a MediumReport,
}

impl Lookups<'_> {
    fn row(&self) -> Row<'_> {
        let values = self
            .medium
            .sweeps
            .iter()
            .flat_map(|curve| &curve.points)
            .flat_map(|point| [point.lookups, point.measured.as_ref().map(|measured| measured.lookups)]);
        let y = Axis::decades("look-ups per estimate", values.flatten().map(f64::log10), [-4.0, 8.0]);
        let measured = (Sign::Mark(Marker::Circle, FAINT, Fill::Solid), "measured");
        Row::new(self.medium, y, &[measured, Legend::maximum()])
    }

    /// The greatest relative difference of measured from expected look-ups, where one look-up or more was made by all estimates.
    fn difference(&self) -> Option<f64> {
        let points = self.medium.sweeps.iter().flat_map(|curve| &curve.points);
        points
            .filter_map(|point| Some((point.lookups?, point.measured.as_ref()?.lookups)))
            .filter(|&(expected, _)| expected > 0.0)
            .map(|(expected, measured)| (measured / expected - 1.0).abs())
            .max_by(f64::total_cmp)
    }
}

impl Draw for Lookups<'_> {
    fn size(&self) -> [u32; 2] {
        self.row().size()
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        self.row().draw(canvas, |panel, curve| {
            let place = |point: &SweepPoint| {
                let y = point.lookups.filter(|_| point.in_domain)?;
                Some((point.sigma_samp.log10(), y.log10()))
            };
            let line: Vec<_> = curve.points.iter().map(place).collect();
            panel.curve(canvas, &line, stroke(curve, 2.5))?;
            let look = look(curve.series);
            for point in &curve.points {
                if let Some(measured) = &point.measured {
                    let at = (point.sigma_samp.log10(), measured.lookups.log10());
                    panel.mark(canvas, at, None, (look.marker, look.colour, Fill::Solid))?;
                }
            }
            Ok(())
        })
    }
}

impl Figure for Lookups<'_> {
    fn id(&self) -> String {
        format!("{}-lookups", self.medium.id)
    }

    fn title(&self) -> String {
        "Look-ups per estimate".to_owned()
    }

    fn caption(&self) -> String {
        let mut caption = "Evaluations of σ_t that one estimate takes on average, its explorers included: expected (lines) and counted \
                           (marks). For the baselines σ_samp times the length is the number of steps."
            .to_owned();
        if let Some(difference) = self.difference() {
            let percent = short(100.0 * difference);
            caption.push_str(&format!(" Counted and expected differ by {percent} % at most."));
        }
        caption
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "series",
            "parameters",
            "albedo [1]",
            "sigma_samp [1/length]",
            "in_domain",
            "expected look-ups per estimate",
            "measured look-ups per estimate",
        ]);
        for curve in &self.medium.sweeps {
            for point in &curve.points {
                table.row(&[
                    Cell::Text(look(curve.series).name),
                    Cell::Text(&curve.parameters),
                    Cell::Maybe(curve.albedo),
                    Cell::Number(point.sigma_samp),
                    Cell::Flag(point.in_domain),
                    Cell::Maybe(point.lookups),
                    Cell::Maybe(point.measured.as_ref().map(|measured| measured.lookups)),
                ]);
            }
        }
        table
    }
}
