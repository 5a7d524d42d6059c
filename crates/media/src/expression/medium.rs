//! A formula of the position, as a medium.

use super::program::Program;
use super::{ExpressionFieldError, enclosure, parser};
use crate::interval::Interval;
use crate::{
    BoxBounds, Certificate, Enclosed, Extinction, FieldError, Line, LineEnclosed, Medium, MediumBreakpoints,
    Stretch, Tolerance,
};
use glam::DVec3;

/// σ_t(p) as a formula in the variables `x`, `y` and `z`, the position in world space.
///
/// Its range in boxes and its integral along lines are found by interval arithmetic ([`BoxBounds`], [`LineEnclosed`]). A majorant that
/// somebody declares is a fact about the field, to be checked at each look-up ([`crate::Watched`]).
#[derive(Clone, Debug)]
pub struct ExpressionMedium {
    program: Program,
    majorant: Option<f64>,
}

impl ExpressionMedium {
    /// The medium of a formula, with a declared `majorant` \[1/length\].
    ///
    /// # Errors
    /// If the formula is none or has a variable other than `x`, `y` and `z`, or `majorant` is not finite.
    pub fn new(sigma_t: &str, majorant: Option<f64>) -> Result<Self, ExpressionFieldError> {
        let program = parser::parse(sigma_t, &["x", "y", "z"])?;
        majorant.map_or(Ok(()), |majorant| FieldError::check_finite("majorant", majorant))?;
        Ok(Self { program, majorant })
    }

    /// The majorant that was declared \[1/length\].
    #[must_use]
    pub fn declared_majorant(&self) -> Option<f64> {
        self.majorant
    }
}

impl Medium for ExpressionMedium {
    /// NaN or infinite where the formula has no value.
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        self.program.eval(&point.to_array())
    }
    /// The declared majorant.
    fn upper_bound(&self) -> Option<f64> {
        self.majorant
    }
    fn lower_bound(&self) -> Option<f64> {
        None
    }
}

impl LineEnclosed for ExpressionMedium {
    fn enclose_line(&self, local: &Line, from: f64, to: f64) -> Stretch {
        let (origin, direction) = (local.origin, local.direction);
        let line = [0, 1, 2].map(|axis| (origin[axis], direction[axis]));
        enclosure::stretch(&self.program, &line, from, to)
    }
    fn known_line_borders(&self, _local: &Line, _length: f64) -> Vec<f64> {
        Vec::new()
    }
}

/// The borders of the [`Certificate`] along the line, made anew at each call: [`crate::Certified`] remembers those of a ray.
impl MediumBreakpoints for ExpressionMedium {
    fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64> {
        struct Along<'a> {
            medium: &'a ExpressionMedium,
            local: &'a Line,
            length: f64,
        }
        impl Extinction for Along<'_> {
            fn sigma_t(&self, s: f64) -> f64 {
                self.medium.sigma_t_local(self.local.at(s))
            }
            fn length(&self) -> f64 {
                self.length
            }
        }
        impl Enclosed for Along<'_> {
            fn enclose(&self, from: f64, to: f64) -> Stretch {
                self.medium.enclose_line(self.local, from, to)
            }
        }
        Certificate::of(&Along { medium: self, local, length }, Tolerance::TIGHT).borders
    }
}

/// Bounds by interval arithmetic in the box cut into smaller ones, until the bounds are near what is attained at their centres; infinite
/// where none is proved, or where the formula may have no value.
impl BoxBounds for ExpressionMedium {
    fn bounds_in(&self, min: DVec3, max: DVec3) -> (f64, f64) {
        /// Boxes that one range may take: 4 × 4 × 4.
        const MOST: usize = 64;
        /// Share of the range that is attained: an estimator in cells would hardly notice as much.
        const CLOSE: f64 = 0.02;
        let range = |min: DVec3, max: DVec3| {
            let sides = [0, 1, 2].map(|axis| Interval::new(min[axis], max[axis]));
            (min, max, enclosure::range_in(&self.program, &sides))
        };
        let mut pieces = vec![range(min, max)];
        let mut attained = (f64::INFINITY, f64::NEG_INFINITY);
        loop {
            for &(min, max, _) in &pieces[pieces.len().saturating_sub(2)..] {
                let value = self.sigma_t_local(0.5 * (min + max));
                attained = (attained.0.min(value), attained.1.max(value));
            }
            let lowest =
                (0..pieces.len()).min_by(|&a, &b| pieces[a].2.0.total_cmp(&pieces[b].2.0)).unwrap_or(0);
            let highest =
                (0..pieces.len()).max_by(|&a, &b| pieces[a].2.1.total_cmp(&pieces[b].2.1)).unwrap_or(0);
            let hull = (pieces[lowest].2.0, pieces[highest].2.1);
            let (below, above) = (attained.0 - hull.0, hull.1 - attained.1);
            if pieces.len() >= MOST
                || below.max(above) <= CLOSE * (attained.1 - attained.0)
                || hull.0 == hull.1
            {
                return hull;
            }
            let (min, max, _) = pieces.swap_remove(if below >= above { lowest } else { highest });
            // Across the axis along which cutting narrows the range most.
            let halves = |axis: usize| {
                let middle = 0.5 * (min[axis] + max[axis]);
                let (mut end, mut start) = (max, min);
                end[axis] = middle;
                start[axis] = middle;
                [range(min, end), range(start, max)]
            };
            let width = |pieces: &[(DVec3, DVec3, (f64, f64)); 2]| {
                pieces.iter().map(|piece| piece.2.1 - piece.2.0).sum::<f64>()
            };
            let cuts = [halves(0), halves(1), halves(2)];
            let best = (0..3).min_by(|&a, &b| width(&cuts[a]).total_cmp(&width(&cuts[b]))).unwrap_or(0);
            pieces.extend(cuts[best]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_formula_of_the_position() {
        let medium = ExpressionMedium::new("z - x*y", Some(7.0)).unwrap();
        assert_eq!(medium.sigma_t(dvec3(2.0, 3.0, 11.0)), 5.0);
        assert_eq!((medium.upper_bound(), medium.lower_bound()), (Some(7.0), None));
        // A variable that does not occur changes nothing for the others.
        assert_eq!(ExpressionMedium::new("z", None).unwrap().sigma_t(dvec3(2.0, 3.0, 11.0)), 11.0);
    }

    /// Bounds hold at every look-up, and are hardly wider than what is met.
    #[test]
    fn bounds_in_boxes_hold_and_are_useful() {
        let formulas = [
            ("0.3 + 0.25*sin(7*x)*exp(-0.2*y) + 0.1*cos(3*z)", 1.25),
            ("exp(-((x-1)^2 + (y-1)^2 + (z-1)^2))", 1.1),
            ("max(0, 1 - sqrt(x^2 + y^2 + z^2))", 1.1),
            ("abs(sin(x*y)) + floor(2*z)", 1.3),
            ("1/(1 + x^2 + y^2)", 1.1),
        ];
        for (formula, widest) in formulas {
            let medium = ExpressionMedium::new(formula, None).unwrap();
            let (mut proved, mut met) = (0.0, 0.0);
            for i in 0..64 {
                let corner = |i: i32| dvec3(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)) * 0.5;
                let (min, max) = (corner(i), corner(i) + 0.5);
                let (low, high) = medium.bounds_in(min, max);
                let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
                for j in 0..=8 * 9 * 9 + 9 * 8 + 8 {
                    let at = dvec3(f64::from(j % 9), f64::from(j / 9 % 9), f64::from(j / 81)) / 8.0;
                    let value = medium.sigma_t_local(min + at * (max - min));
                    assert!(low <= value && value <= high, "{formula} {value} {low} {high}");
                    (least, greatest) = (least.min(value), greatest.max(value));
                }
                proved += high - low;
                met += greatest - least;
            }
            assert!(proved <= widest * met + 1e-9, "{formula}: {}", proved / met);
        }
        let constant = ExpressionMedium::new("0.7", None).unwrap();
        assert_eq!(constant.bounds_in(DVec3::ZERO, DVec3::ONE), (0.7, 0.7));
        let pole = ExpressionMedium::new("1/x", None).unwrap();
        assert_eq!(pole.bounds_in(-DVec3::ONE, DVec3::ONE), (f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn what_is_refused_is_told() {
        let message = ExpressionMedium::new("x + s", None).unwrap_err().to_string();
        assert!(message.starts_with("unknown name 's': the variables are x, y, z;"), "{message}");
        assert!(matches!(ExpressionMedium::new("x", Some(f64::NAN)), Err(ExpressionFieldError::Field(_))));
    }
}
