//! A small made-up document with every kind of content, and trouble: gaps, zeros, curves that leave, wide intervals, clipped pixels,
//! cells without a value.

use crate::*;

/// The document.
pub(crate) fn document() -> Document {
    let measured = Section::new("measured", "Measured")
        .with("A paragraph on σ_samp with <markup> & more.")
        .with(Block::Facts(vec![("optical thickness τ".to_owned(), "3.5 ± 1e-12".to_owned())]))
        .with(variance())
        .with(shares())
        .with(plane())
        .with(winners())
        .with(table());
    Document {
        provenance: Provenance {
            seed: 1,
            revision: "0".to_owned(),
            command: "harness report made-up".to_owned(),
        },
        name: "made-up".to_owned(),
        title: "A made-up study of <nothing>".to_owned(),
        summary: vec!["The first finding.".to_owned(), "The second | finding.".to_owned()],
        quick: true,
        seconds: 1.5,
        threads: 2,
        unsound: Vec::new(),
        claims: vec![Claim {
            id: "M1".to_owned(),
            claim: "a claim | with a bar".to_owned(),
            source: "paper, eq. 1".to_owned(),
            measured: "1.0 [0.9, 1.1]".to_owned(),
            verdict: ClaimVerdict::HoldsUnder,
            comment: String::new(),
        }],
        hero: Some("shares".to_owned()),
        sections: vec![measured, Section::new("pictures", "Pictures").with(gallery([12, 8]))],
        looks: vec![("spectral".to_owned(), 4)],
    }
}

fn variance() -> Chart {
    let x = |k: u32| 10_f64.powf(f64::from(k) / 8.0 - 1.0);
    let mut chart = Chart::new(
        "variance",
        "Relative variance against σ_samp",
        Axis::logarithmic("σ_samp [1/length]"),
        Axis::logarithmic("relative variance Var/T² [1]"),
    );
    chart.caption = "Made up: lines are closed forms.".to_owned();
    for (shift, label) in
        ["Woodcock", "weighted, no cut-off", "weighted, with a cut-off", "spectral"].iter().enumerate()
    {
        let y = |k: u32| 3.0_f64.powi(i32::try_from(shift).unwrap()) / x(k).powi(2);
        let mut curve = Curve::method(label).with_line((0..=24).map(|k| (x(k), y(k))));
        // A gap, then zero variance at the end.
        curve.line[10].y = None;
        curve.line[24].y = Some(if shift == 3 { 0.0 } else { y(24) });
        curve.marks = (0..=24)
            .step_by(4)
            .map(|k| {
                let mark = Mark::measured(x(k), 1.05 * y(k), [0.7 * y(k), 1.6 * y(k)]);
                if k < 8 { mark.hollow() } else { mark }
            })
            .collect();
        // An interval that reaches below zero, and a value above the figure.
        curve.marks[6].interval = Some([-0.1, 2.0 * y(24)]);
        chart.panels[0].curves.push(curve);
    }
    let panel = &mut chart.panels[0];
    panel.y.range = Some([1e-4, 1e3]);
    panel.verticals = vec![
        Vertical { x: 1.0, label: "greatest σ_t".to_owned() },
        Vertical { x: 3.0, label: "mean of the majorant".to_owned() },
    ];
    panel.bands = vec![Band { from: 1.6, to: 2.6, label: "best per look-up, 95 % interval".to_owned() }];
    chart
}

fn shares() -> Chart {
    let mut chart = Chart::new(
        "shares",
        "A share against distance",
        Axis::linear("distance [length]"),
        Axis::linear("escaped [1]"),
    );
    chart.caption = "Made up.".to_owned();
    let exact =
        Curve::reference("exact", (0..=50).map(|k| (f64::from(k) / 10.0, (-f64::from(k) / 10.0).exp())));
    let marks = (0..=10).map(|k| {
        let y = (-f64::from(k) / 2.0).exp();
        Mark::measured(f64::from(k) / 2.0, y + 0.01, [y - 0.03, y + 0.05])
    });
    // The same names as in the other chart: the same looks.
    let shaded = exact.clone().with_area((0..=5).map(|k| (f64::from(k), [0.0, (-f64::from(k)).exp()])));
    let spectral = Curve::method("spectral").with_marks(marks);
    let second = Panel { heading: "again".to_owned(), curves: vec![shaded], ..chart.panels[0].clone() };
    chart.panels.push(second);
    chart.with_curves(vec![exact, spectral])
}

const PROFILES: [&str; 6] = ["const", "cos", "gauss", "hole", "lin_inc", "lin_dec"];

/// Transmittances and tightnesses.
fn centres() -> [Vec<f64>; 2] {
    let x = (0..24).map(|k| 0.01 + 0.98 * f64::from(k) / 23.0).collect();
    let y = (0..16).map(|k| 10_f64.powf(-1.5 + 1.5 * f64::from(k) / 15.0)).collect();
    [x, y]
}

/// Efficiency per look-up of a weight (1 - c y) per collision, in a medium that is `rough` times rougher than a homogeneous one.
fn efficiency(transmittance: f64, y: f64, rough: f64, c: f64) -> f64 {
    let thickness = -transmittance.ln();
    let variance = (thickness * y * (1.0 + rough) / c).exp_m1() + 0.02 * rough * thickness.powi(2);
    1.0 / (variance * (0.3 / c + thickness / y))
}

fn plane() -> HeatMap {
    let [x, y] = centres();
    let panel = |(k, label): (usize, &&str)| {
        let mut panel = Grid::of(label, x.clone(), y.clone(), |x, y| Some(efficiency(x, y, k as f64, 1.0)));
        if k == 3 {
            // No value, zero, infinite.
            panel.values[..12].fill(None);
            panel.values[24..30].fill(None);
            (panel.values[40], panel.values[100]) = (Some(0.0), Some(f64::INFINITY));
        }
        panel
    };
    let content = Content::Values {
        colours: Axis::logarithmic("efficiency T²/(Var · look-ups) [1]"),
        isolines: vec![1e-3, 0.01, 0.1, 1.0, 10.0],
        panels: PROFILES.iter().enumerate().map(panel).collect(),
    };
    let tightness = Axis::logarithmic("tightness of the majorant [1]");
    HeatMap {
        caption: "Made up: no value in the lower left <corner>.".to_owned(),
        ..HeatMap::new("plane", "Efficiency over the plane", transmittance(), tightness, content)
    }
}

fn transmittance() -> Axis {
    Axis::linear("transmittance T [1]").within(0.0, 1.0)
}

fn winners() -> HeatMap {
    let [x, y] = centres();
    // The first two have curves, the one that never wins has not.
    let names =
        ["Woodcock", "spectral", "never the best", "unbiased marching", "jittered ratio", "telescoping"];
    let all = |k: usize, x: f64, y: f64| {
        let rough = k as f64;
        [
            3.0 * y.powi(2) * efficiency(x, y, rough, 1.0),
            0.8 * efficiency(x, y, rough, 1.5),
            0.0,
            0.6 * efficiency(x, 0.3, rough, 2.0),
            0.1 + 0.5 * x,
            0.02 * efficiency(x, 0.02, 5.0 - rough, 1.0),
        ]
    };
    let best = |k: usize, x: f64, y: f64| {
        let all = all(k, x, y);
        (0..all.len()).max_by(|&a, &b| all[a].total_cmp(&all[b]))
    };
    let gain = |k: usize, x: f64, y: f64| {
        Some(all(k, x, y).into_iter().fold(0.0, f64::max) / efficiency(x, y, k as f64, 1.0))
    };
    let mut panels: Vec<Grid<Option<usize>>> = Vec::new();
    let mut numbers = Vec::new();
    for (k, label) in PROFILES.iter().enumerate() {
        panels.push(Grid::of(label, x.clone(), y.clone(), |x, y| best(k, x, y)));
        numbers.push(Grid::of(label, x.clone(), y.clone(), |x, y| gain(k, x, y)).values);
    }
    panels[5].values[..5].fill(None);
    let content = Content::Names {
        names: names.map(str::to_owned).to_vec(),
        panels,
        numbers: Some(Numbers {
            axis: Axis::logarithmic("gain over ratio tracking [1]"),
            isolines: vec![2.0, 10.0],
            panels: numbers,
        }),
    };
    let tightness = Axis::logarithmic("tightness of the majorant [1]");
    HeatMap::new("winners", "The best of five", transmittance(), tightness, content)
}

fn table() -> Table {
    let columns =
        [("method", ""), ("samples", ""), ("mean", "1"), ("time", "s"), ("sound", ""), ("efficiency", "1/s")];
    let mut table = Table::new("numbers", "Numbers | of it", "What was measured.", &columns);
    for (k, label) in ["Woodcock", "spectral | with bar"].into_iter().enumerate() {
        table.rows.push(vec![
            Cell::text(label),
            Cell::Count(100_000),
            Cell::measured(0.818_731, [0.818_53, 0.818_93]),
            Cell::Number(0.1234),
            Cell::Flag(k == 0),
            Cell::maybe((k == 0).then_some(1.5e6)),
        ]);
    }
    table
}

/// Pictures of this resolution: coloured, grey, and a difference.
pub(crate) fn gallery(resolution: [usize; 2]) -> Gallery {
    let pixels = || {
        let [width, height] = resolution;
        (0..width * height)
            .map(move |k| ((k % width) as f64 / width as f64, (k / width) as f64 / height as f64))
    };
    // A hash instead of a source: noise that needs no seed.
    let noise = |u: f64, v: f64| (12.9898 * u + 78.233 * v).sin().abs() * 43_758.545_3 % 1.0;
    let picture = |id: &str, label: &str, pixels| Picture {
        id: id.to_owned(),
        label: label.to_owned(),
        lines: vec!["RMSE 0.10 [0.09, 0.11]".to_owned(), "2.50 look-ups per pixel".to_owned()],
        resolution,
        pixels,
    };
    let radiance = |values| Pixels::Radiance { values, exposure: 2.0 };
    let coloured = pixels().map(|(u, v)| [0.6 * u, 0.4 * v, 0.5 * (1.0 - u)]).collect();
    let noisy = pixels().map(|(u, v)| [0.5 * u + 0.2 * noise(u, v) - 0.05; 3]).collect();
    let signed = pixels().map(|(u, v)| 0.3 * (noise(u, v) - 0.5) * (1.0 + u)).collect();
    Gallery {
        id: "looks".to_owned(),
        title: "Equal cost".to_owned(),
        caption: "Made up.".to_owned(),
        rows: vec![
            GalleryRow {
                label: "Spectral".to_owned(),
                pictures: vec![
                    picture("looks-coloured", "coloured", radiance(coloured)),
                    picture("looks-grey", "grey", radiance(noisy)),
                    picture("looks-error", "grey, error", Pixels::Signed { values: signed, scale: 0.2 }),
                ],
            },
            GalleryRow { label: String::new(), pictures: Vec::new() },
        ],
    }
}
