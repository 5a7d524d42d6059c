//! Random formulas whose integrals have a closed form.

use std::fmt::Write;

/// A formula in s over `0 ≤ s ≤ length`, and its integral.
pub(crate) struct Sum {
    pub(crate) formula: String,
    pub(crate) length: f64,
    pub(crate) integral: f64,
    /// The sum of the sizes of the integrals of all terms, and of what rounding may do to their closed forms.
    pub(crate) rounding: f64,
}

/// The numbers of one seed (splitmix64).
struct Draws(u64);

impl Draws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 * 2f64.powi(-53)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Draws a number between two, of any order of magnitude.
    fn size(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }
}

impl Sum {
    /// One to six terms: powers, exponentials, sines, Gaussians, tents, steps, combs of narrow steps and kinks, of widths from 1e-9 to 1.
    pub(crate) fn random(seed: u64) -> Self {
        let mut draws = Draws(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
        let length = draws.size(0.5, 20.0);
        let mut sum = Self { formula: String::new(), length, integral: 0.0, rounding: 0.0 };
        for term in 0..1 + draws.below(6) {
            let sign = if draws.uniform() < 0.25 { -1.0 } else { 1.0 };
            let (formula, integral, condition) = random_term(&mut draws, length, sign);
            write!(sum.formula, "{}{formula}", if term == 0 { "" } else { " + " })
                .expect("a string takes it");
            sum.integral += integral;
            sum.rounding += 16.0 * f64::EPSILON * (integral.abs() + condition);
        }
        sum
    }
}

/// A term, its integral, and the size of the numbers whose differences the closed form takes.
fn random_term(draws: &mut Draws, length: f64, sign: f64) -> (String, f64, f64) {
    let width = draws.size(1e-9, 1.0);
    // An integral of 1e-3 to 1 for a feature of this width.
    let height = sign * draws.size(1e-3, 1.0) / width;
    let place = |draws: &mut Draws, margin: f64| margin + (length - 2.0 * margin) * draws.uniform();
    let modest = sign * draws.size(0.01, 3.0);
    match draws.below(8) {
        0 => {
            let power = [1.0, 2.0, 3.0, 5.0, 0.5, 1.5, 2.7][draws.below(7)];
            let factor = modest / length.powf(power);
            let integral = factor * length.powf(power + 1.0) / (power + 1.0);
            (format!("{factor:?}*s^{power:?}"), integral, modest.abs() * length)
        }
        1 => {
            let rate = draws.size(0.1, 1e6);
            let integral = modest * -(-rate * length).exp_m1() / rate;
            (format!("{modest:?}*exp(-{rate:?}*s)"), integral, modest.abs() / rate)
        }
        2 => {
            let (rate, phase) = (draws.size(0.1, 2e3), draws.between(0.0, 6.0));
            let integral = modest * (phase.cos() - (rate * length + phase).cos()) / rate;
            (
                format!("{modest:?}*sin({rate:?}*s + {phase:?})"),
                integral,
                modest.abs() * (length + 2.0 / rate),
            )
        }
        3 => {
            let centre = draws.between(0.0, length);
            let erf = |x: f64| libm::erf(x / width);
            // Far inside the whole of it counts: the place does not matter.
            let shares = 0.5 * (erf(length - centre) + erf(centre));
            let integral = height * width * std::f64::consts::PI.sqrt() * shares;
            let at_ends = (-(centre.min(length - centre) / width).powi(2)).exp() * height.abs() * length;
            (format!("{height:?}*exp(-((s - {centre:?})/{width:?})^2)"), integral, at_ends)
        }
        4 => {
            let half = width.min(0.4 * length);
            let centre = place(draws, half);
            (
                format!("{height:?}*max(0, 1 - abs(s - {centre:?})/{half:?})"),
                height * half,
                // The ends of the tent are where 1 − |s − c|/w rounds.
                0.0,
            )
        }
        5 => {
            // floor(r s) = k for k/r ≤ s < (k + 1)/r
            let rate = draws.size(0.3, 300.0) / length;
            let whole = (rate * length).floor();
            let integral = modest * (0.5 * whole * (whole - 1.0) / rate + whole * (length - whole / rate));
            (format!("{modest:?}*floor({rate:?}*s)"), integral, modest.abs() * whole * length)
        }
        6 => {
            // A step of the part `share` of each period, at its start.
            let rate = draws.size(1.0, 100.0) / length;
            let share = draws.size(1e-7, 0.5);
            let periods = rate * length;
            let whole = periods.floor();
            let strength = modest / share;
            let integral = strength * (whole * share + (periods - whole).min(share)) / rate;
            // The place of each step is rounded, and its part of a period as a difference of places.
            (
                format!("{strength:?}*(floor({rate:?}*s) - floor({rate:?}*s - {share:?}))"),
                integral,
                strength.abs() * whole * length,
            )
        }
        _ => {
            let centre = draws.between(0.0, length);
            let integral = 0.5 * modest * (centre * centre + (length - centre).powi(2)) / length;
            (format!("{:?}*abs(s - {centre:?})", modest / length), integral, modest.abs() * length)
        }
    }
}
