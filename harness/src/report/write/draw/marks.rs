//! Outlines of marks.

use super::super::palette::Marker;
use super::canvas::Point;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Whether a mark is filled. Hollow means: this number of samples cannot test it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    Solid,
    Hollow,
}

/// The corners of a mark. Radii are such that all shapes look equally large.
pub(super) fn outline(marker: Marker, at: Point, radius: f64) -> Vec<Point> {
    // Angles are counted from the right, y points down: −π/2 is up.
    match marker {
        Marker::Circle => corners(at, 0.95 * radius, 24, 0.0),
        Marker::Square => corners(at, 1.2 * radius, 4, FRAC_PI_4),
        Marker::Diamond => corners(at, 1.25 * radius, 4, 0.0),
        Marker::TriangleUp => corners(at, 1.3 * radius, 3, -FRAC_PI_2),
        Marker::TriangleDown => corners(at, 1.3 * radius, 3, FRAC_PI_2),
        Marker::TriangleLeft => corners(at, 1.3 * radius, 3, PI),
        Marker::TriangleRight => corners(at, 1.3 * radius, 3, 0.0),
        Marker::Pentagon => corners(at, 1.1 * radius, 5, -FRAC_PI_2),
        Marker::Hexagon => corners(at, 1.05 * radius, 6, 0.0),
        Marker::Star => {
            let outer = corners(at, 1.4 * radius, 5, -FRAC_PI_2);
            let inner = corners(at, 0.62 * radius, 5, -FRAC_PI_2 + TAU / 10.0);
            outer.into_iter().zip(inner).flat_map(|(tip, dent)| [tip, dent]).collect()
        }
    }
}

fn corners((x, y): Point, radius: f64, count: u32, first: f64) -> Vec<Point> {
    (0..count)
        .map(|k| {
            let angle = first + TAU * f64::from(k) / f64::from(count);
            (x + radius * angle.cos(), y + radius * angle.sin())
        })
        .collect()
}
