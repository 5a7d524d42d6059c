//! Heat maps of the page: cells, contours, a bar of colours or a legend of names.

use super::{HEADED, axis, common, escaped, finite, subscripts, suffix};
use crate::figure::axis::{Stretch, on};
use crate::figure::heat_map::tight;
use crate::palette::{Looks, css};
use crate::{Axis, Content, Grid, HeatMap, Role, colour_map, short};
use serde_json::{Value, json};

/// A heat map.
pub(crate) fn heat_map(map: &HeatMap, looks: &Looks<'_>) -> Value {
    let mut layout = common();
    let mut traces = Vec::new();
    let labels: Vec<&str> = map.content.frames().iter().map(|frame| frame.0).collect();
    let columns = labels.len().min(3);
    let rows = labels.len().div_ceil(columns);
    layout["grid"] =
        json!({ "rows": rows, "columns": columns, "pattern": "independent", "xgap": 0.12, "ygap": 0.3 });
    let mut annotations = Vec::new();
    for (k, label) in labels.into_iter().enumerate() {
        annotations.push(place(&mut layout, map, (k, columns), label));
    }
    match &map.content {
        Content::Values { colours, isolines, panels } => {
            let values = panels.iter().flat_map(|panel| panel.values.iter().copied().flatten());
            let stretch = Stretch::of(colours, values);
            layout["coloraxis"] = json!({ "colorscale": colour_scale(), "cmin": stretch.low, "cmax": stretch.high,
                "colorbar": bar(colours, stretch) });
            for (k, panel) in panels.iter().enumerate() {
                let places = |value: &Option<f64>| value.map(|value| on(colours, value));
                let text = |value: &Option<f64>| value.map_or("no value".to_owned(), short);
                let mut trace = cells(panel, k, &places, &text);
                trace["coloraxis"] = json!("coloraxis");
                traces.push(trace);
                traces.extend(contours(panel, k, colours, isolines, &panel.values));
            }
        }
        Content::Names { names, panels, numbers } => {
            let colour = |k: usize| css(looks.get(Role::Method, &names[k]).colour);
            let steps = (0..names.len())
                .flat_map(|k| [k, k + 1].map(|edge| json!([edge as f64 / names.len() as f64, colour(k)])));
            let steps: Vec<Value> = steps.collect();
            layout["coloraxis"] = json!({ "colorscale": steps, "cmin": -0.5, "cmax": names.len() as f64 - 0.5, "showscale": false });
            for (k, panel) in panels.iter().enumerate() {
                let number = |value: &Option<usize>| value.map(|value| value as f64);
                let text =
                    |value: &Option<usize>| value.map_or("no value".to_owned(), |value| names[value].clone());
                let mut trace = cells(panel, k, &number, &text);
                trace["coloraxis"] = json!("coloraxis");
                traces.push(trace);
                if let Some(numbers) = numbers {
                    traces.extend(contours(panel, k, &numbers.axis, &numbers.isolines, &numbers.panels[k]));
                }
            }
            for (k, name) in names
                .iter()
                .enumerate()
                .filter(|(k, _)| panels.iter().any(|it| it.values.contains(&Some(*k))))
            {
                traces.push(
                    json!({ "type": "scatter", "mode": "markers", "x": [null], "y": [null], "name": name,
                    "marker": { "color": colour(k), "symbol": "square", "size": 12 }, "hoverinfo": "skip" }),
                );
            }
        }
    }
    layout["annotations"] = json!(annotations);
    layout["margin"]["t"] = json!(HEADED);
    (layout["height"], layout["meta"]) = (json!(300 * rows), json!({ "columns": columns }));
    json!({ "data": traces, "layout": layout })
}

/// Adds the axes of a panel to the layout; its heading.
fn place(layout: &mut Value, map: &HeatMap, (k, columns): (usize, usize), label: &str) -> Value {
    let titles = [&*map.x.title, if k % columns == 0 { &*map.y.title } else { "" }];
    for ((letter, of), title) in [("x", &map.x), ("y", &map.y)].into_iter().zip(titles) {
        let mut drawn = axis(&tight(of, map), title);
        if k > 0 {
            drawn["matches"] = json!(letter);
        }
        // Panels of a row share their labels, for which there is no room between them.
        drawn["showticklabels"] = json!(letter == "x" || k % columns == 0);
        layout[format!("{letter}axis{}", suffix(k))] = drawn;
    }
    let refers = |letter: &str| format!("{letter}{} domain", suffix(k));
    json!({ "text": format!("<b>{}</b>", escaped(label)), "showarrow": false, "xref": refers("x"),
        "yref": refers("y"), "x": 0.5, "y": 1.0, "yanchor": "bottom" })
}

/// The cells of a panel: a number for the colour of each, and words for those who point at it.
fn cells<T>(
    panel: &Grid<T>,
    k: usize,
    number: &dyn Fn(&T) -> Option<f64>,
    text: &dyn Fn(&T) -> String,
) -> Value {
    let rows = || panel.values.chunks(panel.x.len());
    let table = |cell: &dyn Fn(&T) -> Value| -> Value {
        rows().map(|row| row.iter().map(cell).collect::<Value>()).collect()
    };
    json!({ "type": "heatmap", "x": panel.x, "y": panel.y, "xaxis": format!("x{}", suffix(k)), "yaxis": format!("y{}", suffix(k)),
        "z": table(&|value| number(value).map_or(Value::Null, finite)), "text": table(&|value| json!(text(value))),
        "hovertemplate": "%{x:.3~g}, %{y:.3~g}<br>%{text}<extra></extra>" })
}

/// Lines of equal numbers over a panel.
fn contours<T>(
    panel: &Grid<T>,
    k: usize,
    axis: &Axis,
    levels: &[f64],
    numbers: &[Option<f64>],
) -> Vec<Value> {
    let place = |number: &Option<f64>| number.map_or(Value::Null, |number| finite(on(axis, number)));
    let z: Vec<Vec<Value>> =
        numbers.chunks(panel.x.len()).map(|row| row.iter().map(place).collect()).collect();
    let line = |&level: &f64| {
        let at = on(axis, level);
        json!({ "type": "contour", "x": panel.x, "y": panel.y, "z": z, "xaxis": format!("x{}", suffix(k)),
            "yaxis": format!("y{}", suffix(k)), "showscale": false, "hoverinfo": "skip", "line": { "color": "#000000", "width": 1 },
            "contours": { "type": "constraint", "operation": "=", "value": at }, "showlegend": false })
    };
    levels.iter().map(line).collect()
}

fn colour_scale() -> Vec<Value> {
    let last = f64::from(colour_map::LEVELS - 1);
    (0..colour_map::LEVELS)
        .map(|level| json!([f64::from(level) / last, css(colour_map::sequential(level))]))
        .collect()
}

fn bar(axis: &Axis, stretch: Stretch) -> Value {
    let ticks = stretch.ticks(6);
    let [places, labels]: [Value; 2] =
        [ticks.iter().map(|tick| json!(tick.0)).collect(), ticks.iter().map(|tick| json!(tick.1)).collect()];
    json!({ "title": { "text": subscripts(&axis.title), "side": "right" }, "tickvals": places, "ticktext": labels })
}
