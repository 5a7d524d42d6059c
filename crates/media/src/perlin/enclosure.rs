//! Enclosures of fractal noise along a line.
//!
//! Between two lattice planes of an octave its noise is a polynomial of degree 16 in the distance, for which Lobatto's rule of ten nodes (exact to
//! degree 17) has no truncation. Two things cut it: the noise of an octave is clamped to \[−1, 1\], the extinction at zero. On which side a
//! stretch lies follows from the values at the nodes: between two of them, Δ apart, a function leaves its chord by Δ²/8 times its
//! greatest second derivative at most, and that of a gradient noise is bounded ([`GradientNoise::MOST_CURVED`]), also across planes, where the
//! slope is continuous. A stretch that lies on no side for certain is known by its range, and cut again.

use super::{LARGEST_COORDINATE, Perlin};
use crate::gradient_noise::GradientNoise;
use crate::lattice_planes::PlaneCrossings;
use crate::{Line, LineEnclosed, Medium, MediumBreakpoints, Stretch};

/// Positive nodes of Lobatto's rule on \[−1, 1\] in decreasing order, and their weights.
#[expect(clippy::excessive_precision, reason = "more digits than a double has, to be rounded once")]
const HALF_RULE: [(f64, f64); 5] = [
    (1.0, 0.022_222_222_222_222_222_222),
    (0.919_533_908_166_458_813_829, 0.133_305_990_851_070_111_126),
    (0.738_773_865_105_505_075_003, 0.224_889_342_063_126_452_119),
    (0.477_924_949_810_444_495_661, 0.292_042_683_679_683_757_876),
    (0.165_278_957_666_387_024_626, 0.327_539_761_183_897_456_657),
];

const NODES: usize = 10;

/// Nodes in increasing order, with weights.
fn rule() -> [(f64, f64); NODES] {
    std::array::from_fn(|i| if i < 5 { (-HALF_RULE[i].0, HALF_RULE[i].1) } else { HALF_RULE[NODES - 1 - i] })
}

/// The greatest distance of two neighbouring nodes: those about zero.
const WIDEST_GAP: f64 = 2.0 * HALF_RULE[4].0;

/// The least and the greatest of the values at the nodes.
fn range_of(values: &[f64; NODES]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

/// About where the values at the nodes, by linear interpolation, first pass through `level`; as a part of the stretch.
fn passage(values: &[f64; NODES], level: f64) -> Option<f64> {
    let nodes = rule();
    (1..NODES).find_map(|i| {
        let (a, b) = (values[i - 1] - level, values[i] - level);
        (a * b < 0.0).then(|| {
            let t = nodes[i - 1].0 + (nodes[i].0 - nodes[i - 1].0) * a / (a - b);
            0.5 * (t + 1.0)
        })
    })
}

impl LineEnclosed for Perlin {
    fn enclose_line(&self, local: &Line, from: f64, to: f64) -> Stretch {
        let (scale, offset) = (self.parameters.scale, self.parameters.offset);
        let width = to - from;
        let lengths: [f64; 3] =
            [0, 1, 2].map(|i| local.origin[i].abs() + to.abs() * local.direction[i].abs());
        let farthest = lengths.iter().copied().fold(0.0, f64::max);
        let highest = LARGEST_COORDINATE / self.reach;
        if !farthest.is_finite() || farthest * highest >= LARGEST_COORDINATE {
            // Far out, where the planes are no numbers any more, only the bounds of the whole are known.
            let whole = (self.lower_bound().unwrap_or(0.0), self.upper_bound().unwrap_or(f64::INFINITY));
            return Stretch::from_range(from, to, whole);
        }
        let nodes = rule().map(|(x, _)| local.at(from + 0.5 * width * (x + 1.0)));
        let gap = 0.5 * width * WIDEST_GAP;
        // Octaves of which the side is decided, node by node, and how far they leave their chords; the rest by its range.
        let (mut decided, mut beside) = ([offset; NODES], 0.0);
        let (mut open_low, mut open_high, mut is_open) = (0.0, 0.0, false);
        let mut rounding = 4.0 * f64::EPSILON * offset.abs();
        let mut kink = None;
        for &(frequency, weight) in &self.octaves {
            let weight = scale * weight;
            let noise = nodes.map(|point| self.noise.before_the_clamp(frequency * point));
            let direction = frequency * local.direction.length();
            let curved = GradientNoise::MOST_CURVED * (direction * gap).powi(2) / 8.0;
            // Some 50 operations on numbers of size 2; each coordinate is rounded four times.
            let off = 64.0 * f64::EPSILON
                + GradientNoise::STEEPEST * 4.0 * f64::EPSILON * frequency * lengths.iter().sum::<f64>();
            rounding += weight.abs() * off;
            let (least, greatest) = range_of(&noise);
            let (low, high) = (least - curved - off, greatest + curved + off);
            let has_planes = (0..3).any(|axis| {
                let (o, d) = (frequency * local.origin[axis], frequency * local.direction[axis]);
                PlaneCrossings::new(o, d, from, to).next().is_some()
            });
            if low >= 1.0 || high <= -1.0 {
                decided.iter_mut().for_each(|value| *value += weight * least.clamp(-1.0, 1.0));
            } else if low >= -1.0 && high <= 1.0 && !has_planes {
                decided.iter_mut().zip(noise).for_each(|(value, noise)| *value += weight * noise);
                beside += weight.abs() * curved;
            } else {
                is_open = true;
                let ends = [low, high].map(|end| weight * end.clamp(-1.0, 1.0));
                open_low += ends[0].min(ends[1]);
                open_high += ends[0].max(ends[1]);
                kink = kink.or_else(|| passage(&noise, 1.0)).or_else(|| passage(&noise, -1.0));
            }
        }
        let (least, greatest) = range_of(&decided);
        let (low, high) = (least - beside + open_low - rounding, greatest + beside + open_high + rounding);
        let range = (low.max(0.0), high.max(0.0));
        let cost = (4 * NODES * self.octaves.len()) as u64;
        if is_open || (low < 0.0 && high > 0.0) {
            let kink = kink.or_else(|| if is_open { None } else { passage(&decided, 0.0) });
            let kink = kink.map(|part| from + part * width).filter(|s| from < *s && *s < to);
            return Stretch { kink, cost, ..Stretch::from_range(from, to, range) };
        }
        let sum: f64 = rule().iter().zip(decided).map(|((_, weight), value)| weight * value).sum();
        // Ten products and sums, and the width.
        let size = decided.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        Stretch {
            low: range.0,
            high: range.1,
            integral: if high <= 0.0 { 0.0 } else { 0.5 * width * sum },
            truncation: 0.0,
            rounding: width * (rounding + 16.0 * f64::EPSILON * size),
            may_be_undefined: false,
            kink: None,
            cost,
        }
    }

    fn known_line_borders(&self, local: &Line, length: f64) -> Vec<f64> {
        self.line_breakpoints(local, length)
    }
}

#[cfg(test)]
mod tests {
    use super::super::PerlinParameters;
    use super::*;
    use crate::{Bounds, Certificate, Extinction, Ray, Tolerance};
    use glam::{DVec3, dvec3};

    #[test]
    fn the_rule_is_exact_to_degree_17() {
        for degree in 0..=17 {
            let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
            let sum: f64 = rule().iter().map(|(x, weight)| weight * x.powi(degree)).sum();
            assert!((sum - exact).abs() < 1e-15, "{degree}");
        }
        assert!(rule().windows(2).all(|pair| pair[1].0 - pair[0].0 <= WIDEST_GAP));
    }

    fn ray(change: impl Fn(&mut PerlinParameters), length: f64) -> Ray<Perlin> {
        let mut parameters = PerlinParameters::default();
        change(&mut parameters);
        let bounds = Bounds::aligned_box(DVec3::splat(-50.0), DVec3::splat(50.0)).unwrap();
        let clip = bounds.clip(dvec3(0.3, -0.2, 1.1), dvec3(0.6, 0.48, 0.64), Some(length)).unwrap().unwrap();
        Ray::new(Perlin::new(parameters).unwrap(), &clip)
    }

    /// Against the midpoint rule with a million nodes, whose error is some 1e-9 here.
    #[test]
    fn clipped_noise_is_certified() {
        type Shape = (fn(&mut PerlinParameters), f64);
        let shapes: [Shape; 4] = [
            (|p| p.octaves = 1, 20.0),
            (|p| (p.octaves, p.offset) = (3, 0.1), 20.0),
            (|p| (p.octaves, p.scale, p.offset) = (4, -2.0, 0.3), 10.0),
            (|p| (p.octaves, p.offset) = (6, 2.0), 10.0),
        ];
        for (change, length) in shapes {
            let ray = ray(change, length);
            let found = Certificate::of(&ray, Tolerance::TIGHT);
            let count = 1_000_000;
            let step = length / f64::from(count);
            let sum: f64 = (0..count).map(|i| ray.sigma_t((f64::from(i) + 0.5) * step)).sum();
            assert_eq!(found.doubt(), None);
            assert!(found.error < 1e-11, "{found:?}");
            assert!((found.thickness - sum * step).abs() < 1e-8, "{} {}", found.thickness, sum * step);
            for i in 0..1000 {
                let value = ray.sigma_t(f64::from(i) / 1000.0 * length);
                assert!(found.range.0 <= value && value <= found.range.1);
            }
        }
    }

    #[test]
    fn every_stretch_holds_what_is_met_on_it() {
        let ray = ray(|p| p.octaves = 5, 10.0);
        for i in 0..200 {
            let from = 0.05 * f64::from(i);
            let to = from + 0.3 * f64::from(i % 7 + 1) / 7.0;
            let stretch = ray.medium().enclose_line(ray.local_line(), from, to);
            let count = 400;
            let mut sum = 0.0;
            for j in 0..count {
                let value = ray.sigma_t(from + (to - from) * (f64::from(j) + 0.5) / f64::from(count));
                assert!(stretch.low <= value && value <= stretch.high);
                sum += value * (to - from) / f64::from(count);
            }
            assert!((stretch.integral - sum).abs() <= stretch.truncation + stretch.rounding + 1e-4);
        }
    }

    #[test]
    fn far_out_only_the_bounds_are_known() {
        let ray = ray(|p| p.octaves = 2, 1.0);
        let far = Line { origin: DVec3::splat(1e15), direction: DVec3::X };
        let stretch = ray.medium().enclose_line(&far, 0.0, 1.0);
        assert_eq!((stretch.low, stretch.high, stretch.truncation > 0.4), (0.0, 1.0, true));
    }
}
