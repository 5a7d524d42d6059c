//! `index.html` of a document: one file that needs no other, in the look of the standard report.

use super::super::number::short;
use super::super::page::{self, FigureView, PictureView};
use super::chart::Finished;
use super::gallery::{Exhibit, Hung};
use super::heat_map;
use super::table::{heading, is_number, words};
use crate::report::document::{Cell, Document, Picture, Pixels, Section, Table};
use minijinja::context;
use minijinja::value::Serde;
use serde::Serialize;

#[derive(Serialize)]
struct SectionView<'a> {
    id: &'a str,
    title: &'a str,
    text: &'a [String],
    charts: Vec<FigureView<'a>>,
    heat_maps: Vec<FigureView<'a>>,
    tables: Vec<TableView<'a>>,
    galleries: Vec<GalleryView<'a>>,
}

#[derive(Serialize)]
struct TableView<'a> {
    id: &'a str,
    title: &'a str,
    caption: &'a str,
    columns: Vec<HeadView>,
    rows: Vec<Vec<CellView>>,
}

#[derive(Serialize)]
struct HeadView {
    text: String,
    right: bool,
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
    pictures: Vec<ExhibitView<'a>>,
}

#[derive(Serialize)]
struct ExhibitView<'a> {
    label: &'a str,
    lines: Vec<&'a str>,
    remarks: Vec<String>,
    width: usize,
    height: usize,
    image: PictureView,
}

/// The page.
pub(super) fn html(
    document: &Document,
    charts: &[Finished<'_>],
    heat_maps: &[heat_map::Finished<'_>],
    galleries: &[Hung<'_>],
) -> Result<String, String> {
    let sections: Vec<SectionView<'_>> =
        document.sections.iter().map(|part| section(part, charts, heat_maps, galleries)).collect();
    page::render(
        "document",
        context! {
            title => &document.title,
            provenance => Serde(&document.provenance),
            quick => document.quick,
            seconds => short(document.seconds),
            threads => document.threads,
            summary => &document.summary,
            unsound => &document.unsound,
            verdicts => page::claim_counts(&document.claims),
            claims => Serde(&page::claims(&document.claims)),
            sections => Serde(&sections),
        },
    )
}

fn section<'a>(
    part: &'a Section,
    charts: &[Finished<'a>],
    heat_maps: &[heat_map::Finished<'a>],
    galleries: &'a [Hung<'a>],
) -> SectionView<'a> {
    SectionView {
        id: &part.id,
        title: &part.title,
        text: &part.text,
        charts: part
            .charts
            .iter()
            .filter_map(|chart| charts.iter().find(|finished| finished.id == chart.id))
            .map(|it| FigureView {
                id: it.id,
                title: &it.chart.title,
                caption: &it.chart.caption,
                svg: page::inline(&it.drawing.svg, &it.chart.title),
            })
            .collect(),
        heat_maps: part
            .heat_maps
            .iter()
            .filter_map(|map| heat_maps.iter().find(|finished| finished.id == map.id))
            .map(|it| FigureView {
                id: it.id,
                title: &it.map.title,
                caption: &it.map.caption,
                svg: page::inline(&it.drawing.svg, &it.alternative),
            })
            .collect(),
        tables: part.tables.iter().map(table).collect(),
        galleries: part
            .galleries
            .iter()
            .filter_map(|gallery| galleries.iter().find(|hung| hung.gallery.id == gallery.id))
            .map(gallery)
            .collect(),
    }
}

fn table(table: &Table) -> TableView<'_> {
    // A heading and an empty cell stand where the numbers of their column stand.
    let right = |k: usize| table.rows.iter().any(|row| row.get(k).is_some_and(is_number));
    let cell = |(k, cell): (usize, &Cell)| CellView {
        text: words(cell),
        right: is_number(cell) || (*cell == Cell::Empty && right(k)),
    };
    TableView {
        id: &table.id,
        title: &table.title,
        caption: &table.caption,
        columns: table
            .columns
            .iter()
            .enumerate()
            .map(|(k, column)| HeadView { text: heading(column), right: right(k) })
            .collect(),
        rows: table.rows.iter().map(|row| row.iter().enumerate().map(cell).collect()).collect(),
    }
}

fn gallery<'a>(hung: &'a Hung<'a>) -> GalleryView<'a> {
    let several = hung.exposures().len() > 1;
    let row = |(row, exhibits): (&'a crate::report::document::GalleryRow, &'a Vec<Exhibit<'a>>)| RowView {
        label: &row.label,
        pictures: exhibits.iter().map(|it| exhibit(it, several)).collect(),
    };
    GalleryView {
        id: &hung.gallery.id,
        title: &hung.gallery.title,
        caption: &hung.gallery.caption,
        tone_mapping: hung.tone_mapping(),
        scales: hung.scales().into_iter().map(short).collect(),
        gradient: page::gradient(),
        rows: hung.gallery.rows.iter().zip(&hung.rows).map(row).collect(),
    }
}

fn exhibit<'a>(exhibit: &'a Exhibit<'a>, tell_exposure: bool) -> ExhibitView<'a> {
    let Picture { id, label, lines, resolution, pixels } = exhibit.picture;
    let exposure = match pixels {
        Pixels::Radiance { exposure, .. } if tell_exposure => Some(format!("exposure {}", short(*exposure))),
        _ => None,
    };
    let remark = (!exhibit.remark.is_empty()).then(|| exhibit.remark.clone());
    ExhibitView {
        label,
        lines: lines.iter().map(String::as_str).collect(),
        remarks: exposure.into_iter().chain(remark).collect(),
        width: resolution[0],
        height: resolution[1],
        image: PictureView::new(format!("{id}.png"), &exhibit.png),
    }
}
