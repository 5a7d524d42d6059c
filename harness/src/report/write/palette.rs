//! How each series looks, in every figure: one name, one colour, one marker, one dash.
//!
//! Hue says the family (blue: double particle, warm: single particle, grey and mauve: the biased baselines), lightness says the
//! member. Colours were chosen so that every pair stays apart for normal, protanopic, deuteranopic and tritanopic vision, which
//! the tests below check; the marker and the dash tell the series apart where colour cannot.

use super::super::result::Series;

/// Red, green, blue in sRGB.
pub(crate) type Rgb = (u8, u8, u8);

/// Outline of a mark. All are closed, so that each can be filled or hollow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Square,
    Circle,
    Diamond,
    TriangleUp,
    TriangleDown,
    TriangleLeft,
    TriangleRight,
    Pentagon,
    Hexagon,
    Star,
}

/// Lengths of strokes and gaps in pixels, alternating; empty for a solid line.
pub(crate) type Dash = &'static [f64];

/// How the line and the marks of a curve look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) colour: Rgb,
    pub(crate) marker: Marker,
    pub(crate) dash: Dash,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// Name for people.
    pub(crate) name: &'static str,
    /// Colour of lines and marks.
    pub(crate) colour: Rgb,
    /// Shape of marks.
    pub(crate) marker: Marker,
    /// Dash of lines.
    pub(crate) dash: Dash,
}

impl Look {
    /// The look without the name.
    pub(crate) fn style(&self) -> Style {
        Style { colour: self.colour, marker: self.marker, dash: self.dash }
    }
}

/// Every series, in the order of legends and tables.
pub(crate) const SERIES: [Series; 10] = [
    Series::Woodcock,
    Series::DoubleParticle,
    Series::DoubleParticleMean,
    Series::DoubleParticleExplorers,
    Series::Terminating,
    Series::NonTerminating,
    Series::Adaptive,
    Series::LineIntegral,
    Series::RayMarching,
    Series::JitteredRayMarching,
];

const SOLID: Dash = &[];
const LONG: Dash = &[20.0, 7.0];
const SHORT: Dash = &[9.0, 6.0];
const DOTTED: Dash = &[4.0, 5.0];
const DASH_DOT: Dash = &[16.0, 6.0, 4.0, 6.0];
const DASH_DOT_DOT: Dash = &[16.0, 5.0, 4.0, 5.0, 4.0, 5.0];

/// The look of a series.
pub(crate) fn look(series: Series) -> Look {
    let (name, colour, marker, dash) = match series {
        Series::Woodcock => ("Woodcock", (0x1B, 0x1B, 0x1B), Marker::Square, SOLID),
        Series::DoubleParticle => ("Double particle", (0x02, 0x70, 0xB4), Marker::Circle, SOLID),
        Series::DoubleParticleMean => {
            ("Double particle, mean (oracle)", (0x0C, 0xA8, 0xFF), Marker::Diamond, DASH_DOT)
        }
        Series::DoubleParticleExplorers => {
            ("Double particle, explorers", (0x33, 0x22, 0x88), Marker::Hexagon, SOLID)
        }
        Series::Terminating => ("Terminating", (0xE5, 0x74, 0x10), Marker::TriangleUp, SOLID),
        Series::NonTerminating => ("Non-terminating", (0xCA, 0x4E, 0x00), Marker::TriangleDown, LONG),
        Series::Adaptive => ("Adaptive", (0x88, 0x22, 0x55), Marker::Star, SOLID),
        Series::LineIntegral => ("Line integral", (0x39, 0xA3, 0x70), Marker::Pentagon, DASH_DOT_DOT),
        Series::RayMarching => ("Ray marching (biased)", (0x75, 0x72, 0x7A), Marker::TriangleLeft, SHORT),
        Series::JitteredRayMarching => {
            ("Jittered marching (biased)", (0xCE, 0x7F, 0xBA), Marker::TriangleRight, DOTTED)
        }
    };
    Look { name, colour, marker, dash }
}

/// The name of a series with its parameters.
pub(crate) fn label(series: Series, parameters: &str) -> String {
    let name = look(series).name;
    if parameters.is_empty() { name.to_owned() } else { format!("{name}: {parameters}") }
}

/// Place in legends and tables.
pub(crate) fn rank(series: Series) -> usize {
    SERIES.iter().position(|&known| known == series).unwrap_or(SERIES.len())
}

/// Presumes the answer: it shows what a control could gain, and does not compete either.
pub(crate) fn is_oracle(series: Series) -> bool {
    matches!(series, Series::DoubleParticleMean)
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

    #[test]
    fn all_pairs_stay_apart_for_every_vision() {
        for vision in [&NORMAL, &PROTANOPIA, &DEUTERANOPIA, &TRITANOPIA] {
            for (i, &a) in SERIES.iter().enumerate() {
                for &b in &SERIES[..i] {
                    let (p, q) = (seen(look(a).colour, vision), seen(look(b).colour, vision));
                    let distance = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
                    // 0.02 is about one just noticeable difference of large patches; lines need several.
                    assert!(distance > 0.09, "{a:?} and {b:?}: {distance}");
                }
            }
        }
    }

    #[test]
    fn all_colours_stand_out_from_white() {
        for series in SERIES {
            let [r, g, b] = linear(look(series).colour);
            let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            assert!(1.05 / (luminance + 0.05) > 2.5, "{series:?}");
        }
    }

    #[test]
    fn no_two_series_share_a_marker() {
        for (i, &a) in SERIES.iter().enumerate() {
            assert_eq!(rank(a), i);
            assert!(SERIES[..i].iter().all(|&b| look(a).marker != look(b).marker));
        }
    }
}
