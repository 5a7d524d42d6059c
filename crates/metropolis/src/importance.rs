//! Importance of pixels: targets that spend more of a chain where an image is noisy.

/// Importance of each pixel of an image, for targets that are not brightness alone (hoberock-2010, antwerpen-2011 section 6.7).
///
/// A chain follows f* = Σ over contributions of max channel |F| · importance of the pixel, and deposits F/f* as any other: the start, the
/// brightness that multiplies and the score change together, so that the expectation stays what it was.
///
/// **Law.** Any positive importance has the same image. One that is learnt must come from other streams and be the same for a whole replica: then each stage
/// of learning has a bootstrap set of its own, and brings no start-up bias, which hoberock-2010 leaves open. Stages are averaged with weights fixed
/// before, as their numbers of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Importance {
    columns: u32,
    values: Vec<f64>,
    floor: f64,
}

/// Error of a map that is no importance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ImportanceError {
    /// A value for each pixel.
    #[error("an importance of {columns} x {rows} pixels needs as many values, found {found}")]
    NotAnImage {
        /// Columns of the image.
        columns: u32,
        /// Rows of the image.
        rows: u32,
        /// Values given.
        found: usize,
    },
    /// A pixel that is not important at all would stay black.
    #[error("an importance must be a finite number above 0, found {0}")]
    NotPositive(f64),
}

impl Importance {
    /// The share of the mean below which no pixel falls that is learnt, where no other is asked for.
    pub const FLOOR: f64 = 0.1;

    /// One value for each pixel, row by row.
    ///
    /// # Errors
    /// If their number is not that of the pixels, or one is not positive and finite.
    pub fn new([columns, rows]: [u32; 2], values: Vec<f64>) -> Result<Self, ImportanceError> {
        let found = values.len();
        if columns == 0 || found as u64 != u64::from(columns) * u64::from(rows) {
            return Err(ImportanceError::NotAnImage { columns, rows, found });
        }
        match values.iter().find(|value| !(**value > 0.0 && value.is_finite())) {
            Some(&value) => Err(ImportanceError::NotPositive(value)),
            None => Ok(Self { columns, values, floor: Self::FLOOR }),
        }
    }

    /// 1 everywhere: what is followed is brightness.
    ///
    /// # Errors
    /// If there are no pixels.
    pub fn even(resolution: [u32; 2]) -> Result<Self, ImportanceError> {
        let pixels = u64::from(resolution[0]) * u64::from(resolution[1]);
        Self::new(resolution, vec![1.0; pixels as usize])
    }

    /// The same, from which others are learnt that fall nowhere below `floor` of their mean \[1\].
    ///
    /// # Errors
    /// If it is not positive and finite.
    pub fn with_floor(self, floor: f64) -> Result<Self, ImportanceError> {
        if floor > 0.0 && floor.is_finite() {
            Ok(Self { floor, ..self })
        } else {
            Err(ImportanceError::NotPositive(floor))
        }
    }

    /// That of a pixel (column, row) of the image.
    #[inline]
    #[must_use]
    pub fn of(&self, [column, row]: [u32; 2]) -> f64 {
        self.values[row as usize * self.columns as usize + column as usize]
    }

    /// The importance for the next stage, of means and variances of the pixels over replicas of a stage with this one; the means by magnitude.
    ///
    /// A chain visits a pixel in proportion to mean · importance. A pixel's variance falls with the visits, so that the sum of variances is least where the
    /// visits go as √(variance · visits so far): the importance as √(variance · importance/mean). Values are scaled to a mean of 1, and raised to
    /// the floor of that; a pixel of which nothing was seen gets the floor.
    ///
    /// # Errors
    /// If the numbers of values differ from that of the pixels.
    pub fn learn(&self, means: &[f64], variances: &[f64]) -> Result<Self, ImportanceError> {
        let resolution = [self.columns, (self.values.len() / self.columns as usize) as u32];
        let [columns, rows] = resolution;
        let wrong = [means, variances].into_iter().find(|map| map.len() != self.values.len());
        if let Some(map) = wrong {
            return Err(ImportanceError::NotAnImage { columns, rows, found: map.len() });
        }
        let wanted: Vec<f64> = (means.iter().zip(variances).zip(&self.values))
            .map(|((mean, variance), value)| (variance * value / mean.abs()).sqrt())
            .map(|wanted| if wanted.is_finite() { wanted } else { 0.0 })
            .collect();
        let mean = wanted.iter().sum::<f64>() / wanted.len() as f64;
        if mean == 0.0 {
            return Ok(self.clone());
        }
        let next = wanted.iter().map(|wanted| (wanted / mean).max(self.floor)).collect();
        Self::new(resolution, next)?.with_floor(self.floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_importance_evens_out_the_noise() {
        // Four pixels as noisy as their brightness has it: variance of the sum of visits ∝ mean²/visits, visits ∝ mean.
        let even = Importance::even([2, 2]).unwrap();
        let means = [4.0, 1.0, 1.0, 0.0];
        let next = even.learn(&means, &[4.0, 1.0, 16.0, 0.0]).unwrap();
        // √(1, 1, 16, –) = 1, 1, 4, 0, of the mean 1.5.
        let expected = [1.0 / 1.5, 1.0 / 1.5, 4.0 / 1.5, 0.1];
        for (index, expected) in expected.into_iter().enumerate() {
            let pixel = [index as u32 % 2, index as u32 / 2];
            assert!((next.of(pixel) - expected).abs() < 1e-15, "{pixel:?}");
        }
        let higher = even.clone().with_floor(0.7).unwrap().learn(&means, &[4.0, 1.0, 16.0, 0.0]).unwrap();
        assert_eq!((higher.of([1, 0]), higher.of([1, 1])), (0.7, 0.7));
        assert_eq!(even.learn(&means, &[0.0; 4]), Ok(even));
    }

    #[test]
    fn a_map_that_is_no_importance_is_refused() {
        let missing = Importance::new([2, 2], vec![1.0; 3]);
        assert_eq!(missing, Err(ImportanceError::NotAnImage { columns: 2, rows: 2, found: 3 }));
        assert_eq!(Importance::new([1, 1], vec![0.0]), Err(ImportanceError::NotPositive(0.0)));
        assert!(Importance::even([0, 3]).is_err());
        assert_eq!(Importance::even([1, 1]).unwrap().with_floor(0.0), Err(ImportanceError::NotPositive(0.0)));
        let error = Importance::even([1, 2]).unwrap().learn(&[1.0], &[1.0, 1.0]).unwrap_err();
        assert!(error.to_string().contains("1 x 2 pixels"));
    }
}
