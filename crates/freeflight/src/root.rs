//! The root of an increasing function, by Newton's method inside a bracket.

/// The point in `(low, high)` at which an increasing `function` (value, derivative) crosses zero from ≤ 0 to > 0.
///
/// `function` is taken to be at most 0 at `low` and above 0 at `high`; neither end is evaluated. `guess` is where the
/// search begins; outside the bracket, the middle is taken.
///
/// **When it stops.** After each evaluation the bracket shrinks to the side of the sign change. The search ends when
/// Newton's correction f/f′ is lost in the addition to the point, t − f/f′ = t, that is |f| ≤ f′ ulp(t)/2: no other
/// number is nearer to the root of the tangent; or when no number is left between the two ends. Both are statements
/// about the numbers there are, not a tolerance.
///
/// **That it stops.** A Newton step is taken only if it stays strictly inside the bracket and is at most half as long as
/// the step before; else the bracket is halved. Steps that halve are lost in the point after finitely many, and halvings
/// of a bracket leave no number inside after finitely many, whatever the values: so also where the derivative is 0 (a
/// stretch without extinction, where the step is infinite or 0/0) and where rounding makes the function waver.
///
/// For a function that is 0 on a whole stretch the far end of the stretch is found: a flight does not end in empty space.
pub(crate) fn crossing(
    mut low: f64,
    mut high: f64,
    guess: f64,
    mut function: impl FnMut(f64) -> (f64, f64),
) -> f64 {
    let end = high;
    let inside = |t: f64, low: f64, high: f64| low < t && t < high;
    let mut t = guess;
    let mut last_step = high - low;
    loop {
        if !inside(t, low, high) {
            t = low + 0.5 * (high - low);
            if !inside(t, low, high) {
                // No number is left in between. The end itself was given, not found.
                return if high < end { high } else { low };
            }
        }
        let (value, derivative) = function(t);
        if value > 0.0 {
            high = t;
        } else {
            low = t;
        }
        // NaN for 0/0: it fails every comparison below.
        let newton = t - value / derivative;
        if newton == t {
            return t;
        }
        let is_short = 2.0 * (newton - t).abs() <= last_step;
        let next = if is_short && inside(newton, low, high) { newton } else { low + 0.5 * (high - low) };
        last_step = (next - t).abs();
        t = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The crossing, and how often the function was evaluated.
    fn counted(low: f64, high: f64, guess: f64, function: impl Fn(f64) -> (f64, f64)) -> (f64, u32) {
        let mut count = 0;
        let root = crossing(low, high, guess, |t| {
            count += 1;
            function(t)
        });
        (root, count)
    }

    #[test]
    fn a_smooth_root_takes_a_few_steps() {
        let (root, count) = counted(0.0, 4.0, 1.0, |t| (t * t - 2.0, 2.0 * t));
        assert!((root - std::f64::consts::SQRT_2).abs() <= f64::EPSILON, "{root}");
        assert!(count < 10, "{count}");
    }

    #[test]
    fn a_flat_stretch_is_left_at_its_far_end() {
        // 0 up to 1, −1 + … : rises from −1 to 0 on [0, 1], stays 0 until 3, rises again.
        let f = |t: f64| {
            if t < 1.0 {
                (t - 1.0, 1.0)
            } else if t < 3.0 {
                (0.0, 0.0)
            } else {
                (t - 3.0, 1.0)
            }
        };
        let (root, count) = counted(0.0, 4.0, 2.0, f);
        assert!((root - 3.0).abs() <= 4.0 * f64::EPSILON, "{root}");
        assert!(count < 120, "{count}");
    }

    #[test]
    fn a_triple_root_and_a_jump_are_found_by_halving() {
        let (root, _) = counted(-1.0, 2.0, 1.9, |t| (t * t * t, 3.0 * t * t));
        assert!(root.abs() < 1e-100, "{root}");
        let (root, _) = counted(0.0, 1.0, 0.9, |t| (if t < 0.3 { -1.0 } else { 1.0 }, 0.0));
        assert_eq!(root, 0.3);
    }

    #[test]
    fn it_ends_whatever_the_values() {
        for (value, derivative) in [
            (f64::NAN, 1.0),
            (f64::NAN, f64::NAN),
            (-1.0, 0.0),
            (1.0, 0.0),
            (-1.0, -1.0),
            (1.0, f64::INFINITY),
        ] {
            let (root, count) = counted(0.0, 1e300, 1.0, |_| (value, derivative));
            assert!((0.0..1e300).contains(&root) && count < 3000, "{value} {derivative}: {root} {count}");
        }
    }

    #[test]
    fn an_empty_bracket_gives_its_low_end() {
        assert_eq!(counted(1.0, 1.0, 1.0, |_| (0.0, 1.0)), (1.0, 0));
    }
}
