//! Sample transmittance functions with the exact one and its band, after szirmay-kalos-2017 fig. 8.

use super::{FOOT, Figure, LEGEND_LEFT, LEGEND_WIDTH, frame};
use crate::report::result::{MediumReport, SampleFunctions, Series};
use crate::report::write::draw::{Axis, Canvas, Draw, Drawn, Labels, Legend, Panel, Sign, Stroke};
use crate::report::write::number::short;
use crate::report::write::palette::{Rgb, look};
use crate::report::write::table::{Cell, Table};
use plotters::backend::DrawingBackend;

pub(super) struct Functions<'a> {
    pub(super) medium: &'a MediumReport,
}

const TOP: f64 = 24.0;
const HEIGHT: f64 = 700.0;
const EXACT: Stroke = Stroke::solid((0x1B, 0x1B, 0x1B), 4.0);
/// A single wild sample must not squeeze all others.
const LIMITS: [f64; 2] = [-1.0, 2.5];

impl Functions<'_> {
    fn data(&self) -> &SampleFunctions {
        &self.medium.functions
    }

    /// The samples wear the colour of their estimator.
    fn colour() -> Rgb {
        look(Series::DoubleParticleExplorers).colour
    }

    /// Upper (+1) or lower (−1) edge of the band.
    fn edge(&self, sign: f64) -> Vec<f64> {
        let data = self.data();
        data.transmittance.iter().zip(&data.standard_deviation).map(|(t, sd)| t + sign * sd).collect()
    }

    fn legend() -> Legend {
        Legend::new(
            [],
            &[
                (Sign::Line(EXACT), "exact T(0, s)"),
                (Sign::Area(Self::colour(), 0.16), "T ± one standard deviation (eq. 16)"),
                (Sign::Line(Stroke::solid(Self::colour(), 1.5)), "sampled functions"),
            ],
            LEGEND_WIDTH,
        )
    }

    /// The share of all sampled values that lie within the band.
    fn within(&self) -> Option<f64> {
        let (low, high) = (self.edge(-1.0), self.edge(1.0));
        let (mut inside, mut all) = (0_u32, 0_u32);
        for sample in &self.data().samples {
            // T(0, 0) is exact and counts for nothing.
            for ((&x, &low), &high) in
                sample.iter().zip(&low).zip(&high).filter(|((_, low), high)| high > low)
            {
                all += 1;
                inside += u32::from((low..=high).contains(&x));
            }
        }
        (all > 0).then(|| f64::from(inside) / f64::from(all))
    }
}

impl Draw for Functions<'_> {
    fn size(&self) -> [u32; 2] {
        frame(TOP, HEIGHT, &Self::legend()).1
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Drawn {
        let data = self.data();
        let legend = Self::legend();
        let (rect, _) = frame(TOP, HEIGHT, &legend);
        let (low, high) = (self.edge(-1.0), self.edge(1.0));
        let values =
            data.samples.iter().flatten().chain(&low).chain(&high).copied().filter(|x| x.is_finite());
        let ends = [data.s.first(), data.s.last()].map(|end| end.copied().unwrap_or(0.0));
        let panel = Panel {
            rect,
            x: Axis::exactly("distance s along the ray [length]", ends[0], ends[1]),
            y: Axis::linear("transmittance T(0, s) [1]", values.map(|x| x.clamp(LIMITS[0], LIMITS[1]))),
        };
        panel.axes(canvas, Labels::Both)?;
        let up = data.s.iter().zip(&high).map(|(&s, &y)| panel.place(s, y));
        let down = data.s.iter().zip(&low).rev().map(|(&s, &y)| panel.place(s, y));
        canvas.area(&up.chain(down).collect::<Vec<_>>(), Self::colour(), 0.16)?;
        for sample in &data.samples {
            let points: Vec<_> =
                data.s.iter().zip(sample).map(|(&s, &y)| y.is_finite().then_some((s, y))).collect();
            panel.curve(canvas, &points, Stroke::solid(Self::colour(), 1.5))?;
        }
        let exact: Vec<_> = data.s.iter().zip(&data.transmittance).map(|(&s, &y)| Some((s, y))).collect();
        panel.curve(canvas, &exact, EXACT)?;
        legend.draw(canvas, (LEGEND_LEFT, rect.bottom + FOOT))
    }
}

impl Figure for Functions<'_> {
    fn id(&self) -> String {
        format!("{}-functions", self.medium.id)
    }

    fn title(&self) -> String {
        "Sample transmittance functions".to_owned()
    }

    fn caption(&self) -> String {
        let data = self.data();
        let mut caption = format!(
            "{} sampled transmittance functions of the double particle estimator with {} explorers and σ_samp = {}, the exact function, \
             and its band of one standard deviation.",
            data.samples.len(),
            data.explorers,
            short(data.sigma_samp),
        );
        if let Some(share) = self.within() {
            caption.push_str(&format!(
                " {} % of the sampled values drawn here lie within the band.",
                short(100.0 * share)
            ));
        }
        caption
    }

    fn table(&self) -> Table {
        let data = self.data();
        let names: Vec<String> = (1..=data.samples.len()).map(|k| format!("sample {k} [1]")).collect();
        let mut header = vec!["s [length]", "T(0,s) [1]", "standard deviation [1]"];
        header.extend(names.iter().map(String::as_str));
        let mut table = Table::new(&header);
        for (k, &s) in data.s.iter().enumerate() {
            let at = |values: &[f64]| Cell::Maybe(values.get(k).copied());
            let mut row = vec![Cell::Number(s), at(&data.transmittance), at(&data.standard_deviation)];
            row.extend(data.samples.iter().map(|sample| at(sample)));
            table.row(&row);
        }
        table
    }
}
