//! A look at one ray, for the benefit of later ones.

use crate::teeth_for;
use fairflight_elementary::{exp_m1, ln_1p};
use fairflight_media::Majorant;
use fairflight_sources::UniformSource;

/// The optical thicknesses of a stratum that jittered ratio tracking may have.
pub(super) const EPSILONS: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// Combs of 2^0, 2^1 and 2^2 times the teeth of the rule are considered.
pub(super) const FINENESSES: usize = 3;

/// Times the rule's teeth that the finest comb has.
const FINEST: usize = 1 << (FINENESSES - 1);

/// Combs of the finest kind that a pilot draws.
const COMBS: usize = 4;

/// Variances on a ray by a few combs and a few pairs of look-ups.
///
/// Nothing of it is used for an estimate from the same variates: a choice that depends on what it chooses for is a bias.
///
/// **How.** The finest comb, of 4 M teeth, contains four combs of M teeth and two of 2 M: one set of look-ups shows the variances of all
/// three, and that of σ_t inside cells of their spacings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pilot {
    /// The length of the ray \[length\].
    pub length: f64,
    /// Variance of the optical thickness by one comb over the whole ray, of M, 2 M and 4 M teeth \[1\].
    pub whole: [f64; FINENESSES],
    /// The same with the ends matched \[1\].
    pub matched: [f64; FINENESSES],
    /// The same with an offset of its own for each tooth \[1\].
    pub apart: [f64; FINENESSES],
    /// Relative variance by jittered ratio tracking, one per optical thickness of a stratum (1, 1/2, 1/4, 1/8) \[1\].
    pub jittered: [f64; EPSILONS.len()],
}

impl Pilot {
    /// The look-ups that a pilot makes on a ray of this optical thickness in its majorant.
    #[must_use]
    pub fn lookups(depth: f64) -> u64 {
        u64::from(teeth_for(depth)) * (COMBS * FINEST + 2 * EPSILONS.len()) as u64 + 2
    }

    /// Looks at a ray whose majorant is positive. Nothing is allocated.
    pub fn of<F: Majorant>(field: &F, source: &mut impl UniformSource) -> Self {
        let length = field.length();
        let teeth = teeth_for(field.majorant() * length);
        let spacing = length / f64::from(teeth);
        let offsets: [f64; COMBS] = std::array::from_fn(|_| source.next_uniform());
        // sums[a][c]: the comb of M teeth whose offset is (a + u_c)/4 of its spacing.
        let mut sums = [[0.0; COMBS]; FINEST];
        let mut apart = [0.0; FINENESSES];
        for tooth in 0..teeth {
            let values: [[f64; COMBS]; FINEST] = std::array::from_fn(|a| {
                offsets.map(|u| field.sigma_t((f64::from(tooth) + (a as f64 + u) / FINEST as f64) * spacing))
            });
            for (sum, value) in sums.as_flattened_mut().iter_mut().zip(values.as_flattened()) {
                *sum += value * spacing;
            }
            // Cells of 1, 1/2 and 1/4 of the spacing hold 16, 8 and 4 of these values.
            for (fineness, apart) in apart.iter_mut().enumerate() {
                let cells = 1 << fineness;
                let width = spacing / f64::from(cells);
                for cell in values.chunks(FINEST >> fineness) {
                    *apart += width * width * variance(cell.as_flattened().iter().copied());
                }
            }
        }
        let jump = field.sigma_t(length) - field.sigma_t(0.0);
        // A comb of n M teeth is the mean of n combs of M teeth.
        let combs = |fineness: usize, jump: f64| {
            let n = 1 << fineness;
            let of = move |a: usize, c: usize, sums: &[[f64; COMBS]; FINEST]| {
                let stride = FINEST / n;
                let sum: f64 = (0..n).map(|k| sums[a + k * stride][c]).sum();
                let offset = (a as f64 + offsets[c]) * n as f64 / FINEST as f64;
                sum / n as f64 - spacing / n as f64 * (offset - 0.5) * jump
            };
            let sums = &sums;
            variance((0..FINEST / n).flat_map(move |a| (0..COMBS).map(move |c| of(a, c, sums))))
        };
        Self {
            length,
            whole: std::array::from_fn(|fineness| combs(fineness, 0.0)),
            matched: std::array::from_fn(|fineness| combs(fineness, jump)),
            apart,
            jittered: EPSILONS.map(|epsilon| jittered(field, epsilon, teeth, source)),
        }
    }
}

/// Var/T² by jittered ratio tracking, from pairs of look-ups in some of its strata.
///
/// With Y = h σ_t(x), F = 1 − Y_1 + \[N ≥ 2\] Y_1 Y_2/ε − …, P(N ≥ 2) = ε/2: to second order in Y the variance of a factor is
/// Var Y + E\[Y_1² Y_2²\]/(2ε), and two look-ups estimate both, (Y_1 − Y_2)²/2 and (Y_1 Y_2)²/(2ε).
fn jittered<F: Majorant>(field: &F, epsilon: f64, pairs: u32, source: &mut impl UniformSource) -> f64 {
    let strata = (field.majorant() * field.length() / epsilon).ceil().max(1.0);
    let width = field.length() / strata;
    let thickness = field.majorant() * width;
    let sum: f64 = (0..pairs)
        .map(|_| {
            // Strata far apart, one after another.
            let stratum = (source.next_uniform() * strata).floor().min(strata - 1.0);
            let [first, second] =
                std::array::from_fn(|_| width * field.sigma_t((stratum + source.next_uniform()) * width));
            let square = first * second;
            0.5 * (first - second) * (first - second) + square * square / (2.0 * thickness)
        })
        .sum();
    exp_m1(strata * ln_1p(sum / f64::from(pairs)))
}

/// The sample variance of a few values.
fn variance(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Constant, Counted, PiecewiseConstant, PiecewiseLinear};
    use fairflight_sources::Seeded;

    #[test]
    fn it_costs_what_it_says_and_sees_no_variance_where_there_is_none() {
        let field = Counted::new(Constant::new(0.7, 5.0).unwrap());
        let pilot = Pilot::of(&field, &mut Seeded::new(1));
        assert_eq!(field.lookups(), Pilot::lookups(3.5));
        for variance in pilot.whole.into_iter().chain(pilot.matched).chain(pilot.apart) {
            assert!(variance < 1e-28, "{variance}");
        }
        assert!(pilot.jittered.windows(2).all(|pair| pair[1] < pair[0]));
    }

    /// On a ramp a comb of spacing h has the variance (slope · length · h)²/12, none when its ends are matched, and
    /// cells · (slope h²)²/12 with an offset for each tooth.
    #[test]
    fn on_a_ramp_all_variances_are_known() {
        let ramp = PiecewiseLinear::new(vec![0.0, 20.0], vec![0.0, 1.0]).unwrap();
        let mut source = Seeded::new(2);
        const PILOTS: u32 = 4000;
        let (mut whole, mut apart, mut matched) = ([0.0; FINENESSES], [0.0; FINENESSES], 0.0_f64);
        for _ in 0..PILOTS {
            let pilot = Pilot::of(&ramp, &mut source);
            for i in 0..FINENESSES {
                whole[i] += pilot.whole[i] / f64::from(PILOTS);
                apart[i] += pilot.apart[i] / f64::from(PILOTS);
                matched = matched.max(pilot.matched[i]);
            }
        }
        let teeth = f64::from(teeth_for(20.0));
        assert!(matched < 1e-24);
        for i in 0..FINENESSES {
            let h = 20.0 / teeth / f64::from(1 << i);
            let expected = [(h * 1.0).powi(2) / 12.0, 20.0 / h * (h * h / 20.0).powi(2) / 12.0];
            // Combs of one pilot are stratified: their sample variance lies above that of independent ones by up to a fifteenth.
            for (found, expected) in [whole[i], apart[i]].into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 0.1, "{i}: {found} for {expected}");
            }
        }
    }

    /// White noise has the variance of a cell whatever its width, so that `apart` halves with it.
    #[test]
    fn in_noise_finer_combs_gain_what_they_cost() {
        let mut source = Seeded::new(3);
        let edges = (0..=4000).map(|i| f64::from(i) * 0.005).collect();
        let noise =
            PiecewiseConstant::new(edges, (0..4000).map(|_| source.next_uniform()).collect()).unwrap();
        let pilot = Pilot::of(&noise, &mut source);
        for i in 1..FINENESSES {
            let ratio = pilot.apart[i - 1] / pilot.apart[i];
            assert!((ratio / 2.0 - 1.0).abs() < 0.2, "{ratio}");
        }
    }
}
