//! The variance of next-flight estimators from their renewal equation.

use fairflight_media::{Breakpoints, Majorant, OpticalThickness};

/// Error of Runge and Kutta's rule for a variance that is not small against 1.
pub const GRANTED: f64 = 1e-8;

/// Steps on each smooth stretch.
const STEPS: u32 = 2000;

/// An estimator that scores where it is and flies on at the rate μ of the majorant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scoring {
    /// exp(−μ(S − x)) at each point; a collision weighs 1 − σ_t/μ.
    Ratio,
    /// The same; a collision ends the walk with probability σ_t/μ.
    Delta,
    /// e/(1 + e) at each point and once more for leaving from there, with e = exp(−μ(S − x)); a collision weighs 1 − σ_t/μ.
    Unidirectional,
}

/// Var/T² of an estimate, from the equation of a walk's first step.
///
/// Let X_x be the estimate of a walk that starts at x with the weight 1, e = exp(−μ(S − x)), b what it scores there, T = E\[X_x\], and
/// w the weight of a collision. It leaves without another collision with probability e; else it collides at y, and X_x = b + w X_y:
///
/// > E\[X_x²\] = H(x) + G(x),  G(x) = ∫_x^S μ exp(−μ(y − x)) E\[w²\] E\[X_y²\] dy,
///
/// where H collects what does not contain E\[X_y²\]: with ∫ μ exp(−μ(y − x)) w T(y, S) dy = T − b of a next flight,
/// H = 2eT − e², and with e/(1 + e) = b, H = b²(1 + 3e) + 2b(T − e). Differentiated, G′ = μG − μ E\[w²\] (H + G) with G(S) = 0,
/// which is solved here by Runge and Kutta's rule of order 4, backwards, between breakpoints. The closed forms of these estimators
/// come from martingales and integrals instead; they share no step with this.
pub fn relative_variance<F: OpticalThickness + Majorant + Breakpoints>(field: &F, scoring: Scoring) -> f64 {
    let (mu, length) = (field.majorant(), field.length());
    let head = |x: f64| {
        let (e, t) = ((-mu * (length - x)).exp(), (-field.optical_thickness(x, length)).exp());
        let b = e / (1.0 + e);
        match scoring {
            Scoring::Ratio | Scoring::Delta => 2.0 * e * t - e * e,
            Scoring::Unidirectional => b * b * (1.0 + 3.0 * e) + 2.0 * b * (t - e),
        }
    };
    let square = |sigma_t: f64| {
        let w = 1.0 - sigma_t / mu;
        if scoring == Scoring::Delta { w } else { w * w }
    };
    let mut borders = field.breakpoints();
    borders.extend([0.0, length]);
    borders.sort_by(f64::total_cmp);
    borders.dedup();
    let mut g = 0.0;
    for stretch in borders.windows(2).rev() {
        let (from, to) = (stretch[0], stretch[1]);
        let h = (to - from) / f64::from(STEPS);
        // At a border the field may jump: it is looked up inside.
        let inside = |x: f64| x.clamp(from + 1e-9 * h, to - 1e-9 * h);
        let slope = |x: f64, g: f64| {
            let x = inside(x);
            mu * g - mu * square(field.sigma_t(x)) * (head(x) + g)
        };
        for step in 0..STEPS {
            let x = to - f64::from(step) * h;
            let k1 = slope(x, g);
            let k2 = slope(x - 0.5 * h, g - 0.5 * h * k1);
            let k3 = slope(x - 0.5 * h, g - 0.5 * h * k2);
            let k4 = slope(x - h, g - h * k3);
            g -= h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
    }
    (head(0.0) + g) * (2.0 * field.optical_thickness(0.0, length)).exp() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Bounded, Constant};

    #[test]
    fn a_vacuum_has_a_variance_in_closed_form() {
        // 1 − T is all chance: (1 − exp(−2μS))/2 for next flight.
        let vacuum = Bounded::new(Constant::new(0.0, 3.0).unwrap(), 0.7).unwrap();
        for scoring in [Scoring::Ratio, Scoring::Delta] {
            let found = relative_variance(&vacuum, scoring);
            assert!((found + 0.5 * (-4.2_f64).exp_m1()).abs() < 1e-11, "{found}");
        }
        // 1 − ln 2 behind a thick majorant.
        let thick = Bounded::new(Constant::new(0.0, 3.0).unwrap(), 20.0).unwrap();
        let found = relative_variance(&thick, Scoring::Unidirectional);
        assert!((found - 1.0 + std::f64::consts::LN_2).abs() < 1e-8, "{found}");
    }
}
