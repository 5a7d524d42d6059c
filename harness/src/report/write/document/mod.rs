//! Writers of a [`Document`]: they read it and nothing else.

mod chart;
mod check;
mod gallery;
mod heat_map;
mod markdown;
mod page;
mod styles;
mod table;

#[cfg(test)]
pub(crate) mod fixture;
#[cfg(test)]
mod tests;

use super::{Files, folder, json};
use crate::Failure;
use crate::report::document::Document;
use rayon::prelude::*;
use std::path::Path;

impl Files for Document {
    fn write(&self, folder: &Path) -> Result<(), Failure> {
        let failed = |reason: String| Failure::not_written(folder, reason);
        let file = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            std::fs::write(&path, bytes).map_err(|error| Failure::not_written(&path, error))
        };
        check::check(self).map_err(failed)?;
        file(folder::RESULTS, &json::json(self).map_err(|error| failed(error.to_string()))?)?;
        file(super::markdown::FILE, markdown::tables(self).as_bytes())?;

        let styles = styles::Styles::of(self);
        let charts: Vec<_> = self.sections.iter().flat_map(|section| &section.charts).collect();
        let charts: Vec<_> = charts
            .par_iter()
            .map(|chart| chart::finished(chart, &styles))
            .collect::<Result<_, _>>()
            .map_err(failed)?;
        for chart in &charts {
            file(&format!("{}.svg", chart.id), chart.drawing.svg.as_bytes())?;
            file(&format!("{}.png", chart.id), &chart.drawing.png)?;
            file(&format!("{}.csv", chart.id), chart.csv.as_bytes())?;
        }
        let heat_maps: Vec<_> = self.sections.iter().flat_map(|section| &section.heat_maps).collect();
        let heat_maps: Vec<_> = heat_maps
            .par_iter()
            .map(|map| heat_map::finished(map, &styles))
            .collect::<Result<_, _>>()
            .map_err(failed)?;
        for map in &heat_maps {
            file(&format!("{}.svg", map.id), map.drawing.svg.as_bytes())?;
            file(&format!("{}.png", map.id), &map.drawing.png)?;
            file(&format!("{}.csv", map.id), map.csv.as_bytes())?;
        }
        for table in self.sections.iter().flat_map(|section| &section.tables) {
            file(&format!("{}.csv", table.id), table::csv(table).as_bytes())?;
        }
        let galleries: Vec<_> = self.sections.iter().flat_map(|section| &section.galleries).collect();
        let galleries: Vec<_> = galleries
            .par_iter()
            .map(|gallery| gallery::hung(gallery))
            .collect::<Result<_, _>>()
            .map_err(failed)?;
        for exhibit in galleries.iter().flat_map(gallery::Hung::exhibits) {
            file(&format!("{}.png", exhibit.picture.id), &exhibit.png)?;
        }
        let page = page::html(self, &charts, &heat_maps, &galleries).map_err(failed)?;
        file("index.html", page.as_bytes())
    }
}
