//! `index.html`: one file that needs no other. Figures are inline SVG, images inline PNG; links lead to the files beside it.

use super::super::result::{Claim, ClaimVerdict, MediumReport, Report, SweepCurve};
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

const TEMPLATES: [(&str, &str); 3] = [
    ("parts", include_str!("page/parts.html")),
    ("standard", include_str!("page/standard.html")),
    ("document", include_str!("page/document.html")),
];
const STYLE: &str = include_str!("page/style.css");
/// Stops of the gradient that stands for the diverging map.
const STOPS: i32 = 16;

/// A drawing with its caption.
#[derive(Serialize)]
pub(super) struct FigureView<'a> {
    pub(super) id: &'a str,
    pub(super) title: &'a str,
    pub(super) caption: &'a str,
    pub(super) svg: String,
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
    exact: PictureView,
    panels: Vec<ExhibitView<'a>>,
}

#[derive(Serialize)]
struct ExhibitView<'a> {
    label: &'a str,
    estimate: PictureView,
    error: PictureView,
    rmse: String,
    interval: [String; 2],
    lookups: String,
    seconds: String,
    remarks: String,
}

/// An image that lives in the page, and its file.
#[derive(Serialize)]
pub(super) struct PictureView {
    file: String,
    base64: String,
}

impl PictureView {
    pub(super) fn new(file: String, bytes: &[u8]) -> Self {
        Self { file, base64: png::base64(bytes) }
    }
}

/// A line of the ledger.
#[derive(Serialize)]
pub(super) struct ClaimView<'a> {
    id: &'a str,
    claim: &'a str,
    source: &'a str,
    measured: &'a str,
    comment: &'a str,
    verdict: ClaimVerdict,
    words: &'static str,
}

/// Fills a template; all share the parts and the style.
pub(super) fn render(template: &str, values: Value) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("typeset", typeset);
    for (name, source) in TEMPLATES {
        environment.add_template(name, source).map_err(|error| error.to_string())?;
    }
    let style = Value::from_safe_string(STYLE.to_owned());
    let page = environment
        .get_template(template)
        .and_then(|template| template.render(context! { style => style, ..values }));
    // The imports of a template leave empty lines.
    page.map(|page| page.trim_start().to_owned()).map_err(|error| format!("the page: {error}"))
}

/// The page.
pub(super) fn html(
    report: &Report,
    figures: &[Finished],
    galleries: &[Gallery<'_>],
) -> Result<String, String> {
    let media: Vec<MediumView<'_>> =
        report.media.iter().map(|part| medium(part, figures, galleries)).collect();
    render(
        "standard",
        context! {
            provenance => Serde(&report.provenance),
            quick => report.quick,
            seconds => short(report.seconds),
            threads => report.threads,
            findings => Serde(report.media.iter().map(findings).collect::<Vec<_>>()),
            verdicts => verdicts(report),
            arrows => markdown::ARROWS,
            stability => Serde(&report.stability),
            media => Serde(&media),
            claims => Serde(&claims(&report.claims)),
        },
    )
}

/// The ledger with its verdicts in words.
pub(super) fn claims(claims: &[Claim]) -> Vec<ClaimView<'_>> {
    fn view(claim: &Claim) -> ClaimView<'_> {
        let Claim { id, claim, source, measured, verdict, comment } = claim;
        let words = markdown::verdict(*verdict);
        ClaimView { id, claim, source, measured, comment, verdict: *verdict, words }
    }
    claims.iter().map(view).collect()
}

/// Greek with an index reads better typeset. Everything else of the text is escaped.
fn typeset(text: &str) -> Value {
    let mut escaped = escaped(text);
    for index in ["samp", "main", "diff", "t"] {
        // The longer names come first; a name ends where its letters do.
        for name in [format!("σ_{index}"), format!("sigma_{index}")] {
            escaped = escaped.replace(&name, &format!("σ<sub>{index}</sub>"));
        }
    }
    Value::from_safe_string(escaped)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
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
    let svg = inline(&figure.drawing.svg, &figure.title);
    FigureView { id: &figure.id, title: &figure.title, caption: &figure.caption, svg }
}

/// A drawing for inside the page: it needs no name space, and its size is the page's affair.
pub(super) fn inline(svg: &str, title: &str) -> String {
    let svg = svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let label = escaped(title).replace('"', "");
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" "), 1)
}

/// The diverging map from end to end, as stops of a gradient.
pub(super) fn gradient() -> String {
    let stops: Vec<String> = (0..=STOPS)
        .map(|k| {
            let (r, g, b) = colour_map::diverging(2.0 * f64::from(k) / f64::from(STOPS) - 1.0);
            format!("rgb({r} {g} {b})")
        })
        .collect();
    stops.join(", ")
}

fn gallery_view<'a>(gallery: &'a Gallery<'_>) -> GalleryView<'a> {
    let study = gallery.study;
    GalleryView {
        id: gallery.id(),
        budget: study.budget.to_string(),
        scale: short(gallery.scale),
        gradient: gradient(),
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

fn picture(picture: &Picture) -> PictureView {
    PictureView::new(picture.file.clone(), &picture.png)
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
    let mut sentences = claim_counts(&report.claims);
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

/// How many claims hold: a sentence, if there are any.
pub(super) fn claim_counts(claims: &[Claim]) -> Vec<String> {
    use ClaimVerdict::{DoesNotHold, Holds, HoldsUnder, NotTestable};
    if claims.is_empty() {
        return Vec::new();
    }
    let count = |verdict| claims.iter().filter(|claim| claim.verdict == verdict).count();
    let counts = [Holds, HoldsUnder, DoesNotHold, NotTestable]
        .map(|verdict| format!("{} “{}”", count(verdict), markdown::verdict(verdict)));
    let plural = if claims.len() == 1 { "" } else { "s" };
    vec![format!("Verdicts on {} claim{plural} of the papers: {}.", claims.len(), listed(&counts))]
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
