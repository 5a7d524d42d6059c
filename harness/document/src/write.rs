//! Files of a document.

use crate::figure::{self, Drawing, data};
use crate::palette::Looks;
use crate::{Block, Document, check, csv, markdown, page, picture};
use rayon::prelude::*;

/// A file of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without folders.
    pub name: String,
    /// Its contents.
    pub bytes: Vec<u8>,
}

impl File {
    fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: bytes.into() }
    }
}

/// The charts of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Script {
    /// Drawn by a script library that the page carries: 4.7 MB.
    Embedded,
    /// The static figures: for pages that are kept in a repository.
    None,
}

/// All files of a document but `results.json`, which holds what the document was made of: the page first.
///
/// # Errors
/// The first mistake of a document: an id used twice, a row with too few cells, a picture with too few pixels.
pub fn files(document: &Document, script: Script) -> Result<Vec<File>, String> {
    check::check(document)?;
    let document = &figure::thinned(document);
    let looks = Looks::of(document);
    let blocks: Vec<&Block> = document.blocks().collect();
    let drawn: Vec<Option<Drawing>> =
        blocks.par_iter().map(|block| drawing(block, &looks)).collect::<Result<_, String>>()?;
    let page = page::html(document, &looks, script)?;
    let mut files =
        vec![File::new("index.html", page), File::new(markdown::FILE, markdown::tables(document))];
    for (block, drawing) in blocks.into_iter().zip(drawn) {
        let (id, table) = match block {
            Block::Chart(chart) => (&chart.id, data::rounded(data::of_chart(chart))),
            Block::HeatMap(map) => (&map.id, data::rounded(data::of_heat_map(map))),
            Block::Table(table) => (&table.id, table.clone()),
            Block::Gallery(gallery) => {
                let pictures: Vec<_> = gallery.rows.iter().flat_map(|row| &row.pictures).collect();
                let encoded = pictures
                    .par_iter()
                    .map(|it| Ok(File::new(format!("{}.png", it.id), picture::encoded(it)?)));
                files.extend(encoded.collect::<Result<Vec<_>, String>>()?);
                continue;
            }
            Block::Text(_) | Block::Facts(_) => continue,
        };
        if let Some(drawing) = drawing {
            files.push(File::new(format!("{id}.svg"), drawing.svg));
            files.push(File::new(format!("{id}.png"), drawing.png));
        }
        files.push(File::new(format!("{id}.csv"), csv::csv(&table)));
    }
    Ok(files)
}

fn drawing(block: &Block, looks: &Looks<'_>) -> Result<Option<Drawing>, String> {
    match block {
        Block::Chart(chart) => figure::of_chart(chart, looks).map(Some),
        Block::HeatMap(map) => figure::of_heat_map(map, looks).map(Some),
        _ => Ok(None),
    }
}
