//! Pictures side by side.

use serde::Serialize;

/// Pictures that are compared with each other.
#[derive(Clone, Debug, Serialize)]
pub struct Gallery {
    /// Its place in the page.
    pub id: String,
    /// One line.
    pub title: String,
    /// Finding. Writers say how values become colours.
    pub caption: String,
    /// The rows, one per method or per budget.
    pub rows: Vec<GalleryRow>,
}

impl Gallery {
    /// One image of each measurement, in one row.
    #[must_use]
    pub fn of_row(id: &str, title: &str, pictures: Vec<Picture>) -> Self {
        Self::of_images(id, title, vec![(String::new(), pictures)])
    }

    /// One image of each measurement, in rows with a label.
    #[must_use]
    pub fn of_images(id: &str, title: &str, rows: Vec<(String, Vec<Picture>)>) -> Self {
        let rows = rows.into_iter().map(|(label, pictures)| GalleryRow { label, pictures });
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            caption: "One image of each measurement.".to_owned(),
            rows: rows.collect(),
        }
    }

    /// The same gallery with this caption.
    #[must_use]
    pub fn with_caption(self, caption: &str) -> Self {
        Self { caption: caption.to_owned(), ..self }
    }
}

/// A row of a gallery.
#[derive(Clone, Debug, Serialize)]
pub struct GalleryRow {
    /// Common trait of its pictures; may be empty.
    pub label: String,
    /// The pictures.
    pub pictures: Vec<Picture>,
}

/// A picture. Its pixels are in its file only.
#[derive(Clone, Debug, Serialize)]
pub struct Picture {
    /// Name of its file without ending.
    pub id: String,
    /// Content, in a few words.
    pub label: String,
    /// Numbers below it, one line each.
    pub lines: Vec<String>,
    /// Width and height in pixels.
    pub resolution: [usize; 2],
    /// The values, and how they become colours.
    pub pixels: Pixels,
}

/// The values of a picture, row 0 on top, and how they become colours.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "mapping", rename_all = "snake_case")]
pub enum Pixels {
    /// Radiance in linear RGB: sRGB encoding of clamp(exposure · L, 0, 1).
    Radiance {
        /// In any one unit of radiance.
        #[serde(skip)]
        values: Vec<[f64; 3]>,
        /// In one over that unit.
        exposure: f64,
    },
    /// Differences: from blue at −scale over white at 0 to orange at +scale, the end colours beyond.
    Signed {
        /// In any one unit.
        #[serde(skip)]
        values: Vec<f64>,
        /// In that unit; the same for all pictures that are to be compared.
        scale: f64,
    },
}
