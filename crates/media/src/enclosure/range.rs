//! The range of a field on a stretch, by cutting it where its bounds are decided.

use super::Enclosed;
use super::certificate::Open;

/// See [`Enclosed::range_between`].
pub(super) fn between(field: &(impl Enclosed + ?Sized), from: f64, to: f64) -> (f64, f64) {
    /// Stretches that one range may take: a few more than smooth functions need.
    const MOST: usize = 48;
    let mut pieces = vec![Open::new(field, from, to)];
    let mut attained = (f64::INFINITY, f64::NEG_INFINITY);
    let hull = |pieces: &[Open]| {
        pieces.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), open| {
            (low.min(open.stretch.low), high.max(open.stretch.high))
        })
    };
    while pieces.len() < MOST {
        // What is found at points lies within the range: the hull can become no narrower.
        for open in &pieces[pieces.len().saturating_sub(2)..] {
            let value = field.sigma_t(0.5 * (open.from + open.to));
            attained = (attained.0.min(value), attained.1.max(value));
        }
        let (low, high) = hull(&pieces);
        let (below, above) = (attained.0 - low, high - attained.1);
        /// Share of the range that is attained: an estimator in cells would hardly notice as much.
        const CLOSE: f64 = 0.02;
        if below.max(above) <= CLOSE * (attained.1 - attained.0) || low >= high {
            break;
        }
        // The piece that holds the bound which is farther from what is attained.
        let farther = if below >= above || below.is_nan() {
            pieces.iter().enumerate().min_by(|a, b| a.1.stretch.low.total_cmp(&b.1.stretch.low))
        } else {
            pieces.iter().enumerate().max_by(|a, b| a.1.stretch.high.total_cmp(&b.1.stretch.high))
        };
        let Some((index, open)) = farther else { break };
        let (from, to) = (open.from, open.to);
        let middle = from + 0.5 * (to - from);
        if !(from < middle && middle < to) {
            break;
        }
        pieces.swap_remove(index);
        pieces.push(Open::new(field, from, middle));
        pieces.push(Open::new(field, middle, to));
    }
    let undefined = pieces.iter().any(|open| open.stretch.may_be_undefined);
    if undefined { (f64::NEG_INFINITY, f64::INFINITY) } else { hull(&pieces) }
}
