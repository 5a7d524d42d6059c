//! Enclosures of a formula: its range and its integral on a stretch of a line, its range in a box.

use super::program::{Algebra, Binary, Program, Unary};
use crate::Stretch;
use crate::interval::{Interval, ORDER, Series};

/// Evaluation over Taylor series: about the middle of a stretch, or for all of it at once.
struct Smooth<'a> {
    variables: &'a [Series],
    /// True if an operation met an argument outside its domain, or may have.
    partial: bool,
    /// True if places at which the function is not smooth are sought; `kink` is the one found nearest to the middle.
    seeks: bool,
    kink: Option<f64>,
    cost: u64,
}

impl Smooth<'_> {
    fn over<'a>(variables: &'a [Series], seeks: bool) -> Smooth<'a> {
        Smooth { variables, partial: false, seeks, kink: None, cost: 0 }
    }

    /// An operation is not smooth where its argument has this value.
    fn kink_at(&mut self, argument: &Series, level: f64) {
        if self.seeks
            && argument.length() > 1
            && let Some(t) = argument.crossing(level)
            && self.kink.is_none_or(|nearest| t.abs() < nearest.abs())
        {
            self.kink = Some(t);
        }
    }

    fn charge(&mut self, operands: usize) {
        self.cost += 8 + operands as u64;
    }

    /// The smaller of two, by whether their difference is decided.
    fn least(&mut self, a: &Series, b: &Series) -> Series {
        self.kink_at(&a.subtract(b), 0.0);
        if a.value().high() <= b.value().low() {
            *a
        } else if b.value().high() <= a.value().low() {
            *b
        } else {
            Series::rough(a.value().min(b.value()))
        }
    }
}

impl Algebra for Smooth<'_> {
    type Value = Series;

    fn number(&mut self, value: f64) -> Series {
        Series::constant(Interval::point(value))
    }

    fn variable(&mut self, index: usize) -> Series {
        self.variables[index]
    }

    fn unary(&mut self, function: Unary, x: Series) -> Series {
        let whole = if x.length() > 1 { (ORDER + 1) * x.length() } else { 1 };
        self.charge(match function {
            Unary::Negate | Unary::Abs | Unary::Floor | Unary::Ceil => x.length(),
            Unary::Sin | Unary::Cos | Unary::Tan => 2 * whole,
            Unary::Exp | Unary::Ln | Unary::Sqrt => whole,
        });
        let value = x.value();
        match function {
            Unary::Negate => x.negate(),
            Unary::Sin => x.sin_cos().0,
            Unary::Cos => x.sin_cos().1,
            Unary::Tan => x.tan(),
            Unary::Exp => x.exp(),
            Unary::Ln => {
                self.kink_at(&x, 0.0);
                // At 0 itself it is infinite.
                self.partial |= value.low() < 0.0;
                x.ln()
            }
            Unary::Sqrt => {
                self.kink_at(&x, 0.0);
                self.partial |= value.low() < 0.0;
                x.power(0.5)
            }
            Unary::Abs => {
                self.kink_at(&x, 0.0);
                if value.low() >= 0.0 {
                    x
                } else if value.high() <= 0.0 {
                    x.negate()
                } else {
                    Series::rough(value.abs())
                }
            }
            Unary::Floor | Unary::Ceil => {
                // The steps at the integers around the value in the middle.
                let middle = x.coefficient(0).0.floor();
                for level in [middle, middle + 1.0] {
                    self.kink_at(&x, level);
                }
                let steps = if function == Unary::Floor { value.floor() } else { value.ceil() };
                if steps.low() == steps.high() { Series::constant(steps) } else { Series::rough(steps) }
            }
        }
    }

    fn binary(&mut self, operation: Binary, a: Series, b: Series) -> Series {
        self.charge(match operation {
            Binary::Multiply => a.length() * b.length(),
            Binary::Divide if b.length() > 1 => (ORDER + 1) * b.length(),
            Binary::Power => 3 * (ORDER + 1) * (ORDER + 1),
            _ => a.length() + b.length(),
        });
        match operation {
            Binary::Add => a.add(&b),
            Binary::Subtract => a.subtract(&b),
            Binary::Multiply => a.multiply(&b),
            Binary::Divide => {
                self.kink_at(&b, 0.0);
                a.divide(&b)
            }
            Binary::Min => self.least(&a, &b),
            Binary::Max => self.least(&a.negate(), &b.negate()).negate(),
            // a^b = exp(b ln a) for a > 0; a negative number has powers for whole b only, which a variable is hardly ever.
            Binary::Power => {
                self.kink_at(&a, 0.0);
                let base = a.value();
                self.partial |= base.low() <= 0.0;
                b.multiply(&a.ln()).exp()
            }
        }
    }

    fn power(&mut self, base: Series, exponent: f64) -> Series {
        self.charge((ORDER + 1) * base.length());
        let whole = exponent.fract() == 0.0;
        if !whole || exponent < 0.0 {
            self.kink_at(&base, 0.0);
        }
        self.partial |= !whole && base.value().low() < 0.0;
        base.power(exponent)
    }
}

/// Encloses a formula between two distances on a line: each variable is `origin + s · direction`.
///
/// With c the middle, h half the width and t = (s − c)/h,
///
/// > ∫ f ds = h Σ_{k < q, even} 2 f_k(c)/(k + 1) + h f_q(ξ) 2/(q + 1),
///
/// f_k the Taylor coefficients in t, ξ somewhere on the stretch: the first are enclosed at c, the last over the stretch, q being the even
/// order with the least sum of radii. Where f is not smooth on the stretch, its range times the width. c and h are doubles, of which c ± h may
/// miss the ends by a rounding η h: the polynomial's integral over the difference is taken off, η h f at the end, to η² h times its slope.
/// The range is that of the interval arithmetic, which holds for look-ups in doubles as well.
pub(super) fn stretch(program: &Program, line: &[(f64, f64)], from: f64, to: f64) -> Stretch {
    let middle = from + 0.5 * (to - from);
    let half = (to - middle).max(middle - from);
    let along = |s: Series| -> Vec<Series> {
        let coordinate = |&(origin, direction): &(f64, f64)| match (origin, direction) {
            (0.0, 1.0) => s,
            _ => Series::constant(Interval::point(origin))
                .add(&s.multiply(&Series::constant(Interval::point(direction)))),
        };
        line.iter().map(coordinate).collect()
    };
    let panel_variables = along(Series::variable(Interval::new(from, to), half));
    let mut over_panel = Smooth::over(&panel_variables, false);
    let panel = program.eval_in(&mut over_panel);
    let range = panel.value();
    let point_variables = along(Series::variable(Interval::point(middle), half));
    let mut at_point = Smooth::over(&point_variables, !panel.is_smooth());
    let point = program.eval_in(&mut at_point);
    let cost = over_panel.cost + at_point.cost;
    let kink = at_point.kink.map(|t| middle + half * t).filter(|s| from < *s && *s < to);
    let may_be_undefined = over_panel.partial || range.is_undefined();
    let rough = Stretch {
        may_be_undefined,
        kink,
        cost,
        ..Stretch::from_range(from, to, (range.low(), range.high()))
    };
    if !(panel.is_smooth() && point.is_smooth() && half > 0.0) {
        return rough;
    }

    // Orders below q at the middle, q over the stretch: radii of the sums over the even orders below q as q grows.
    let mut known = 0.0;
    let mut best = (2, f64::INFINITY, f64::INFINITY);
    for q in (0..=ORDER).step_by(2) {
        let weight = 2.0 / (q + 1) as f64;
        let truncation = weight * panel.coefficient(q).1;
        if q > 0 && truncation + known < best.1 + best.2 {
            best = (q, known, truncation);
        }
        known += weight * point.coefficient(q).1;
    }
    let (q, known, truncation) = best;
    // The polynomial: its integral, its values at both ends, bounds of its size and of its slope.
    let (mut integral, mut at_from, mut at_to, mut size, mut slope) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for k in 0..=q {
        let (mid, radius) = if k < q { point.coefficient(k) } else { panel.coefficient(k) };
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        integral += mid * (1.0 + sign) / (k + 1) as f64;
        at_to += mid;
        at_from += sign * mid;
        size += mid.abs() + radius;
        slope += k as f64 * mid.abs();
    }
    let (left, right) = (half - (middle - from), half - (to - middle));
    let missed = (left + right) / half;
    let off = known + missed * missed * slope + 48.0 * f64::EPSILON * size;
    let rounding = half * off * (1.0 + 1e-14) + f64::MIN_POSITIVE;
    let smooth = Stretch {
        low: range.low(),
        high: range.high(),
        integral: half * integral - (left * at_from + right * at_to),
        truncation: half * truncation * (1.0 + 1e-14),
        rounding,
        may_be_undefined,
        kink: None,
        cost,
    };
    if smooth.truncation + smooth.rounding < rough.truncation + rough.rounding {
        smooth
    } else {
        Stretch { kink: None, ..rough }
    }
}

/// Evaluation over boxes.
struct Ranges<'a> {
    variables: &'a [Interval],
    partial: bool,
}

impl Algebra for Ranges<'_> {
    type Value = Interval;

    fn number(&mut self, value: f64) -> Interval {
        Interval::point(value)
    }

    fn variable(&mut self, index: usize) -> Interval {
        self.variables[index]
    }

    fn unary(&mut self, function: Unary, x: Interval) -> Interval {
        self.partial |= matches!(function, Unary::Ln | Unary::Sqrt) && x.low() < 0.0;
        match function {
            Unary::Negate => -x,
            Unary::Sin => x.sin(),
            Unary::Cos => x.cos(),
            Unary::Tan => x.tan(),
            Unary::Exp => x.exp(),
            Unary::Ln => x.ln(),
            Unary::Sqrt => x.sqrt(),
            Unary::Abs => x.abs(),
            Unary::Floor => x.floor(),
            Unary::Ceil => x.ceil(),
        }
    }

    fn binary(&mut self, operation: Binary, a: Interval, b: Interval) -> Interval {
        match operation {
            Binary::Add => a + b,
            Binary::Subtract => a - b,
            Binary::Multiply => a * b,
            Binary::Divide => a / b,
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Power => {
                self.partial |= a.low() <= 0.0;
                (b * a.ln()).exp()
            }
        }
    }

    fn power(&mut self, base: Interval, exponent: f64) -> Interval {
        self.partial |= exponent.fract() != 0.0 && base.low() < 0.0;
        base.power(exponent)
    }
}

/// The range of a formula in a box; infinite where none is proved, or where it may have no value.
pub(super) fn range_in(program: &Program, variables: &[Interval]) -> (f64, f64) {
    let mut algebra = Ranges { variables, partial: false };
    let range = program.eval_in(&mut algebra);
    if algebra.partial || range.is_undefined() {
        (f64::NEG_INFINITY, f64::INFINITY)
    } else {
        (range.low(), range.high())
    }
}
