//! Looks of curves: colour, mark and dash.
//!
//! The first ten colours were chosen by hand, in families of hue; the others each as far as possible, in Oklab, from all before it for
//! normal, protanopic, deuteranopic and tritanopic vision. Every pair stays apart, which the tests below check; marks and dashes tell curves
//! apart where colour cannot.

use crate::{Block, Content, Document, Role};
use serde::Serialize;

/// Red, green, blue in sRGB.
pub(crate) type Rgb = (u8, u8, u8);

/// Outline of a mark, by its name in the script library. All are closed, so that each can be filled or hollow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Marker {
    Square,
    Circle,
    Diamond,
    Hexagon,
    TriangleUp,
    TriangleDown,
    Star,
    Pentagon,
    TriangleLeft,
    TriangleRight,
}

/// Law by which a line is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dash {
    Solid,
    Long,
    Short,
    Dotted,
}

/// The look of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    pub(crate) colour: Rgb,
    pub(crate) marker: Marker,
    pub(crate) dash: Dash,
}

/// One colour for each look.
const COLOURS: [u32; 40] = [
    0x1B1B1B, 0x0270B4, 0x0CA8FF, 0x332288, 0xE57410, 0xCA4E00, 0x882255, 0x39A370, 0x75727A, 0xCE7FBA,
    0x5D0DF6, 0x444207, 0x7D6DED, 0x470E45, 0x0109CA, 0x584D82, 0xD10CC5, 0x8F4B37, 0xF46BF6, 0x023000,
    0x8120A4, 0x02156D, 0xBD9C99, 0x6C9396, 0xA441A2, 0xFB1D4E, 0x502D37, 0x095055, 0x83B05B, 0x8A7C4C,
    0xD25FD1, 0xA3067C, 0x477F1A, 0x9876AD, 0xAC425C, 0x6454DF, 0x2C5F06, 0x6F146E, 0x7808DA, 0x5C0202,
];
const MARKERS: [Marker; 10] = [
    Marker::Square,
    Marker::Circle,
    Marker::Diamond,
    Marker::Hexagon,
    Marker::TriangleUp,
    Marker::TriangleDown,
    Marker::Star,
    Marker::Pentagon,
    Marker::TriangleLeft,
    Marker::TriangleRight,
];
const DASHES: [Dash; 4] = [Dash::Solid, Dash::Long, Dash::Short, Dash::Dotted];

/// The look of this number; after forty they come back.
pub(crate) fn look(number: usize) -> Look {
    let colour = COLOURS[number % COLOURS.len()].to_be_bytes();
    Look {
        colour: (colour[1], colour[2], colour[3]),
        marker: MARKERS[(number + number / MARKERS.len()) % MARKERS.len()],
        dash: DASHES[number % DASHES.len()],
    }
}

/// Ink of references, told apart by the dash alone.
const INK: Rgb = (0x1D, 0x21, 0x26);

/// The looks of the labels of a document.
pub(crate) struct Looks<'a> {
    known: Vec<(Role, &'a str, Look)>,
    numbers: Vec<(&'a str, usize)>,
}

/// Labels of methods that meet in a figure.
fn labels_of(block: &Block) -> Vec<&str> {
    match block {
        Block::Chart(chart) => {
            chart.curves().filter(|it| it.role == Role::Method).map(|it| &*it.label).collect()
        }
        Block::HeatMap(map) => match &map.content {
            Content::Names { names, .. } => names.iter().map(|name| &**name).collect(),
            Content::Values { .. } => Vec::new(),
        },
        _ => Vec::new(),
    }
}

impl<'a> Looks<'a> {
    /// Labels that the document knows have their look; all others get the first that no label beside them in a figure has.
    pub(crate) fn of(document: &'a Document) -> Self {
        let mut labels: Vec<(Role, &str)> = Vec::new();
        for block in document.blocks() {
            match block {
                Block::Chart(chart) => labels.extend(chart.curves().map(|it| (it.role, &*it.label))),
                Block::HeatMap(map) => {
                    let Content::Names { names, .. } = &map.content else { continue };
                    labels.extend(names.iter().map(|name| (Role::Method, &**name)));
                }
                _ => {}
            }
        }
        let fixed = |label: &str| document.looks.iter().find(|(name, _)| name == label).map(|known| known.1);
        // Labels that meet in a figure differ; those that never do may share a look, so that colours do not run out.
        let figures: Vec<Vec<&str>> = document.blocks().map(labels_of).collect();
        let mut references = 0;
        let mut looks = Self { known: Vec::new(), numbers: Vec::new() };
        for (role, label) in labels {
            if looks.find(role, label).is_some() {
                continue;
            }
            let look = match role {
                Role::Method => {
                    let met = figures.iter().filter(|figure| figure.contains(&label)).flatten();
                    let known = |other: &&str| fixed(other).or_else(|| looks.number(other));
                    let taken: Vec<usize> = met.filter_map(known).collect();
                    let free = (0..).find(|number| !taken.contains(number));
                    let number = fixed(label).or(free).unwrap_or_default();
                    looks.numbers.push((label, number));
                    look(number)
                }
                Role::Reference => {
                    references += 1;
                    let dash = DASHES[(references - 1) % DASHES.len()];
                    Look { colour: INK, marker: Marker::Square, dash }
                }
            };
            looks.known.push((role, label, look));
        }
        looks
    }

    fn find(&self, role: Role, label: &str) -> Option<Look> {
        self.known.iter().find(|known| known.0 == role && known.1 == label).map(|known| known.2)
    }

    fn number(&self, label: &str) -> Option<usize> {
        self.numbers.iter().find(|known| known.0 == label).map(|known| known.1)
    }

    /// The look of a label.
    pub(crate) fn get(&self, role: Role, label: &str) -> Look {
        self.find(role, label).unwrap_or_else(|| look(0))
    }
}

/// A colour as CSS writes it.
pub(crate) fn css((r, g, b): Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::super::colour_map::{linear_of_srgb, oklab_of_linear};
    use super::*;

    type Matrix = [[f64; 3]; 3];

    const NORMAL: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Machado, Oliveira and Fernandes 2009, severity 1.0, on linear RGB.
    const PROTANOPIA: Matrix =
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]];
    const DEUTERANOPIA: Matrix =
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]];
    const TRITANOPIA: Matrix =
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]];

    fn linear(colour: Rgb) -> [f64; 3] {
        [colour.0, colour.1, colour.2].map(|c| linear_of_srgb(f64::from(c) / 255.0))
    }

    fn seen(colour: Rgb, vision: &Matrix) -> [f64; 3] {
        let rgb = linear(colour);
        let seen = vision.map(|row| (row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]).clamp(0.0, 1.0));
        oklab_of_linear(seen)
    }

    /// The least distance of the first `count` colours for any vision.
    fn least_distance(count: usize) -> f64 {
        let mut least = f64::INFINITY;
        for vision in [&NORMAL, &PROTANOPIA, &DEUTERANOPIA, &TRITANOPIA] {
            for i in 0..count {
                for j in 0..i {
                    let (p, q) = (seen(look(i).colour, vision), seen(look(j).colour, vision));
                    least = least.min((0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt());
                }
            }
        }
        least
    }

    #[test]
    fn all_pairs_stay_apart_for_every_vision() {
        // 0.02 is about one just noticeable difference of large patches; lines need several.
        assert!(least_distance(10) > 0.09, "{}", least_distance(10));
        assert!(least_distance(COLOURS.len()) > 0.03, "{}", least_distance(COLOURS.len()));
    }

    #[test]
    fn all_colours_stand_out_from_white() {
        for number in 0..COLOURS.len() {
            let [r, g, b] = linear(look(number).colour);
            let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            assert!(1.05 / (luminance + 0.05) > 2.4, "{number}");
        }
    }

    #[test]
    fn looks_of_one_mark_differ_in_the_dash() {
        for i in 0..COLOURS.len() {
            for j in 0..i {
                let (a, b) = (look(i), look(j));
                assert!(a.marker != b.marker || a.dash != b.dash || i - j > 20, "{i} and {j}");
            }
        }
    }
}
