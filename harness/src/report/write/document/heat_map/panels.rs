//! Panels in units of drawn axes and colours: what values and names have in common.

use super::super::super::colour_map;
use super::super::super::draw::Axis;
use super::super::chart::{DECADES, on};
use super::plane::Plane;
use crate::report::document::{self, Content, HeatMap, Scale};

/// What a cell shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shown {
    Missing,
    /// A level of the colour map, or the place of a name.
    Kind(usize),
}

/// A panel on its way onto the canvas: values in units of drawn axes, NaN for what is missing.
pub(super) struct PanelOf<'a> {
    pub(super) label: &'a str,
    pub(super) plane: Plane,
    /// The values, or the numbers beside the names.
    pub(super) numbers: Vec<f64>,
    pub(super) cells: Vec<Shown>,
}

/// The colour axis, if there is one.
pub(super) fn colours(map: &HeatMap) -> Option<Axis> {
    let Content::Values { colours, panels, .. } = &map.content else { return None };
    let [low, high] = match colours.range {
        Some(range) => range.map(|end| on(colours, end)),
        None => {
            let values = panels.iter().flat_map(|panel| &panel.values).filter_map(|value| *value);
            let finite = values.map(|value| on(colours, value)).filter(|value| value.is_finite());
            let [low, high] =
                finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            match colours.scale {
                _ if low > high => [0.0, 1.0],
                Scale::Linear => [low, high],
                Scale::Logarithmic => [low.max(high - DECADES), high],
            }
        }
    };
    Some(match colours.scale {
        Scale::Linear => Axis::exactly(&colours.title, low, high),
        Scale::Logarithmic => Axis::exactly_logarithmic(&colours.title, low, high),
    })
}

fn drawn(axis: &document::Axis, values: &[Option<f64>]) -> Vec<f64> {
    values.iter().map(|value| value.map_or(f64::NAN, |value| on(axis, value))).collect()
}

pub(super) fn panels(map: &HeatMap) -> Vec<PanelOf<'_>> {
    let plane = |x: &[f64], y: &[f64]| Plane::new((&map.x, x), (&map.y, y));
    match &map.content {
        Content::Values { colours: axis, panels, .. } => {
            let scale = colours(map);
            let level = |value: f64| {
                let fraction = scale.as_ref().map_or(0.0, |scale| scale.fraction(value));
                Shown::Kind(usize::from(colour_map::level(fraction)))
            };
            let of = |panel: &'_ document::Panel<Option<f64>>| {
                let numbers = drawn(axis, &panel.values);
                let cells =
                    numbers.iter().map(|&x| if x.is_nan() { Shown::Missing } else { level(x) }).collect();
                (plane(&panel.x, &panel.y), numbers, cells)
            };
            panels
                .iter()
                .map(|panel| {
                    let (plane, numbers, cells) = of(panel);
                    PanelOf { label: &panel.label, plane, numbers, cells }
                })
                .collect()
        }
        Content::Names { panels, numbers, .. } => panels
            .iter()
            .enumerate()
            .map(|(k, panel)| PanelOf {
                label: &panel.label,
                plane: plane(&panel.x, &panel.y),
                numbers: numbers.as_ref().map_or_else(Vec::new, |it| drawn(&it.axis, &it.panels[k])),
                cells: panel.values.iter().map(|name| name.map_or(Shown::Missing, Shown::Kind)).collect(),
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fixture::document;
    use super::*;

    fn plane(change: impl FnOnce(&mut document::Axis, &mut Vec<Option<f64>>)) -> HeatMap {
        let mut map = document().sections.swap_remove(0).heat_maps.swap_remove(0);
        let Content::Values { colours, panels, .. } = &mut map.content else { panic!("of values") };
        panels.truncate(1);
        change(colours, &mut panels[0].values);
        map
    }

    #[test]
    fn the_scale_shows_all_finite_values_within_twelve_decades() {
        let scale = |values: &[f64]| {
            let all = |_: &mut _, cells: &mut Vec<Option<f64>>| {
                cells.fill(Some(values[0]));
                cells.iter_mut().zip(values).for_each(|(cell, value)| *cell = Some(*value));
            };
            colours(&plane(all)).unwrap().range()
        };
        assert_eq!(scale(&[10.0, 0.0, 1000.0, f64::INFINITY]), [1.0, 3.0]);
        assert_eq!(scale(&[1e-20, 100.0]), [-10.0, 2.0]);
        // A constant still has a scale.
        let [low, high] = scale(&[1.0]);
        assert!(low < high);
        assert!(colours(&plane(|_, cells| cells.fill(None))).is_some());
    }

    #[test]
    fn what_has_no_logarithm_is_missing_and_zero_is_the_lowest() {
        let map = plane(|axis, cells| {
            axis.range = Some([0.1, 10.0]);
            cells[..6].copy_from_slice(&[None, Some(-1.0), Some(f64::NAN), Some(0.0), Some(1.0), Some(1e9)]);
        });
        let cells = &panels(&map)[0].cells;
        let top = usize::from(colour_map::LEVELS) - 1;
        assert_eq!(cells[..3], [Shown::Missing; 3]);
        assert_eq!(
            cells[3..6],
            [Shown::Kind(0), Shown::Kind(usize::from(colour_map::LEVELS) / 2), Shown::Kind(top)]
        );
    }
}
