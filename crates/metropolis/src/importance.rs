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
}

/// The rule by which an importance is learnt from an image and its variances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImportanceRule {
    /// Sum of errors over the pixels that the spread of visits makes least.
    pub aim: Aim,
    /// The share of the mean below which no importance falls, above 0 \[1\]: a pixel that is not important at all would stay black.
    pub floor: f64,
    /// Pixels on each side that means and variances are averaged over: those of a few replicas are noisy. 0 for none.
    pub radius: u32,
}

/// Aim of the spread of a chain's visits over the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The least sum of the squared errors of all pixels.
    SquaredError,
    /// The least sum of their squared relative errors.
    RelativeError,
    /// As many visits to each pixel.
    EvenVisits,
}

impl Default for ImportanceRule {
    fn default() -> Self {
        Self { aim: Aim::SquaredError, floor: 0.1, radius: 2 }
    }
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
            None => Ok(Self { columns, values }),
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

    /// That of a pixel (column, row) of the image.
    #[inline]
    #[must_use]
    pub fn of(&self, [column, row]: [u32; 2]) -> f64 {
        self.values[row as usize * self.columns as usize + column as usize]
    }

    /// The importance for the next stage, of means and variances of the pixels over replicas of a stage with this one; the means by magnitude.
    ///
    /// A chain visits a pixel in proportion to n = mean · importance, and its variance falls with the visits: c/n with c = variance · n. The sum of w c/n at a
    /// fixed number of visits is least where n goes as √(w c): the next importance, n/mean, as √(w variance · importance/mean), w = 1 for squared
    /// errors and 1/mean² for relative ones. As many visits to each pixel: as 1/mean. Values are scaled to a mean of 1, and raised to the floor of
    /// that, as means are before they divide; a pixel around which nothing was seen gets the floor.
    ///
    /// **Smoothing.** variance · importance and mean are averaged over a box of pixels before. antwerpen-2011 section 6.7 has images of low resolution for that, which
    /// grow from stage to stage. Any positive map is lawful.
    ///
    /// # Errors
    /// If the numbers of values differ from that of the pixels, or the floor is not positive and finite.
    pub fn learn(
        &self,
        rule: &ImportanceRule,
        means: &[f64],
        variances: &[f64],
    ) -> Result<Self, ImportanceError> {
        let resolution = [self.columns, (self.values.len() / self.columns as usize) as u32];
        let [columns, rows] = resolution;
        let wrong = [means, variances].into_iter().find(|map| map.len() != self.values.len());
        if let Some(map) = wrong {
            return Err(ImportanceError::NotAnImage { columns, rows, found: map.len() });
        }
        let smooth = |values: Vec<f64>| averaged(&values, columns as usize, rule.radius as usize);
        let means = smooth(means.iter().map(|mean| mean.abs()).collect());
        let noise =
            smooth(variances.iter().zip(&self.values).map(|(variance, value)| variance * value).collect());
        let least = rule.floor * average(&means);
        let wanted = |(noise, mean): (&f64, &f64)| match rule.aim {
            Aim::SquaredError => (noise / mean).sqrt(),
            Aim::RelativeError => (noise / mean).sqrt() / mean.max(least),
            Aim::EvenVisits => mean.max(least).recip(),
        };
        let wanted = noise.iter().zip(&means).map(wanted);
        let wanted: Vec<f64> = wanted.map(|wanted| if wanted.is_finite() { wanted } else { 0.0 }).collect();
        let mean = average(&wanted);
        if mean == 0.0 {
            return Ok(self.clone());
        }
        Self::new(resolution, wanted.iter().map(|wanted| (wanted / mean).max(rule.floor)).collect())
    }
}

fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Averages of an image over boxes that reach so many pixels to each side, as far as the image does.
fn averaged(values: &[f64], columns: usize, radius: usize) -> Vec<f64> {
    let around = |at: usize, side: usize| at.saturating_sub(radius)..side.min(at + radius + 1);
    let line = |places: std::ops::Range<usize>, value: &dyn Fn(usize) -> f64| {
        let count = places.len() as f64;
        places.map(value).sum::<f64>() / count
    };
    let row = |i: usize| line(around(i % columns, columns), &|x| values[i - i % columns + x]);
    let rows: Vec<f64> = (0..values.len()).map(row).collect();
    let column =
        |i: usize| line(around(i / columns, values.len() / columns), &|y| rows[y * columns + i % columns]);
    (0..values.len()).map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixel by pixel, with a floor of 0.1.
    fn rule(aim: Aim) -> ImportanceRule {
        ImportanceRule { aim, floor: 0.1, radius: 0 }
    }

    #[test]
    fn the_next_importance_is_that_of_its_aim() {
        // Four pixels as noisy as their brightness has it: variance of the sum of visits ∝ mean²/visits, visits ∝ mean.
        let even = Importance::even([2, 2]).unwrap();
        let means = [4.0, 1.0, 1.0, 0.0];
        let expected = [
            // √(1, 1, 16, –) = 1, 1, 4, 0, of the mean 1.5.
            (Aim::SquaredError, [1.0 / 1.5, 1.0 / 1.5, 4.0 / 1.5, 0.1]),
            // The same over the means: 1/4, 1, 4, 0, of the mean 5.25/4.
            (Aim::RelativeError, [1.0 / 5.25, 4.0 / 5.25, 16.0 / 5.25, 0.1]),
            // The least mean is 0.15: 1/4, 1, 1, 20/3, of the mean 107/48.
            (Aim::EvenVisits, [12.0 / 107.0, 48.0 / 107.0, 48.0 / 107.0, 320.0 / 107.0]),
        ];
        for (aim, expected) in expected {
            let next = even.learn(&rule(aim), &means, &[4.0, 1.0, 16.0, 0.0]).unwrap();
            for (index, expected) in expected.into_iter().enumerate() {
                let found = next.of([index as u32 % 2, index as u32 / 2]);
                assert!((found - expected).abs() < 1e-15, "{aim:?} {index}: {found}");
            }
        }
        let higher = ImportanceRule { floor: 0.7, ..rule(Aim::SquaredError) };
        let higher = even.learn(&higher, &means, &[4.0, 1.0, 16.0, 0.0]).unwrap();
        assert_eq!((higher.of([1, 0]), higher.of([1, 1])), (0.7, 0.7));
        assert_eq!(even.learn(&rule(Aim::SquaredError), &means, &[0.0; 4]), Ok(even));
    }

    #[test]
    fn smoothing_averages_over_the_box_that_the_image_holds() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        assert_eq!(averaged(&values, 4, 0), values);
        let smooth = averaged(&values, 4, 1);
        // Corners: 0, 1, 4, 5 and 6, 7, 10, 11; within: 3 x 3 around 5.
        assert_eq!((smooth[0], smooth[11], smooth[5]), (2.5, 8.5, 5.0));
        assert!(averaged(&values, 4, 9).iter().all(|value| *value == 5.5));
        // A spike of one pixel is as important as its neighbours.
        let spike = [1.0, 1.0, 9.0, 1.0, 1.0];
        let smoothed = ImportanceRule { radius: 1, ..rule(Aim::SquaredError) };
        let next = Importance::even([5, 1]).unwrap().learn(&smoothed, &[1.0; 5], &spike).unwrap();
        assert_eq!(next.of([1, 0]), next.of([2, 0]));
        assert_eq!(next.of([2, 0]), next.of([3, 0]));
    }

    #[test]
    fn a_map_that_is_no_importance_is_refused() {
        let missing = Importance::new([2, 2], vec![1.0; 3]);
        assert_eq!(missing, Err(ImportanceError::NotAnImage { columns: 2, rows: 2, found: 3 }));
        assert_eq!(Importance::new([1, 1], vec![0.0]), Err(ImportanceError::NotPositive(0.0)));
        assert!(Importance::even([0, 3]).is_err());
        let dark = ImportanceRule { floor: 0.0, ..rule(Aim::SquaredError) };
        let learnt = Importance::even([2, 1]).unwrap().learn(&dark, &[1.0, 0.0], &[1.0, 0.0]);
        assert_eq!(learnt, Err(ImportanceError::NotPositive(0.0)));
        let error = Importance::even([1, 2]).unwrap().learn(&dark, &[1.0], &[1.0, 1.0]).unwrap_err();
        assert!(error.to_string().contains("1 x 2 pixels"));
    }
}
