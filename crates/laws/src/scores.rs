//! Values that one estimate can take: the knowledge that an exact test of its mean needs.
//!
//! A walk's estimate is T_main times a product of weights. Where every weight is at most 1 in magnitude the estimate is
//! bounded by T_main; where the weights are 0 or 1 it has two values, and the number of survivors is binomial. Both
//! follow from the range that r = σ_diff/σ_samp can have on the profile.

use crate::Unit;
use fairflight_collision::CollisionModel;
use fairflight_media::{Constant, Majorant, Minorant, PiecewiseConstant, PiecewiseLinear, Vacuum};
use fairflight_stats::Scores;
use fairflight_transmittance::Explorers;

/// Sums and products of what is never negative: nothing below 0, and no end above.
pub const NEVER_NEGATIVE: Scores = Scores::Bounded { minimum: 0.0, maximum: f64::INFINITY };

/// A closed interval that some quantity does not leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end of the interval.
    pub minimum: f64,
    /// Upper end of the interval.
    pub maximum: f64,
}

impl Interval {
    /// A single number.
    #[must_use]
    pub fn point(value: f64) -> Self {
        Self { minimum: value, maximum: value }
    }

    /// Both bounds of a field, infinite where none is known.
    pub fn bounds_of<F: Majorant + Minorant>(field: &F) -> Self {
        Self { minimum: field.minorant(), maximum: field.majorant() }
    }

    /// The convex hull of some numbers.
    fn hull(values: impl IntoIterator<Item = f64>) -> Self {
        let empty = Self { minimum: f64::INFINITY, maximum: f64::NEG_INFINITY };
        values.into_iter().fold(empty, |hull, value| Self {
            minimum: hull.minimum.min(value),
            maximum: hull.maximum.max(value),
        })
    }

    fn contains(&self, value: f64) -> bool {
        (self.minimum..=self.maximum).contains(&value)
    }
}

/// A control or a sampling extinction whose values are known to lie in an interval.
pub trait Ranged {
    /// The interval.
    fn range(&self) -> Interval;
}

impl Ranged for Vacuum {
    fn range(&self) -> Interval {
        Interval::point(0.0)
    }
}

impl Ranged for Constant {
    fn range(&self) -> Interval {
        Interval::bounds_of(self)
    }
}

impl Ranged for PiecewiseConstant {
    fn range(&self) -> Interval {
        Interval::bounds_of(self)
    }
}

impl Ranged for PiecewiseLinear {
    fn range(&self) -> Interval {
        Interval::bounds_of(self)
    }
}

impl Ranged for Explorers {
    fn range(&self) -> Interval {
        Interval::hull(self.points().map(|(_, value)| value))
    }
}

/// The interval that r = (σ_t − σ_main)/σ_samp (szirmay-kalos-2017 eq. 5, 6) cannot leave when its three parts do not
/// leave theirs; `None` if it is unbounded. Not the smallest such interval: the three may vary together.
#[must_use]
pub fn ratio_range(sigma_t: Interval, control: Interval, sampling: Interval) -> Option<Interval> {
    let (least, greatest) = (sigma_t.minimum - control.maximum, sigma_t.maximum - control.minimum);
    if (least, greatest) == (0.0, 0.0) {
        return Some(Interval::point(0.0));
    }
    let ratios = [least, greatest]
        .into_iter()
        .flat_map(|difference| [difference / sampling.minimum, difference / sampling.maximum]);
    let hull = Interval::hull(ratios);
    let is_bounded = sampling.minimum > 0.0 && hull.minimum.is_finite() && hull.maximum.is_finite();
    is_bounded.then_some(hull)
}

/// Range of the weights of a collision model while r stays in an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// All weights, the 0 of a lost particle left out.
    pub energies: Interval,
    /// True if every surviving particle keeps its weight exactly (or becomes 0).
    pub unchanged: bool,
    /// True if every particle survives: the number of look-ups of a walk is then a Poisson variate.
    pub survives: bool,
}

/// Rounding of |1 − r| + a|r| where it is 1.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The weights of `model` for r in `ratios`.
///
/// The energies of all models of szirmay-kalos-2017 (eq. 7 to 12) are linear in r below 0, between 0 and 1, between 1 and
/// 2/(1 + a), and beyond, and monotone over the last two together: their extremes lie at the ends and at 0 and 1, where
/// they may jump.
pub fn weights<M: CollisionModel>(model: &M, ratios: Interval) -> Weights {
    let middle = 0.5 * (ratios.minimum + ratios.maximum);
    let around_one = [1.0 - 0.5 * f64::EPSILON, 1.0, 1.0 + f64::EPSILON];
    let probes = [ratios.minimum, middle, ratios.maximum, 0.0].into_iter().chain(around_one);
    let branches: Vec<_> = probes.filter(|&r| ratios.contains(r)).map(|r| model.transmitted(r)).collect();
    let energies = branches.iter().filter(|branch| branch.probability > 0.0).map(|branch| branch.energy);
    Weights {
        energies: Interval::hull(energies.clone()),
        unchanged: energies.clone().all(|energy| energy == 0.0 || (energy - 1.0).abs() <= ROUNDING),
        survives: branches.iter().all(|branch| branch.probability == 1.0),
    }
}

/// The scores of [`fairflight_transmittance::Tracking`] with a control of the optical thickness `main_thickness`, in
/// `unit`. `ratios` as from [`ratio_range`].
pub fn tracking<M: CollisionModel>(
    model: &M,
    ratios: Option<Interval>,
    main_thickness: f64,
    unit: Unit,
) -> Scores {
    let Some(ratios) = ratios else { return Scores::Unbounded };
    let main = unit.exp(-main_thickness);
    let Weights { energies, unchanged, .. } = weights(model, ratios);
    if unchanged {
        return Scores::TwoValued { high: main };
    }
    let grows = energies.minimum < -1.0 - ROUNDING || energies.maximum > 1.0 + ROUNDING;
    match (energies.minimum >= 0.0, grows) {
        (true, false) => Scores::Bounded { minimum: 0.0, maximum: main },
        (true, true) => NEVER_NEGATIVE,
        (false, false) => Scores::Bounded { minimum: -main, maximum: main },
        (false, true) => Scores::Unbounded,
    }
}

/// The scores of [`fairflight_transmittance::Woodcock`]: a flight escapes or it does not.
#[must_use]
pub fn woodcock(unit: Unit) -> Scores {
    Scores::TwoValued { high: unit.exp(0.0) }
}

/// The scores of [`fairflight_transmittance::LineIntegral`]: from 1 − p_V, no flight escapes, to 1, all do.
#[must_use]
pub fn line_integral(majorant_thickness: f64, unit: Unit) -> Scores {
    Scores::Bounded { minimum: unit.exp(-majorant_thickness), maximum: unit.exp(0.0) }
}

/// The scores of [`fairflight_transmittance::JitteredRatio`] (a thickness of 0), of its sibling in cells, and of
/// [`fairflight_transmittance::ResidualCells`] with a rate of at least 1: factors in \[0, 1\] times the transmittance of the minorants.
#[must_use]
pub fn in_cells(minorant_thickness: f64, unit: Unit) -> Scores {
    Scores::Bounded { minimum: 0.0, maximum: unit.exp(-minorant_thickness) }
}

/// The scores of [`fairflight_transmittance::RayMarching`]: the exponential of a mean of σ_t times the length.
#[must_use]
pub fn ray_marching(sigma_t: Interval, length: f64, unit: Unit) -> Scores {
    let bounds = [sigma_t.maximum, sigma_t.minimum].map(|sigma_t| unit.exp(-sigma_t * length));
    if bounds.iter().all(|bound| bound.is_finite()) {
        Scores::Bounded { minimum: bounds[0], maximum: bounds[1] }
    } else {
        Scores::Unbounded
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};

    fn between(minimum: f64, maximum: f64) -> Option<Interval> {
        Some(Interval { minimum, maximum })
    }

    fn single(version: Version, albedo: f64) -> SingleParticle {
        SingleParticle { version, albedo: Albedo::new(albedo).unwrap() }
    }

    const TWO_VALUED: Scores = Scores::TwoValued { high: 1.0 };
    const BELOW_ONE: Scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    const OF_BOTH_SIGNS: Scores = Scores::Bounded { minimum: -1.0, maximum: 1.0 };

    #[test]
    fn the_double_particle_is_bounded_up_to_two() {
        let model = DoubleParticle { albedo: Albedo::default() };
        let scores = |minimum, maximum| tracking(&model, between(minimum, maximum), 0.0, Unit::of(0.0));
        assert_eq!(scores(0.0, 0.8), BELOW_ONE);
        assert_eq!(scores(0.0, 1.0), BELOW_ONE);
        assert_eq!(scores(0.5, 2.0), OF_BOTH_SIGNS);
        assert_eq!(scores(0.5, 2.1), Scores::Unbounded);
        assert_eq!(scores(-0.1, 0.5), NEVER_NEGATIVE);
        assert_eq!(scores(-0.1, 1.5), Scores::Unbounded);
        assert_eq!(scores(1.0, 1.0), TWO_VALUED);
        assert_eq!(tracking(&model, None, 0.0, Unit::of(0.0)), Scores::Unbounded);
    }

    #[test]
    fn the_terminating_particle_has_two_values_up_to_one_and_three_beyond() {
        let model = single(Version::Terminating, 0.5);
        assert_eq!(tracking(&model, between(0.0, 1.0), 0.0, Unit::of(0.0)), TWO_VALUED);
        assert_eq!(tracking(&model, between(0.0, 1.3), 0.0, Unit::of(0.0)), OF_BOTH_SIGNS);
        let main = tracking(&model, between(0.0, 0.5), 2.0, Unit::of(3.0));
        assert_eq!(main, Scores::TwoValued { high: 1.0_f64.exp() });
    }

    #[test]
    fn the_other_versions_are_bounded_up_to_two_over_one_plus_albedo() {
        for version in [Version::NonTerminating, Version::Adaptive] {
            let model = single(version, 0.6);
            let scores = |maximum| tracking(&model, between(0.0, maximum), 0.0, Unit::of(0.0));
            assert_eq!(scores(0.9), BELOW_ONE);
            assert_eq!(scores(1.25), OF_BOTH_SIGNS);
            assert_eq!(scores(1.26), Scores::Unbounded);
            assert_eq!(tracking(&single(version, 1.0), between(0.0, 0.9), 0.0, Unit::of(0.0)), TWO_VALUED);
        }
    }

    #[test]
    fn the_ratio_of_intervals() {
        let unit = Interval { minimum: 0.0, maximum: 1.0 };
        assert_eq!(ratio_range(unit, Interval::point(0.25), Interval::point(0.5)), between(-0.5, 1.5));
        assert_eq!(ratio_range(unit, unit, Interval { minimum: 0.5, maximum: 2.0 }), between(-2.0, 2.0));
        assert_eq!(ratio_range(unit, Interval::point(0.0), Interval::point(0.0)), None);
        let nothing = Interval::point(0.0);
        assert_eq!(ratio_range(nothing, nothing, nothing), between(0.0, 0.0));
        let unknown = Interval { minimum: f64::NEG_INFINITY, maximum: 1.0 };
        assert_eq!(ratio_range(unknown, nothing, Interval::point(1.0)), None);
    }
}
