//! Variates and means for the unit tests of this crate.

/// A linear congruential generator; its upper bits.
pub(crate) struct Variates(u64);

impl Variates {
    pub(crate) fn new(seed: u64) -> Self {
        let mut variates = Self(seed);
        variates.draw();
        variates
    }

    /// Uniform in \[0, 1).
    pub(crate) fn draw(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 * 2f64.powi(-53)
    }

    /// Uniform in [-1, 1)³.
    pub(crate) fn vector(&mut self) -> glam::DVec3 {
        glam::dvec3(self.draw(), self.draw(), self.draw()) * 2.0 - 1.0
    }
}

/// The mean of `count` independent numbers, and its standard error.
pub(crate) fn mean_and_error(count: u32, mut number: impl FnMut() -> f64) -> (f64, f64) {
    let all: Vec<f64> = (0..count).map(|_| number()).collect();
    let n = f64::from(count);
    let mean = all.iter().sum::<f64>() / n;
    let squares: f64 = all.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (n * (n - 1.0))).sqrt())
}
