//! `index.html`: the answer first, then figures, then tables. It opens without network; pictures, data and static figures lie beside it.

use crate::csv::heading;
use crate::figure::{data, heat_map::alternative};
use crate::markdown::words;
use crate::palette::Looks;
use crate::{Block, Cell, Chart, Claim, ClaimVerdict, Document, Gallery, Picture, Script, Table};
use crate::{colour_map, interactive, listed, palette, picture, short};
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value, context};
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
const CODE: &str = include_str!("page.js");
/// Rows of the longest table that is not folded.
const OPEN_ROWS: usize = 12;
/// Characters of the longest ledger of claims that is not folded.
const OPEN_LETTERS: usize = 5000;
/// Stops of the gradient that stands for the diverging map.
const STOPS: i32 = 16;

/// A block as the template reads it.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum BlockView<'a> {
    Text { text: &'a str },
    Facts { facts: &'a [(String, String)] },
    Figure(FigureView<'a>),
    Table(TableView<'a>),
    Gallery(GalleryView<'a>),
}

#[derive(Serialize)]
struct FigureView<'a> {
    id: &'a str,
    title: &'a str,
    caption: &'a str,
    /// Endings of the files that the page needs.
    endings: &'static [&'static str],
    /// Content, for those who do not see it.
    alternative: String,
    /// JSON for the script library; empty without it.
    plot: String,
    table: TableView<'a>,
    wide: bool,
}

#[derive(Serialize)]
struct TableView<'a> {
    id: &'a str,
    title: &'a str,
    caption: &'a str,
    folded: Option<String>,
    columns: Vec<CellView>,
    rows: Vec<Vec<CellView>>,
}

#[derive(Serialize)]
struct CellView {
    text: String,
    right: bool,
}

#[derive(Serialize)]
struct GalleryView<'a> {
    id: &'a str,
    title: &'a str,
    caption: &'a str,
    tone_mapping: String,
    scales: Vec<String>,
    gradient: String,
    rows: Vec<RowView<'a>>,
}

#[derive(Serialize)]
struct RowView<'a> {
    label: &'a str,
    pictures: Vec<PictureView<'a>>,
}

#[derive(Serialize)]
struct PictureView<'a> {
    #[serde(flatten)]
    picture: &'a Picture,
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct SectionView<'a> {
    id: &'a str,
    title: &'a str,
    folded: Option<String>,
    blocks: Vec<BlockView<'a>>,
}

#[derive(Serialize)]
struct ClaimView<'a> {
    #[serde(flatten)]
    claim: &'a Claim,
    words: &'static str,
}

/// Writes the page.
pub(crate) fn html(document: &Document, looks: &Looks<'_>, script: Script) -> Result<String, String> {
    let mut hero = None;
    let mut sections = Vec::new();
    for section in &document.sections {
        let folded = section.folded.then(|| format!("{} figures and tables", section.blocks.len()));
        let mut view = SectionView { id: &section.id, title: &section.title, folded, blocks: Vec::new() };
        for block in &section.blocks {
            let figures = if section.folded { Script::None } else { script };
            let mut view_of = block_view(block, looks, figures);
            if let BlockView::Figure(figure) = &mut view_of {
                // The words of a static figure are small: it has a row of its own.
                figure.wide |= figures == Script::None && document.hero.as_deref() != Some(figure.id);
                if script == Script::Embedded {
                    figure.endings = &["csv", "svg", "png"];
                }
            }
            match (&view_of, &document.hero) {
                (BlockView::Figure(figure), Some(id)) if figure.id == id => hero = Some(view_of),
                _ => view.blocks.push(view_of),
            }
        }
        sections.push(view);
    }
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("typeset", typeset);
    environment.add_template("page", TEMPLATE).map_err(|error| error.to_string())?;
    let claims: Vec<ClaimView<'_>> =
        document.claims.iter().map(|claim| ClaimView { claim, words: claim.verdict.words() }).collect();
    let library = match script {
        Script::Embedded => Some(Value::from_safe_string(interactive::script())),
        Script::None => None,
    };
    let page = environment.get_template("page").and_then(|template| {
        template.render(context! {
            style => Value::from_safe_string(STYLE.to_owned()),
            code => Value::from_safe_string(CODE.to_owned()),
            library,
            title => &document.title,
            provenance => Serde(&document.provenance),
            quick => document.quick,
            seconds => short(document.seconds),
            threads => document.threads,
            summary => &document.summary,
            unsound => &document.unsound,
            verdicts => Serde(&claim_counts(&document.claims)),
            claims => Serde(&claims),
            claims_are_open => letters(&document.claims) <= OPEN_LETTERS,
            hero => Serde(&hero),
            sections => Serde(&sections),
        })
    });
    page.map_err(|error| format!("the page: {error}"))
}

fn block_view<'a>(block: &'a Block, looks: &Looks<'_>, script: Script) -> BlockView<'a> {
    let plot = |value: &dyn Fn() -> serde_json::Value| match script {
        // A tag inside a script must not end it.
        Script::Embedded => value().to_string().replace("</", "<\\/"),
        Script::None => String::new(),
    };
    match block {
        Block::Text(text) => BlockView::Text { text },
        Block::Facts(facts) => BlockView::Facts { facts },
        Block::Chart(chart) => BlockView::Figure(FigureView {
            plot: plot(&|| interactive::chart(chart, looks)),
            wide: chart.panels.len() > 1 && chart.arrangement == crate::Arrangement::Row,
            ..figure([&chart.id, &chart.title, &chart.caption], chart_label(chart), &data::measured(chart))
        }),
        Block::HeatMap(map) => BlockView::Figure(FigureView {
            plot: plot(&|| interactive::heat_map(map, looks)),
            wide: true,
            ..figure([&map.id, &map.title, &map.caption], alternative(map), &data::summary(map))
        }),
        Block::Table(it) => BlockView::Table(table(it)),
        Block::Gallery(it) => BlockView::Gallery(gallery(it)),
    }
}

fn letters(claims: &[Claim]) -> usize {
    claims.iter().map(|it| it.claim.len() + it.measured.len() + it.comment.len()).sum()
}

fn chart_label(chart: &Chart) -> String {
    let labels: Vec<&str> = chart.curves().map(|curve| &*curve.label).collect();
    let mut unique: Vec<String> = Vec::new();
    for label in labels {
        if unique.iter().all(|known| known != label) {
            unique.push(label.to_owned());
        }
    }
    let axes = &chart.panels[0];
    format!("{}: {} over {}, of {}", chart.title, axes.y.title, axes.x.title, listed(&unique))
}

fn figure<'a>([id, title, caption]: [&'a str; 3], alternative: String, values: &Table) -> FigureView<'a> {
    let TableView { folded, columns, rows, .. } = table(values);
    let table = TableView { id: "", title: "", caption: "", folded, columns, rows };
    FigureView {
        id,
        title,
        caption,
        alternative,
        endings: &["csv", "svg"],
        plot: String::new(),
        table,
        wide: false,
    }
}

fn table(it: &Table) -> TableView<'_> {
    let is_number = |cell: &Cell| matches!(cell, Cell::Number(_) | Cell::Count(_) | Cell::Measured { .. });
    // A heading and an empty cell stand where the numbers of their column stand.
    let right = |k: usize| it.rows.iter().any(|row| row.get(k).is_some_and(is_number));
    let cell = |(k, cell): (usize, &Cell)| CellView {
        text: words(cell),
        right: is_number(cell) || (*cell == Cell::Empty && right(k)),
    };
    let columns = it.columns.iter().enumerate();
    let long = (it.rows.len() > OPEN_ROWS).then(|| format!("{} rows", it.rows.len()));
    TableView {
        id: &it.id,
        title: &it.title,
        caption: &it.caption,
        folded: it.folded.clone().or(long),
        columns: columns.map(|(k, column)| CellView { text: heading(column), right: right(k) }).collect(),
        rows: it.rows.iter().map(|row| row.iter().enumerate().map(cell).collect()).collect(),
    }
}

fn gallery(it: &Gallery) -> GalleryView<'_> {
    let rows = it.rows.iter().map(|row| RowView {
        label: &row.label,
        pictures: row
            .pictures
            .iter()
            .map(|each| PictureView { picture: each, remarks: picture::remarks(it, each) })
            .collect(),
    });
    GalleryView {
        id: &it.id,
        title: &it.title,
        caption: &it.caption,
        tone_mapping: picture::tone_mapping(it),
        scales: picture::scales(it).into_iter().map(short).collect(),
        gradient: gradient(),
        rows: rows.collect(),
    }
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

/// The diverging map from end to end, as stops of a gradient.
fn gradient() -> String {
    let stop = |k: i32| palette::css(colour_map::diverging(2.0 * f64::from(k) / f64::from(STOPS) - 1.0));
    (0..=STOPS).map(stop).collect::<Vec<String>>().join(", ")
}

/// Numbers of the verdicts on the claims; none without claims.
fn claim_counts(claims: &[Claim]) -> Vec<(&'static str, usize, ClaimVerdict)> {
    let count = |verdict| claims.iter().filter(|claim| claim.verdict == verdict).count();
    ClaimVerdict::ALL
        .into_iter()
        .map(|verdict| (verdict.words(), count(verdict), verdict))
        .filter(|(_, count, _)| *count > 0)
        .collect()
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
