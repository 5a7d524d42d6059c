//! Fractal Perlin noise as a medium.

mod enclosure;

use crate::gradient_noise::GradientNoise;
use crate::lattice_planes::PlaneCrossings;
use crate::{FieldError, Line, Medium, MediumBreakpoints};
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_elementary::pow;
use glam::DVec3;

/// The shape of a [`Perlin`] medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerlinParameters {
    /// The number of octaves, 1 to [`Perlin::MOST_OCTAVES`].
    pub octaves: u32,
    /// Lattice cells of the first octave per unit of length \[1/length\], positive.
    pub frequency: f64,
    /// The ratio of the frequencies of an octave and the one before, positive.
    pub lacunarity: f64,
    /// The ratio of the weights of an octave and the one before, positive.
    pub gain: f64,
    /// The extinction per unit of noise \[1/length\], of any sign.
    pub scale: f64,
    /// The extinction where the noise is zero \[1/length\], of any sign.
    pub offset: f64,
    /// The seed of the noise.
    pub seed: u32,
}

impl Default for PerlinParameters {
    fn default() -> Self {
        Self { octaves: 12, frequency: 0.35, lacunarity: 2.0, gain: 0.55, scale: 1.0, offset: 0.0, seed: 1 }
    }
}

/// σ_t(p) = max(0, offset + scale · fBm(frequency · p)), with fBm(q) = Σ_i w_i noise(lacunarityⁱ q), w_i ∝ gainⁱ, Σ w_i = 1.
///
/// The noise is the gradient noise of Perlin 2002 with the values of the library `noise`, in \[−1, 1\] by a clamp; so is fBm. All octaves share one permutation table, which then stays in the cache: octave i is octave 0 seen from nearer. The
/// price is that the noise is zero at the origin, where all lattices meet, and at the lattice points of the first octave
/// when the lacunarity is an integer. It repeats after 256 cells of an octave.
///
/// Its own coordinates are `frequency · p`, those of the first octave's lattice. Within a cell of every lattice it is a
/// polynomial of the distance along a line, unless it is clipped at zero or at the ends of the noise's range.
#[derive(Clone, Debug)]
pub struct Perlin {
    noise: GradientNoise,
    parameters: PerlinParameters,
    /// The frequency of each octave relative to the first, and its weight.
    octaves: Vec<(f64, f64)>,
    /// The size of a local coordinate up to which the noise takes the lattice coordinates of every octave as they are.
    reach: f64,
}

/// The period of the noise in lattice cells: its table has 256 entries.
const PERIOD: f64 = 256.0;

/// 2³⁰: the noise takes lattice coordinates that fit a 32-bit integer, with room for the next corner.
const LARGEST_COORDINATE: f64 = 1_073_741_824.0;

impl Perlin {
    /// The greatest number of octaves. Many more than are visible: a weight below 2⁻⁵³ of the first changes nothing.
    pub const MOST_OCTAVES: u32 = 32;

    /// Crossings of lattice planes that are told of one line at most: with 21 look-ups of some 400 ns between two of them, a second.
    pub const MOST_PLANES: f64 = 131_072.0;

    /// The medium of these parameters.
    ///
    /// # Errors
    /// If a number is not finite; `octaves < 1` or above the greatest number; the frequency, the lacunarity or the gain is
    /// not positive; or a frequency or weight of the last octave is out of the range of numbers.
    pub fn new(parameters: PerlinParameters) -> Result<Self, FieldError> {
        let PerlinParameters { octaves, frequency, lacunarity, gain, scale, offset, seed } = parameters;
        FieldError::check_at_least("octaves", 1.0, f64::from(octaves))?;
        // Said as an inequality on what is left, since a field error knows least values only.
        FieldError::check_at_least("32 - octaves", 0.0, f64::from(Self::MOST_OCTAVES) - f64::from(octaves))?;
        FieldError::check_at_least("frequency", f64::MIN_POSITIVE, frequency)?;
        FieldError::check_at_least("lacunarity", f64::MIN_POSITIVE, lacunarity)?;
        FieldError::check_at_least("gain", f64::MIN_POSITIVE, gain)?;
        FieldError::check_finite("scale", scale)?;
        FieldError::check_finite("offset", offset)?;
        FieldError::check_finite("abs(offset) + abs(scale)", offset.abs() + scale.abs())?;

        let powers = |base: f64| (0..octaves).map(move |i| pow(base, f64::from(i)));
        let total: f64 = powers(gain).sum();
        let highest = powers(lacunarity).fold(1.0, f64::max);
        FieldError::check_finite("the sum of the weights of all octaves", total)?;
        FieldError::check_finite("the frequency of the last octave", frequency * highest)?;
        Ok(Self {
            noise: GradientNoise::new(seed),
            parameters,
            octaves: powers(lacunarity).zip(powers(gain).map(|weight| weight / total)).collect(),
            reach: LARGEST_COORDINATE / highest,
        })
    }

    /// The parameters that the medium was made from.
    #[must_use]
    pub fn parameters(&self) -> &PerlinParameters {
        &self.parameters
    }

    /// fBm at a point in local coordinates, in \[−1, 1\].
    #[inline]
    fn fbm(&self, point: DVec3) -> f64 {
        // The comparison also fails for NaN.
        if point.abs().cmplt(DVec3::splat(self.reach)).all() {
            self.sum_of_octaves(point, |lattice| lattice)
        } else {
            self.far_fbm(point)
        }
    }

    /// Far out each lattice coordinate is first brought into one period, which is exact.
    #[cold]
    fn far_fbm(&self, point: DVec3) -> f64 {
        let highest = LARGEST_COORDINATE / self.reach;
        if !(point * highest).is_finite() {
            return f64::NAN;
        }
        self.sum_of_octaves(point, |lattice| {
            DVec3::from_array(lattice.to_array().map(|c| c.rem_euclid(PERIOD)))
        })
    }

    #[inline]
    fn sum_of_octaves(&self, point: DVec3, wrap: impl Fn(DVec3) -> DVec3) -> f64 {
        let octave = |&(frequency, weight): &(f64, f64)| weight * self.noise.at(wrap(frequency * point));
        // The weights sum to 1 up to rounding; the bounds of the medium hold without it.
        self.octaves.iter().map(octave).sum::<f64>().clamp(-1.0, 1.0)
    }
}

impl Perlin {
    /// σ_t of fBm.
    #[inline(always)]
    fn of_fbm(&self, fbm: f64) -> f64 {
        let sigma_t = self.parameters.offset + self.parameters.scale * fbm;
        // Not `max`, which would hide a NaN.
        if sigma_t < 0.0 { 0.0 } else { sigma_t }
    }
}

impl Medium for Perlin {
    fn local(&self, line: Line) -> Line {
        let frequency = self.parameters.frequency;
        Line { origin: frequency * line.origin, direction: frequency * line.direction }
    }

    /// NaN where a lattice coordinate is not finite.
    #[inline]
    fn sigma_t_local(&self, point: DVec3) -> f64 {
        self.of_fbm(self.fbm(point))
    }
    #[inline(always)]
    fn sigma_t_local_lanes(&self, points: &[Lanes; 3]) -> Lanes {
        let near = points.iter().flatten().fold(true, |near, c| near & (c.abs() < self.reach));
        if !near {
            let [x, y, z] = points;
            return std::array::from_fn(|lane| self.sigma_t_local(DVec3::new(x[lane], y[lane], z[lane])));
        }
        // The neutral number of sums, for the sign of their zeros.
        let mut sum = [std::iter::empty::<f64>().sum::<f64>(); LANES];
        for &(frequency, weight) in &self.octaves {
            let mut lattice = *points;
            lattice.iter_mut().flatten().for_each(|coordinate| *coordinate *= frequency);
            for (sum, noise) in sum.iter_mut().zip(self.noise.at_lanes(&lattice)) {
                *sum += weight * noise;
            }
        }
        for sum in &mut sum {
            *sum = self.of_fbm(sum.clamp(-1.0, 1.0));
        }
        sum
    }
    fn upper_bound(&self) -> Option<f64> {
        Some((self.parameters.offset + self.parameters.scale.abs()).max(0.0))
    }
    fn lower_bound(&self) -> Option<f64> {
        Some((self.parameters.offset - self.parameters.scale.abs()).max(0.0))
    }
}

/// The crossings of the lattice planes of every octave: length times the sum of all frequencies for each axis, that is
/// tens of thousands for the default shape and a length of 20. Octaves with which there would be more than [`Perlin::MOST_PLANES`] are left
/// out: they are fine, and of little weight. Where the noise is clipped is not among them; the [`crate::Certificate`] of a ray finds it.
impl MediumBreakpoints for Perlin {
    fn line_breakpoints(&self, local: &Line, length: f64) -> Vec<f64> {
        let mut all = Vec::new();
        for &(frequency, _) in &self.octaves {
            let (origin, direction) = (frequency * local.origin, frequency * local.direction);
            let planes: f64 = (0..3).map(|i| PlaneCrossings::count(origin[i], direction[i], length)).sum();
            if all.len() as f64 + planes > Self::MOST_PLANES {
                continue;
            }
            for axis in 0..3 {
                all.extend(PlaneCrossings::new(origin[axis], direction[axis], 0.0, length));
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    fn medium(change: impl Fn(&mut PerlinParameters)) -> Perlin {
        let mut parameters = PerlinParameters::default();
        change(&mut parameters);
        Perlin::new(parameters).unwrap()
    }

    /// Numbers in [−1/2, 1/2).
    fn random() -> impl FnMut() -> f64 {
        let mut uniform = crate::test_support::random(3);
        move || uniform() - 0.5
    }

    #[test]
    fn the_formula_octave_by_octave() {
        let medium = medium(|p| (p.octaves, p.scale, p.offset, p.seed) = (3, -2.0, 1.5, 9));
        let noise = GradientNoise::new(9);
        let p = dvec3(1.3, -2.7, 0.4);
        let octave = |i: i32| 0.55f64.powi(i) * noise.at(0.35 * 2f64.powi(i) * p);
        let fbm = (octave(0) + octave(1) + octave(2)) / (1.0 + 0.55 + 0.3025);
        assert!((medium.sigma_t(p) - (1.5 - 2.0 * fbm)).abs() < 1e-15);
    }

    #[test]
    fn the_noise_stays_within_its_bounds_and_varies() {
        let mut next = random();
        for octaves in [1, 4, 12] {
            let medium = medium(|p| p.octaves = octaves);
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            for _ in 0..200_000 {
                let value = medium.fbm(1e3 * dvec3(next(), next(), next()));
                (least, greatest) = (least.min(value), greatest.max(value));
            }
            assert!((-1.0..-0.4).contains(&least) && greatest > 0.4 && greatest <= 1.0, "{least} {greatest}");
        }
    }

    #[test]
    fn bounds_of_the_extinction_and_the_clip_at_zero() {
        let bounds = |scale, offset| {
            let medium = medium(|p| (p.scale, p.offset) = (scale, offset));
            (medium.lower_bound().unwrap(), medium.upper_bound().unwrap())
        };
        assert_eq!(bounds(1.0, 0.0), (0.0, 1.0));
        assert_eq!(bounds(-0.5, 2.0), (1.5, 2.5));
        assert_eq!(bounds(1.0, -3.0), (0.0, 0.0));
        let mut next = random();
        let medium = medium(|_| ());
        let empty = (0..1000).filter(|_| medium.sigma_t(9.0 * dvec3(next(), next(), next())) == 0.0).count();
        assert!((300..700).contains(&empty), "{empty}");
    }

    #[test]
    fn the_noise_is_continuous_at_lattice_planes_of_either_sign() {
        let medium = medium(|_| ());
        let mut next = random();
        for plane in [-300.0, -2.0, -1.0, 0.0, 1.0, 2.0, 300.0] {
            for axis in 0..3 {
                let mut sides = [1e-12, 0.0, -0.0, -1e-12].map(|nudge| plane + nudge);
                let mut point = 5.0 * dvec3(next(), next(), next());
                for side in &mut sides {
                    point[axis] = *side;
                    *side = medium.fbm(point);
                }
                assert!(sides.iter().all(|side| (side - sides[0]).abs() < 1e-9), "{plane} {axis} {sides:?}");
            }
        }
    }

    #[test]
    fn huge_coordinates_are_the_noise_of_their_period() {
        let medium = medium(|p| p.octaves = 2);
        let near = dvec3(0.25, 3.5, 7.75);
        let far = near + DVec3::splat(2f64.powi(33));
        assert_eq!(medium.fbm(far), medium.fbm(near));
        assert_eq!(medium.fbm(-far), medium.fbm(DVec3::splat(256.0) - near));
        assert!(medium.fbm(DVec3::splat(1e300)).abs() <= 1.0);
        assert!(medium.sigma_t_local(DVec3::splat(f64::MAX)).is_nan());
        assert!(medium.sigma_t_local(dvec3(0.0, f64::NAN, 0.0)).is_nan());
    }

    #[test]
    fn between_two_breakpoints_lies_a_polynomial() {
        // Three factors of degree 1 or 5 and a slope of degree 1 make degree 16 at most: the difference of order 17 over
        // equal steps vanishes.
        let medium = medium(|p| (p.octaves, p.offset, p.frequency) = (2, 1.0, 1.0));
        let line = medium.local(Line { origin: dvec3(-2.3, 1.1, 0.6), direction: dvec3(0.36, 0.48, -0.8) });
        let mut edges = medium.line_breakpoints(&line, 4.0);
        edges.sort_by(f64::total_cmp);
        assert!(edges.len() > 15 && edges.iter().all(|s| (0.0..4.0).contains(s)));
        for cell in edges.windows(2) {
            let at = |i: u32| cell[0] + (cell[1] - cell[0]) * f64::from(i) / 17.0;
            let mut values: Vec<f64> = (0..18).map(|i| medium.sigma_t_local(line.at(at(i)))).collect();
            while values.len() > 1 {
                values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            }
            assert!(values[0].abs() < 1e-10, "{cell:?} {values:?}");
        }
    }

    #[test]
    fn the_default_shape_has_tens_of_thousands_of_breakpoints() {
        let medium = medium(|_| ());
        let line = medium.local(Line { origin: DVec3::ZERO, direction: DVec3::Z });
        let count = medium.line_breakpoints(&line, 20.0).len();
        // 7 cells of the first octave, doubled eleven times; its last plane is the end itself.
        assert!((7 * 4095 - 12..=7 * 4095).contains(&count), "{count}");
    }

    #[test]
    fn bad_parameters_are_refused() {
        let refused = |change: fn(&mut PerlinParameters)| {
            let mut parameters = PerlinParameters::default();
            change(&mut parameters);
            Perlin::new(parameters).unwrap_err()
        };
        assert!(matches!(refused(|p| p.octaves = 0), FieldError::TooSmall { what: "octaves", .. }));
        assert!(matches!(refused(|p| p.octaves = 33), FieldError::TooSmall { what: "32 - octaves", .. }));
        assert!(matches!(refused(|p| p.frequency = 0.0), FieldError::TooSmall { what: "frequency", .. }));
        assert!(matches!(refused(|p| p.lacunarity = -2.0), FieldError::TooSmall { what: "lacunarity", .. }));
        assert!(matches!(refused(|p| p.gain = 0.0), FieldError::TooSmall { what: "gain", .. }));
        assert!(matches!(refused(|p| p.scale = f64::NAN), FieldError::NotFinite { .. }));
        assert!(matches!(refused(|p| p.lacunarity = 1e30), FieldError::NotFinite { .. }));
        assert!(matches!(refused(|p| p.gain = 1e30), FieldError::NotFinite { .. }));
    }
}
