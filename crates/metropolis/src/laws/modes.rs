//! Two modes on [0, 1): a target of which the image is known, on which chains are tried.

use crate::Splats;
use fairflight_elementary::exp;
use fairflight_sources::UniformSource;

/// Two modes of unequal mass, far apart: centre, width, height. Steps of at most 0.04 never cross.
const MODES: [[f64; 3]; 2] = [[0.25, 0.06, 3.0], [0.75, 0.08, 1.0]];

/// The height of the two modes together.
#[must_use]
pub fn height(u: f64) -> f64 {
    MODES.iter().map(|[centre, width, height]| height * exp(-0.5 * ((u - centre) / width).powi(2))).sum()
}

/// The pixel of a variate, of two: that of the left half, or of the right one.
#[must_use]
pub fn pixel(u: f64) -> [u32; 2] {
    [u32::from(u >= 0.5), 0]
}

/// The image: what either half holds. Midpoint rule, of which the error is far below rounding for functions that vanish at both ends.
#[must_use]
pub fn image() -> [f64; 2] {
    const NODES: u32 = 100_000;
    let mut halves = [0.0; 2];
    for node in 0..NODES {
        let u = (f64::from(node) + 0.5) / f64::from(NODES);
        halves[usize::from(u >= 0.5)] += height(u) / f64::from(NODES);
    }
    halves
}

/// The modes as an [`Integrand`](crate::Integrand).
pub fn integrand(splats: &mut Splats<f64>, source: &mut dyn UniformSource) {
    let u = source.next_uniform();
    splats.push(pixel(u), height(u));
}
