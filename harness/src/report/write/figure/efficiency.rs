//! Efficiency against σ_samp, per look-up in closed form and per CPU second as measured.

use super::Figure;
use super::sweep::{Row, albedos, curves, stroke};
use crate::report::result::{MediumReport, SweepCurve, SweepPoint};
use crate::report::write::draw::{Axis, Canvas, Draw, Drawn, FAINT, Fill, Legend, Sign};
use crate::report::write::number::{power_of_ten, short, short_of_log10};
use crate::report::write::optimum::{self, Optimum, Place};
use crate::report::write::palette::{Marker, is_oracle, look};
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

/// What is paid.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    Lookups,
    Seconds,
}

pub(super) struct Efficiency<'a> {
    pub(super) medium: &'a MediumReport,
    pub(super) cost: Cost,
}

/// Decades that are shown.
const DEPTH: f64 = 7.0;

impl Efficiency<'_> {
    fn value(&self, point: &SweepPoint) -> Option<f64> {
        match self.cost {
            Cost::Lookups => point.log10_efficiency_per_lookup.filter(|_| point.in_domain),
            Cost::Seconds => point.measured.as_ref()?.log10_efficiency_per_second,
        }
    }

    fn optimum<'c>(&self, curve: &'c SweepCurve) -> Option<Optimum<'c>> {
        match self.cost {
            Cost::Lookups => optimum::per_lookup(curve),
            Cost::Seconds => optimum::per_second(curve),
        }
    }

    /// The best of the estimators that compete.
    fn best(&self, albedo: Option<f64>) -> Option<Optimum<'_>> {
        let competing = curves(self.medium, albedo).into_iter().filter(|curve| !is_special(curve));
        competing
            .filter_map(|curve| self.optimum(curve))
            .max_by(|a, b| a.log10_efficiency.total_cmp(&b.log10_efficiency))
    }

    /// The axis follows the unbiased estimators: a baseline that happens to hit the truth is arbitrarily efficient.
    fn y(&self) -> Axis {
        let values = || {
            let unbiased = self.medium.sweeps.iter().filter(|curve| !curve.series.is_baseline());
            let points = unbiased.flat_map(|curve| &curve.points);
            points.filter_map(|point| self.value(point)).filter(|y| y.is_finite())
        };
        let top = values().fold(f64::NEG_INFINITY, f64::max).ceil() + 1.0;
        let title = match self.cost {
            Cost::Lookups => "T²/(MSE · look-ups) [1]",
            Cost::Seconds => "T²/(MSE · CPU seconds) [1/s]",
        };
        let limits = if top.is_finite() { [top - DEPTH, top] } else { [0.0, 1.0] };
        Axis::decades(title, values().chain([top]), limits)
    }

    fn row(&self) -> Row<'_> {
        let mark = match self.cost {
            Cost::Lookups => "optimum",
            Cost::Seconds => "measured; largest: optimum",
        };
        let remarks = [
            (Sign::Mark(Marker::Circle, FAINT, Fill::Solid), mark),
            (Sign::Mark(Marker::TriangleUp, FAINT, Fill::Solid), "leaves the figure"),
            Legend::maximum(),
        ];
        Row::new(self.medium, self.y(), &remarks)
    }
}

impl Draw for Efficiency<'_> {
    fn size(&self) -> [u32; 2] {
        self.row().size()
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        self.row().draw(canvas, |panel, curve| {
            let look = look(curve.series);
            let place = |point: &SweepPoint| Some((point.sigma_samp.log10(), self.value(point)?));
            let mut line: Vec<_> = curve.points.iter().map(place).collect();
            if self.cost == Cost::Seconds {
                // Few points are measured: those between them are no gaps.
                line.retain(Option::is_some);
            }
            panel.curve(canvas, &line, stroke(curve, 2.5))?;
            if self.cost == Cost::Seconds {
                for at in line.into_iter().flatten().filter(|&(_, y)| panel.y.shows(y)) {
                    canvas.mark(look.marker, panel.place(at.0, at.1), 5.0, look.colour, Fill::Solid)?;
                }
            }
            match self.optimum(curve) {
                Some(best) if panel.y.shows(best.log10_efficiency) => {
                    let at = panel.place(best.sigma_samp.log10(), best.log10_efficiency);
                    canvas.mark(look.marker, at, 10.0, look.colour, Fill::Solid)
                }
                _ => Ok(()),
            }
        })
    }
}

impl Figure for Efficiency<'_> {
    fn id(&self) -> String {
        let cost = if self.cost == Cost::Lookups { "lookup" } else { "second" };
        format!("{}-efficiency-per-{cost}", self.medium.id)
    }

    fn title(&self) -> String {
        let cost = if self.cost == Cost::Lookups { "look-up" } else { "CPU second" };
        format!("Efficiency per {cost}")
    }

    fn caption(&self) -> String {
        let (cost, origin) = match self.cost {
            Cost::Lookups => ("look-up", "in closed form"),
            Cost::Seconds => ("CPU second", "with the closed-form error and the measured time"),
        };
        let range = self.y().range();
        let mut caption = format!(
            "Efficiency per {cost}, {origin}; higher is better. The axis shows {} to {}, chosen for the unbiased estimators; a triangle is \
             where a curve leaves it.",
            power_of_ten(range[0] as i32),
            power_of_ten(range[1] as i32),
        );
        let albedos = albedos(self.medium);
        let best: Vec<Optimum<'_>> = albedos.iter().filter_map(|&albedo| self.best(albedo)).collect();
        let same = best.len() == albedos.len()
            && best.windows(2).all(|pair| std::ptr::eq(pair[0].curve, pair[1].curve));
        let told = if same { 1 } else { best.len() };
        for (best, albedo) in best.iter().zip(&albedos).take(told) {
            let at = match albedo {
                Some(_) if same => " at every albedo".to_owned(),
                Some(albedo) => format!(" at albedo {albedo}"),
                None => String::new(),
            };
            caption.push_str(&format!(
                " Best unbiased estimator without an oracle{at}: {}, {} at σ_samp = {}{}.",
                look(best.curve.series).name,
                short_of_log10(best.log10_efficiency),
                short(best.sigma_samp),
                where_it_lies(best.place),
            ));
        }
        caption
    }

    fn table(&self) -> Table {
        let efficiency = match self.cost {
            Cost::Lookups => "closed form log10(T^2/(MSE look-ups)) [1]",
            Cost::Seconds => "log10(T^2/(MSE CPU seconds)) [1/s]",
        };
        let mut table = Table::new(&[
            "series",
            "parameters",
            "albedo [1]",
            "sigma_samp [1/length]",
            efficiency,
            "CPU time per estimate [ns]",
            "optimum of its curve",
        ]);
        for curve in &self.medium.sweeps {
            let best = self.optimum(curve).map(|best| best.sigma_samp);
            // Seconds are known at measured points only.
            let points =
                curve.points.iter().filter(|point| self.cost == Cost::Lookups || point.measured.is_some());
            for point in points {
                table.row(&[
                    Cell::Text(look(curve.series).name),
                    Cell::Text(&curve.parameters),
                    Cell::Maybe(curve.albedo),
                    Cell::Number(point.sigma_samp),
                    Cell::Maybe(self.value(point)),
                    Cell::Maybe(point.measured.as_ref().map(|measured| measured.nanoseconds)),
                    Cell::Flag(best == Some(point.sigma_samp)),
                ]);
            }
        }
        table
    }
}

/// A baseline is biased, and the mean as control presumes the answer: neither competes.
fn is_special(curve: &SweepCurve) -> bool {
    curve.series.is_baseline() || is_oracle(curve.series)
}

/// A remark on an optimum at the end of its curve.
fn where_it_lies(place: Place) -> &'static str {
    match place {
        Place::Inside => "",
        Place::LowerEnd => " (the lower end of its curve)",
        Place::UpperEnd => " (the upper end of its curve)",
    }
}
