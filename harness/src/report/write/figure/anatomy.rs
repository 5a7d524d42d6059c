//! One ray taken apart, after szirmay-kalos-2017 fig. 5: extinction and control above, transmittance below.

use super::{FOOT, Figure, LEGEND_LEFT, LEGEND_WIDTH, frame};
use crate::report::result::{Anatomy, MediumReport, Series};
use crate::report::write::draw::{
    Axis, Canvas, Draw, Drawn, FAINT, Fill, Labels, Legend, Panel, Rect, Sign, Stroke,
};
use crate::report::write::number::short;
use crate::report::write::palette::{Marker, Rgb, look};
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

pub(super) struct AnatomyFigure<'a> {
    pub(super) medium: &'a MediumReport,
}

const TOP: f64 = 24.0;
const HEIGHT: f64 = 940.0;
/// Height of the upper panel, and the gap to the lower one.
const UPPER: f64 = 460.0;
const GAP: f64 = 34.0;
const EXTINCTION: Rgb = (0x8A, 0x93, 0x9E);
const EXACT: Rgb = (0x1B, 0x1B, 0x1B);

impl AnatomyFigure<'_> {
    fn data(&self) -> &Anatomy {
        &self.medium.anatomy
    }

    fn legend() -> Legend {
        let [control, walk] = colours();
        Legend::new(
            [],
            &[
                (Sign::Area(EXTINCTION, 0.45), "extinction σ_t"),
                (Sign::Line(Stroke::solid(control, 3.0)), "control σ_main"),
                (Sign::Line(SAMPLING), "sampling extinction σ_samp"),
                (Sign::Mark(Marker::Square, control, Fill::Solid), "explorers"),
                (Sign::Mark(Marker::Circle, walk, Fill::Solid), "interaction points"),
                (Sign::Line(Stroke::solid(EXACT, 3.0)), "transmittance T(0, s)"),
                (Sign::Line(Stroke::solid(walk, 3.0)), "sampled transmittance"),
            ],
            LEGEND_WIDTH,
        )
    }

    fn panels(&self, all: Rect) -> [Panel; 2] {
        let anatomy = self.data();
        let ends = [anatomy.s.first(), anatomy.s.last()].map(|end| end.copied().unwrap_or(0.0));
        let top =
            anatomy.sigma_t.iter().chain(&anatomy.sigma_main).fold(anatomy.sigma_samp, |a, &b| a.max(b));
        let least = anatomy.sigma_main.iter().fold(0.0_f64, |a, &b| a.min(b));
        let upper = Panel {
            rect: Rect { bottom: all.top + UPPER, ..all },
            x: Axis::exactly("", ends[0], ends[1]),
            y: Axis::exactly("extinction [1/length]", 1.1 * least, 1.1 * top),
        };
        let sampled = anatomy.sampled.iter().copied().filter(|x| x.is_finite());
        let (low, high) = sampled.fold((0.0, 1.0), |(low, high), x| (f64::min(low, x), f64::max(high, x)));
        let lower = Panel {
            rect: Rect { top: all.top + UPPER + GAP, ..all },
            x: Axis::exactly("distance s along the ray [length]", ends[0], ends[1]),
            y: Axis::linear("transmittance [1]", [low.max(-1.0), high.min(3.0)]),
        };
        [upper, lower]
    }
}

const SAMPLING: Stroke = Stroke { colour: FAINT, width: 2.0, dash: &[14.0, 6.0] };

/// The control and the walk are those of the double particle estimator: they wear its colours.
fn colours() -> [Rgb; 2] {
    [look(Series::DoubleParticleExplorers).colour, look(Series::Terminating).colour]
}

fn together(s: &[f64], y: &[f64]) -> Vec<Option<(f64, f64)>> {
    s.iter().zip(y).map(|(&s, &y)| y.is_finite().then_some((s, y))).collect()
}

impl Draw for AnatomyFigure<'_> {
    fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &Self::legend()).1
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let anatomy = self.data();
        let [control, walk] = colours();
        let legend = Self::legend();
        let (all, _) = frame(TOP, HEIGHT, &legend);
        let [upper, lower] = self.panels(all);
        upper.axes(canvas, Labels::YOnly)?;
        lower.axes(canvas, Labels::Both)?;

        // The extinction is an area down to zero: what it covers is the optical thickness.
        let mut area: Vec<(f64, f64)> =
            anatomy.s.iter().zip(&anatomy.sigma_t).map(|(&s, &y)| upper.place(s, y)).collect();
        area.extend(anatomy.s.last().map(|&s| upper.place(s, 0.0)));
        area.extend(anatomy.s.first().map(|&s| upper.place(s, 0.0)));
        canvas.area(&area, EXTINCTION, 0.45)?;
        let [left, right] = upper.x.range();
        upper.curve(
            canvas,
            &[Some((left, anatomy.sigma_samp)), Some((right, anatomy.sigma_samp))],
            SAMPLING,
        )?;
        upper.curve(canvas, &together(&anatomy.s, &anatomy.sigma_main), Stroke::solid(control, 3.0))?;
        for &[s, y] in &anatomy.explorers {
            upper.mark(canvas, (s, y), None, (Marker::Square, control, Fill::Solid))?;
        }
        for &[s, y] in &anatomy.interactions {
            upper.mark(canvas, (s, y), None, (Marker::Circle, walk, Fill::Solid))?;
        }

        lower.curve(canvas, &together(&anatomy.s, &anatomy.transmittance), Stroke::solid(EXACT, 3.0))?;
        lower.curve(canvas, &together(&anatomy.s, &anatomy.sampled), Stroke::solid(walk, 3.0))?;
        legend.draw(canvas, (LEGEND_LEFT, all.bottom + FOOT))
    }
}

impl Figure for AnatomyFigure<'_> {
    fn id(&self) -> String {
        format!("{}-anatomy", self.medium.id)
    }

    fn title(&self) -> String {
        "Anatomy of the ray".to_owned()
    }

    fn caption(&self) -> String {
        let anatomy = self.data();
        let end = |values: &[f64]| values.last().map_or_else(|| "—".to_owned(), |&x| short(x));
        format!(
            "The studied ray. Above: extinction (area), the piecewise linear control through {} explorer points, and the {} interaction \
             points of one walk with σ_samp = {}. Below: the exact transmittance and the one that this walk samples; at the end of the \
             ray they are {} and {}.",
            anatomy.explorers.len(),
            anatomy.interactions.len(),
            short(anatomy.sigma_samp),
            end(&anatomy.transmittance),
            end(&anatomy.sampled),
        )
    }

    fn table(&self) -> Table {
        let anatomy = self.data();
        let mut table = Table::new(&[
            "kind",
            "s [length]",
            "sigma_t [1/length]",
            "sigma_main [1/length]",
            "T(0,s) [1]",
            "sampled T(0,s) [1]",
        ]);
        for (k, &s) in anatomy.s.iter().enumerate() {
            let at = |values: &[f64]| Cell::Maybe(values.get(k).copied());
            table.row(&[
                Cell::Text("curve"),
                Cell::Number(s),
                at(&anatomy.sigma_t),
                at(&anatomy.sigma_main),
                at(&anatomy.transmittance),
                at(&anatomy.sampled),
            ]);
        }
        for (kind, points) in [("explorer", &anatomy.explorers), ("interaction", &anatomy.interactions)] {
            for &[s, sigma_t] in points {
                let none = || Cell::Maybe(None);
                table.row(&[
                    Cell::Text(kind),
                    Cell::Number(s),
                    Cell::Number(sigma_t),
                    none(),
                    none(),
                    none(),
                ]);
            }
        }
        table
    }
}
