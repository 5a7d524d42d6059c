//! Marks as polygons about a point.

use crate::palette::Marker;
use plotters::element::{DynElement, IntoDynElement};
use plotters::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Radius of a mark in pixels.
const RADIUS: f64 = 8.0;

/// The corners of a mark about the origin. Shapes look equally large.
fn corners(marker: Marker, size: f64) -> Vec<(i32, i32)> {
    // Angles are counted from the right, y points down: −π/2 is up.
    let (radius, count, first) = match marker {
        Marker::Circle => (0.95, 16, 0.0),
        Marker::Square => (1.2, 4, FRAC_PI_4),
        Marker::Diamond => (1.25, 4, 0.0),
        Marker::TriangleUp => (1.3, 3, -FRAC_PI_2),
        Marker::TriangleDown => (1.3, 3, FRAC_PI_2),
        Marker::TriangleLeft => (1.3, 3, PI),
        Marker::TriangleRight => (1.3, 3, 0.0),
        Marker::Pentagon => (1.1, 5, -FRAC_PI_2),
        Marker::Hexagon => (1.05, 6, 0.0),
        Marker::Star => (1.4, 10, -FRAC_PI_2),
    };
    let corner = |k: u32| {
        let angle = first + TAU * f64::from(k) / f64::from(count);
        let dent = if marker == Marker::Star && k % 2 == 1 { 0.45 } else { 1.0 };
        let reach = size * radius * dent;
        ((reach * angle.cos()).round() as i32, (reach * angle.sin()).round() as i32)
    };
    (0..count).map(corner).collect()
}

/// A mark at a place; hollow where it is not solid.
pub(super) fn mark<'a, DB: DrawingBackend + 'a, Coord: Clone + 'a>(
    marker: Marker,
    at: Coord,
    colour: RGBColor,
    solid: bool,
) -> DynElement<'a, DB, Coord> {
    let place = EmptyElement::at(at);
    if solid {
        return (place + Polygon::new(corners(marker, RADIUS + 1.0), colour.filled())).into_dyn();
    }
    let corners = corners(marker, RADIUS);
    let outline: Vec<(i32, i32)> = corners.iter().chain(&corners[..1]).copied().collect();
    let line = PathElement::new(outline, colour.stroke_width(2));
    (place + Polygon::new(corners, WHITE.filled()) + line).into_dyn()
}
