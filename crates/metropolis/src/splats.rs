//! Contributions of one sample to an image.

use crate::Film;
use fairflight_scene::Spectrum;

/// Contributions of one sample to the pixels of an image, F, and their size.
#[derive(Clone, Debug)]
pub struct Splats<C> {
    list: Vec<([u32; 2], C)>,
}

impl<C> Default for Splats<C> {
    fn default() -> Self {
        Self { list: Vec::with_capacity(32) }
    }
}

impl<C: Spectrum> Splats<C> {
    /// Leaves nothing.
    pub fn clear(&mut self) {
        self.list.clear();
    }

    /// Adds a contribution to a pixel (column, row), unless it is 0.
    #[inline]
    pub fn push(&mut self, pixel: [u32; 2], value: C) {
        if value != C::ZERO {
            self.list.push((pixel, value));
        }
    }

    /// The contributions.
    #[must_use]
    pub fn list(&self) -> &[([u32; 2], C)] {
        &self.list
    }

    /// f*: the sum of the greatest absolute channel of each contribution, times what its pixel weighs. Colour and sign stay with F.
    #[must_use]
    pub fn magnitude(&self, importance: impl Fn([u32; 2]) -> f64) -> f64 {
        self.list.iter().map(|&(pixel, value)| value.magnitude() * importance(pixel)).sum()
    }

    /// The pixel of the greatest contribution; `None` without any.
    #[must_use]
    pub fn brightest(&self) -> Option<[u32; 2]> {
        let brighter =
            |a: &([u32; 2], C), b: &([u32; 2], C)| if b.1.magnitude() > a.1.magnitude() { *b } else { *a };
        self.list.iter().copied().reduce(|a, b| brighter(&a, &b)).map(|(pixel, _)| pixel)
    }

    /// Adds all, times `scale`, to a film.
    pub fn deposit(&self, scale: f64, film: &mut Film<'_, C>) {
        for &(pixel, value) in &self.list {
            film(pixel, value * scale);
        }
    }
}
