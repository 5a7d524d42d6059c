//! Figures of the page as data of plotly.js: hover, legends that hide a curve, zoom, contours.
//!
//! The library is that of the crate plotly, which ships it; figures are written as the JSON that it reads, because its Rust types have no place
//! for text beside a mark in a subplot with gaps.

mod heat_map;

pub(crate) use heat_map::heat_map;

use crate::figure::axis::on;
use crate::number::{drawn, short};
use crate::palette::{Dash, Look, Looks, css};
use crate::{Area, Arrangement, Axis, Chart, Curve, Mark, Panel, Role, Scale};
use serde_json::{Value, json};

/// The script of plotly.js, without its tags.
pub(crate) fn script() -> String {
    let scripts = plotly::Plot::offline_js_sources();
    // The second script typesets formulas, which no figure has.
    let start = scripts.find('>').map_or(0, |at| at + 1);
    let end = scripts.find("</script").unwrap_or(scripts.len());
    scripts[start..end].to_owned()
}

/// Height above panels with headings in pixels: the buttons of the library stand over those.
const HEADED: u32 = 56;
/// Gap between panels as a share of the whole.
const GAP: f64 = 0.05;

/// A chart.
pub(crate) fn chart(chart: &Chart, looks: &Looks<'_>) -> Value {
    let count = chart.panels.len();
    let (mut traces, mut told) = (Vec::new(), Vec::new());
    let mut layout = common();
    let (mut shapes, mut annotations) = (Vec::new(), Vec::new());
    for (k, panel) in chart.panels.iter().enumerate() {
        let name = |letter: &str| format!("{letter}{}", suffix(k));
        let [across, up] = domains(chart.arrangement, k, count);
        let (row, last) = (chart.arrangement == Arrangement::Row, k + 1 == count);
        let x_title = if row || last { &*panel.x.title } else { "" };
        let y_title = if row && k > 0 { "" } else { &*panel.y.title };
        let [mut x, mut y] = [axis(&panel.x, x_title), axis(&panel.y, y_title)];
        for (axis, domain, other) in [(&mut x, across, "y"), (&mut y, up, "x")] {
            (axis["domain"], axis["anchor"]) = (json!(domain), json!(name(other)));
        }
        if k > 0 {
            // Zooming into one panel moves the others along.
            let (shared, first) = if row { (&mut y, "y") } else { (&mut x, "x") };
            shared["matches"] = json!(first);
        }
        layout[format!("xaxis{}", suffix(k))] = x;
        layout[format!("yaxis{}", suffix(k))] = y;
        if !panel.heading.is_empty() {
            layout["margin"]["t"] = json!(HEADED);
            annotations.push(heading(&panel.heading, across, up));
        }
        let domain = format!("{} domain", name("y"));
        for vertical in &panel.verticals {
            shapes.push(
                json!({ "type": "line", "xref": name("x"), "yref": domain, "x0": vertical.x, "x1": vertical.x,
                "y0": 0, "y1": 1, "line": { "color": "#5b626b", "width": 1.5, "dash": "dash" },
                "name": vertical.label, "showlegend": k == 0 }),
            );
        }
        for band in &panel.bands {
            shapes.push(
                json!({ "type": "rect", "xref": name("x"), "yref": domain, "x0": band.from, "x1": band.to,
                "y0": 0, "y1": 1, "fillcolor": "rgba(91,98,107,0.16)", "line": { "width": 0 },
                "name": band.label, "showlegend": k == 0 }),
            );
        }
        for curve in panel.curves.iter().rev() {
            let key = (curve.role, &*curve.label);
            let first = !told.contains(&key);
            told.push(key);
            traces.extend(curve_traces(
                curve,
                panel,
                looks.get(curve.role, &curve.label),
                [&name("x"), &name("y")],
                first,
            ));
        }
    }
    let rows = if chart.arrangement == Arrangement::Column { count } else { 1 };
    layout["height"] = json!([380, 300][usize::from(rows > 1)] * rows);
    layout["meta"] = json!({ "columns": count / rows });
    layout["shapes"] = json!(shapes);
    layout["annotations"] = json!(annotations);
    json!({ "data": traces, "layout": layout })
}

fn common() -> Value {
    json!({
        "font": { "family": "system-ui, sans-serif", "size": 13, "color": "#1d2126" },
        "margin": { "l": 56, "r": 14, "t": 30, "b": 50 },
        "hovermode": "closest",
        "legend": { "orientation": "h", "yanchor": "top", "traceorder": "reversed" },
        "paper_bgcolor": "#ffffff",
        "plot_bgcolor": "#ffffff",
    })
}

fn suffix(k: usize) -> String {
    if k == 0 { String::new() } else { (k + 1).to_string() }
}

fn domains(arrangement: Arrangement, k: usize, count: usize) -> [[f64; 2]; 2] {
    let size = (1.0 - GAP * (count - 1) as f64) / count as f64;
    let from = k as f64 * (size + GAP);
    match arrangement {
        Arrangement::Row => [[from, from + size], [0.0, 1.0]],
        Arrangement::Column => [[0.0, 1.0], [1.0 - from - size, 1.0 - from]],
    }
}

fn heading(words: &str, across: [f64; 2], up: [f64; 2]) -> Value {
    json!({ "text": format!("<b>{}</b>", escaped(words)), "showarrow": false, "xref": "paper", "yref": "paper",
        "x": 0.5 * (across[0] + across[1]), "y": up[1], "yanchor": "bottom" })
}

fn axis(axis: &Axis, title: &str) -> Value {
    let mut value = json!({ "title": { "text": subscripts(title), "standoff": 8 }, "automargin": true, "gridcolor": "#e2e5e9", "linecolor": "#5b626b",
        "mirror": true, "zeroline": false, "ticks": "outside" });
    if axis.scale == Scale::Logarithmic {
        value["type"] = json!("log");
        value["exponentformat"] = json!("power");
    }
    if let Some(range) = axis.range {
        let [low, high] = range.map(|end| on(axis, end));
        value["range"] = json!([low, high]);
        if axis.scale == Scale::Logarithmic && high - low > 1.3 {
            // Decades alone, no digits between them.
            value["dtick"] = json!(((high - low) / 8.0).ceil());
        }
    }
    value
}

/// Greek with an index, as the library's markup has it.
fn subscripts(text: &str) -> String {
    let mut text = escaped(text);
    for index in ["samp", "main", "diff", "t"] {
        text = text.replace(&format!("σ_{index}"), &format!("σ<sub>{index}</sub>"));
    }
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn dash(dash: Dash) -> &'static str {
    match dash {
        Dash::Solid => "solid",
        Dash::Long => "14px,5px",
        Dash::Short => "7px,4px",
        Dash::Dotted => "2px,4px",
    }
}

/// A number that is drawn; the library takes null for a gap.
fn finite(value: f64) -> Value {
    if value.is_finite() { json!(drawn(value)) } else { Value::Null }
}

fn curve_traces(curve: &Curve, panel: &Panel, look: Look, [x, y]: [&str; 2], first: bool) -> Vec<Value> {
    let colour = css(look.colour);
    let trace = |mode: &str, told: bool| {
        json!({ "type": "scatter", "mode": mode, "name": subscripts(&curve.label), "legendgroup": curve.label,
            "showlegend": told, "xaxis": x, "yaxis": y })
    };
    let mut traces = Vec::new();
    if !curve.area.is_empty() {
        let (r, g, b) = look.colour;
        for (end, fill) in [(0, "none"), (1, "tonexty")] {
            let mut area = trace("lines", false);
            area["x"] = curve.area.iter().map(|at| finite(at.x)).collect();
            area["y"] = curve.area.iter().map(|Area { y, .. }| finite(y[end])).collect();
            area["line"] = json!({ "width": 0 });
            area["fill"] = json!(fill);
            area["fillcolor"] = json!(format!("rgba({r},{g},{b},0.25)"));
            area["hoverinfo"] = json!("skip");
            traces.push(area);
        }
    }
    if !curve.line.is_empty() {
        let mut line = trace("lines", first);
        line["x"] = curve.line.iter().map(|point| finite(point.x)).collect();
        line["y"] = curve.line.iter().map(|point| point.y.map_or(Value::Null, finite)).collect();
        let width = if curve.role == Role::Reference { 3.0 } else { 2.0 };
        line["line"] = json!({ "color": colour, "width": width, "dash": dash(look.dash) });
        line["hovertemplate"] = json!("%{x:.4~g}, %{y:.4~g}");
        traces.push(line);
    }
    if !curve.marks.is_empty() {
        let mut marks = trace("markers", first && curve.line.is_empty());
        marks["x"] = curve.marks.iter().map(|mark| finite(mark.x)).collect();
        marks["y"] = curve.marks.iter().map(|mark| finite(mark.y)).collect();
        let symbol = json!(look.marker);
        let symbols = curve.marks.iter().map(|mark| {
            let open = if mark.solid { "" } else { "-open" };
            format!("{}{open}", symbol.as_str().unwrap_or_default())
        });
        marks["marker"] = json!({ "color": colour, "size": 9, "symbol": symbols.collect::<Vec<_>>(), "line": { "width": 1.5 } });
        let reach = |end: usize| -> Value {
            let lengths = curve.marks.iter().map(|mark| {
                mark.interval.map_or(Value::Null, |interval| finite((interval[end] - mark.y).abs()))
            });
            lengths.collect()
        };
        marks["error_y"] = json!({ "type": "data", "symmetric": false, "array": reach(1), "arrayminus": reach(0),
            "color": colour, "thickness": 1.2, "width": 3 });
        marks["text"] = curve.marks.iter().map(|mark| json!(hover(mark, panel))).collect();
        marks["hovertemplate"] = json!("%{text}");
        traces.push(marks);
    }
    traces
}

/// Words that stand beside a mark: value, interval, cost.
fn hover(mark: &Mark, panel: &Panel) -> String {
    let interval =
        mark.interval.map_or_else(String::new, |[low, high]| format!(" [{}, {}]", short(low), short(high)));
    let solid = if mark.solid { "" } else { "<br>not testable with these samples" };
    let note = if mark.note.is_empty() { String::new() } else { format!("<br>{}", escaped(&mark.note)) };
    let name = |axis: &Axis| subscripts(axis.title.split(" [").next().unwrap_or_default());
    format!(
        "{} {}<br>{} {}{interval}{solid}{note}",
        name(&panel.x),
        short(mark.x),
        name(&panel.y),
        short(mark.y)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_script_is_whole_and_ends_no_tag() {
        let script = script();
        assert!(script.len() > 1_000_000 && script.contains("newPlot") && !script.contains("</script"));
    }

    #[test]
    fn each_label_stands_in_the_legend_once() {
        let document = fixture::document();
        let looks = Looks::of(&document);
        for it in document.blocks() {
            let crate::Block::Chart(it) = it else { continue };
            let drawn = chart(it, &looks);
            let traces = drawn["data"].as_array().unwrap();
            let told = traces.iter().filter(|trace| trace["showlegend"] == true);
            let mut labels: Vec<&str> = told.map(|trace| trace["legendgroup"].as_str().unwrap()).collect();
            labels.sort_unstable();
            let mut expected: Vec<&str> = it.curves().map(|curve| &*curve.label).collect();
            expected.sort_unstable();
            expected.dedup();
            assert_eq!(labels, expected);
        }
    }

    #[test]
    fn intervals_are_lengths_from_the_value() {
        let mark = Mark::measured(1.0, 2.0, [1.5, f64::INFINITY]);
        let panel = Panel::new("", Axis::linear("x [1]"), Axis::linear("y [1]"));
        let curve = Curve::method("a").with_marks([mark]);
        let looks = crate::palette::look(0);
        let trace = &curve_traces(&curve, &panel, looks, ["x", "y"], true)[0];
        assert_eq!(trace["error_y"]["arrayminus"], json!([0.5]));
        assert_eq!(trace["error_y"]["array"], json!([null]));
        assert_eq!(trace["text"][0], "x 1.00<br>y 2.00 [1.50, ∞]");
    }
}
