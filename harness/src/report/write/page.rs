//! `index.html`: one file that needs no other. Figures are inline SVG, images inline PNG; links lead to the files beside it.

use super::super::result::{ClaimVerdict, MediumReport, Report, SweepCurve};
use super::colour_map;
use super::figure::Finished;
use super::images::{Exhibit, Gallery, Picture};
use super::markdown;
use super::number::{listed, short, short_of_log10};
use super::optimum::{self, Optimum, Place};
use super::palette::{is_oracle, look};
use super::png;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value, context};
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// Stops of the gradient that stands for the diverging map.
const STOPS: i32 = 16;

#[derive(Serialize)]
struct FigureView<'a> {
    id: &'a str,
    title: &'a str,
    caption: &'a str,
    svg: String,
}

#[derive(Serialize)]
struct MediumView<'a> {
    id: &'a str,
    title: &'a str,
    description: &'a str,
    facts: Vec<(&'static str, String)>,
    figures: Vec<FigureView<'a>>,
    optima: Vec<markdown::OptimumRow>,
    galleries: Vec<GalleryView<'a>>,
}

#[derive(Serialize)]
struct GalleryView<'a> {
    id: String,
    budget: String,
    scale: String,
    gradient: String,
    exact_error: String,
    width: usize,
    height: usize,
    exact: PictureView<'a>,
    panels: Vec<ExhibitView<'a>>,
}

#[derive(Serialize)]
struct ExhibitView<'a> {
    label: &'a str,
    estimate: PictureView<'a>,
    error: PictureView<'a>,
    rmse: String,
    interval: [String; 2],
    lookups: String,
    seconds: String,
    remarks: String,
}

#[derive(Serialize)]
struct PictureView<'a> {
    file: &'a str,
    base64: String,
}

#[derive(Serialize)]
struct ClaimView<'a> {
    id: &'a str,
    claim: &'a str,
    source: &'a str,
    measured: &'a str,
    comment: &'a str,
    verdict: ClaimVerdict,
    words: &'static str,
}

/// The page.
pub(super) fn html(
    report: &Report,
    figures: &[Finished],
    galleries: &[Gallery<'_>],
) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("typeset", typeset);
    environment.add_template("page", TEMPLATE).map_err(|error| error.to_string())?;
    let media: Vec<MediumView<'_>> =
        report.media.iter().map(|part| medium(part, figures, galleries)).collect();
    let claims: Vec<ClaimView<'_>> = report
        .claims
        .iter()
        .map(|claim| ClaimView {
            id: &claim.id,
            claim: &claim.claim,
            source: &claim.source,
            measured: &claim.measured,
            comment: &claim.comment,
            verdict: claim.verdict,
            words: markdown::verdict(claim.verdict),
        })
        .collect();
    let page = environment.get_template("page").and_then(|template| {
        template.render(context! {
            style => Value::from_safe_string(STYLE.to_owned()),
            provenance => Serde(&report.provenance),
            quick => report.quick,
            seconds => short(report.seconds),
            threads => report.threads,
            findings => Serde(report.media.iter().map(findings).collect::<Vec<_>>()),
            verdicts => verdicts(report),
            arrows => markdown::ARROWS,
            stability => Serde(&report.stability),
            media => Serde(&media),
            claims => Serde(&claims),
        })
    });
    page.map_err(|error| format!("the page: {error}"))
}

/// Greek with an index reads better typeset. Everything else of the text is escaped.
fn typeset(text: &str) -> Value {
    let mut escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    for index in ["samp", "main", "diff", "t"] {
        // The longer names come first; a name ends where its letters do.
        for name in [format!("σ_{index}"), format!("sigma_{index}")] {
            escaped = escaped.replace(&name, &format!("σ<sub>{index}</sub>"));
        }
    }
    Value::from_safe_string(escaped)
}

fn medium<'a>(
    part: &'a MediumReport,
    figures: &'a [Finished],
    galleries: &'a [Gallery<'_>],
) -> MediumView<'a> {
    let ray = &part.ray;
    let vector = |v: [f64; 3]| format!("({})", v.map(|x| format!("{x}")).join(", "));
    MediumView {
        id: &part.id,
        title: &part.title,
        description: &part.description,
        facts: vec![
            ("entry", vector(ray.entry)),
            ("direction", vector(ray.direction)),
            ("length", format!("{}", ray.length)),
            (
                "optical thickness",
                format!("{} ± {}", ray.optical_thickness, short(ray.optical_thickness_error)),
            ),
            ("transmittance T", format!("{}", ray.transmittance)),
            ("greatest σ_t", short(ray.maximum)),
            ("mean σ_t", short(ray.mean)),
        ],
        figures: figures.iter().filter(|figure| figure.medium == part.id).map(figure_view).collect(),
        optima: markdown::optima(part),
        galleries: galleries
            .iter()
            .filter(|gallery| gallery.study.medium == part.id)
            .map(gallery_view)
            .collect(),
    }
}

fn figure_view(figure: &Finished) -> FigureView<'_> {
    // An inline SVG needs no name space, and its size is the page's affair.
    let svg = figure.drawing.svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let label = figure.title.replace('"', "");
    let svg = svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" "), 1);
    FigureView { id: &figure.id, title: &figure.title, caption: &figure.caption, svg }
}

fn gallery_view<'a>(gallery: &'a Gallery<'_>) -> GalleryView<'a> {
    let study = gallery.study;
    let stops: Vec<String> = (0..=STOPS)
        .map(|k| {
            let (r, g, b) = colour_map::diverging(2.0 * f64::from(k) / f64::from(STOPS) - 1.0);
            format!("rgb({r} {g} {b})")
        })
        .collect();
    GalleryView {
        id: gallery.id(),
        budget: study.budget.to_string(),
        scale: short(gallery.scale),
        gradient: stops.join(", "),
        exact_error: short(study.exact_error),
        width: study.resolution[0],
        height: study.resolution[1],
        exact: picture(&gallery.exact),
        panels: gallery.panels.iter().map(exhibit).collect(),
    }
}

fn exhibit<'a>(exhibit: &'a Exhibit<'_>) -> ExhibitView<'a> {
    let panel = exhibit.panel;
    let percent = |share: f64| format!("{} %", short(100.0 * share));
    let mut remarks = Vec::new();
    if exhibit.beyond > 0.0 {
        remarks.push(format!("{} of the pixels beyond the error scale", percent(exhibit.beyond)));
    }
    if exhibit.outside > 0.0 {
        remarks.push(format!("{} outside [0, 1]", percent(exhibit.outside)));
    }
    ExhibitView {
        label: &exhibit.label,
        estimate: picture(&exhibit.estimate),
        error: picture(&exhibit.error),
        rmse: short(panel.rmse),
        interval: panel.rmse_interval.map(short),
        lookups: short(panel.lookups_per_pixel),
        seconds: short(panel.seconds),
        remarks: remarks.join("; "),
    }
}

fn picture(picture: &Picture) -> PictureView<'_> {
    PictureView { file: &picture.file, base64: png::base64(&picture.png) }
}

/// What was found on one ray: a sentence and a list, both made of numbers of the report.
#[derive(Serialize)]
struct Findings {
    lead: String,
    items: Vec<String>,
}

fn findings(part: &MediumReport) -> Findings {
    let competing = |curve: &&SweepCurve| !curve.series.is_baseline() && !is_oracle(curve.series);
    let mut best: Vec<Optimum<'_>> =
        part.sweeps.iter().filter(competing).filter_map(optimum::per_lookup).collect();
    best.sort_by(|a, b| b.log10_efficiency.total_cmp(&a.log10_efficiency));
    // Of the curves of a series, which differ in the albedo, the most efficient is told.
    let mut told = Vec::new();
    best.retain(|best| {
        let new = !told.contains(&best.curve.series);
        told.push(best.curve.series);
        new
    });
    let ray = format!(
        "{}, on a ray of transmittance {} with σ_t up to {}: ",
        part.title,
        short(part.ray.transmittance),
        short(part.ray.maximum)
    );
    let lead = match best.first() {
        None => format!("{ray}no unbiased estimator has an optimum."),
        Some(first) => format!(
            "{ray}the most efficient unbiased estimator without an oracle is {}. The best σ_samp of each, with its efficiency              T²/(variance · look-ups):",
            look(first.curve.series).name
        ),
    };
    Findings { lead, items: best.iter().map(item).collect() }
}

fn item(best: &Optimum<'_>) -> String {
    let albedo = best.curve.albedo.map_or_else(String::new, |albedo| format!(" (albedo {albedo})"));
    let end = match best.place {
        Place::Inside => "",
        Place::LowerEnd => ", the lower end of its curve",
        Place::UpperEnd => ", the upper end of its curve",
    };
    format!(
        "{}{albedo}: σ_samp = {}{end}; efficiency {}",
        look(best.curve.series).name,
        short(best.sigma_samp),
        short_of_log10(best.log10_efficiency)
    )
}

/// The ledger and the verdicts of the sweeps in numbers.
fn verdicts(report: &Report) -> Vec<String> {
    use ClaimVerdict::{DoesNotHold, Holds, HoldsUnder, NotTestable};
    let mut sentences = Vec::new();
    if !report.claims.is_empty() {
        let count = |verdict| report.claims.iter().filter(|claim| claim.verdict == verdict).count();
        let counts = [Holds, HoldsUnder, DoesNotHold, NotTestable]
            .map(|verdict| format!("{} “{}”", count(verdict), markdown::verdict(verdict)));
        sentences.push(format!(
            "Verdicts on {} claims of the papers: {}.",
            report.claims.len(),
            listed(&counts)
        ));
    }
    // A baseline is known to be biased: that its test fails is no news.
    let curves =
        || report.media.iter().flat_map(|part| &part.sweeps).filter(|curve| !curve.series.is_baseline());
    let points = || curves().flat_map(|curve| &curve.points).filter_map(|point| point.measured.as_ref());
    if points().next().is_some() {
        let sound = |verdict| points().filter(|measured| measured.sound == verdict).count();
        sentences.push(format!(
            "Of {} measured points of the unbiased estimators {} agree with the closed forms, {} do not, and {} cannot be tested with              these samples.",
            points().count(),
            sound(Some(true)),
            sound(Some(false)),
            sound(None)
        ));
    }
    sentences
}

#[cfg(test)]
mod tests {
    use super::typeset;

    #[test]
    fn indices_are_typeset_and_the_rest_is_escaped() {
        let text = typeset("a < σ_samp & sigma_t").to_string();
        assert_eq!(text, "a &lt; σ<sub>samp</sub> &amp; σ<sub>t</sub>");
    }
}
