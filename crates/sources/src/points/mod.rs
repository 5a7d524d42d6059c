//! Points of the unit cube that fill it more evenly than independent ones, each by itself as uniform as those.
//!
//! A [`PointSet`] is made for one *replica* from a seed. Its point i is a [`UniformSource`] ([`PointSet::source`]) that gives
//! the coordinates of the point one after the other and independent variates beyond them: one estimate per point, the mean over the
//! points the estimate of the replica.
//!
//! | set | randomised by | points, coordinates | a mean of smooth functions of one variate: variance |
//! |---|---|---|---|
//! | [`Sobol`] (owen-1995, burley-2020) | nested scrambling, then a digital shift | 2^16, 256 | n^-3 |
//! | [`Halton`] (halton-1960, matousek-1998) | a random digit scrambling | 2^32, 64 | n^-2 |
//! | [`Hammersley`] (hammersley-1960) | rotation and jitter of the first, the rest as Halton | N fixed, 65 | n^-3 in the first, n^-2 |
//! | [`LatinHypercube`] (mckay-1979) | a random order in each coordinate, and jitter | N fixed, any | n^-3 |
//!
//! Independent points: n^-1. The rates hold for functions of *one* variate, or sums of such, with a bounded derivative. Of several
//! variates together a Latin hypercube promises no more than independent points do (stein-1987), nets and Halton points
//! something that deteriorates with their number and with every jump: a decision "collides or not" is a jump. Walks with many
//! collisions draw most of their variates beyond what any set orders.
//!
//! **What stays true, and what does not.** Within one estimate the variates are independent and uniform on the lattice, as
//! [`UniformSource`] promises: every point of every set has the uniform law on the cube, over seeds, so that each estimate is
//! unbiased by itself and so is their mean. Between the estimates of one replica they depend on each other, on purpose: the
//! sample variance over the points of a replica says nothing about the error of their mean. It is measured over replicas.

mod digits;
mod halton;
mod hammersley;
mod latin_hypercube;
mod sobol;

pub use halton::Halton;
pub use hammersley::Hammersley;
pub use latin_hypercube::LatinHypercube;
pub use sobol::Sobol;

use crate::{Seeded, UniformSource, derive_seed};

/// Error of a point set that cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointSetError {
    /// A set of no points.
    NoPoints,
    /// More points than the set can tell apart.
    TooManyPoints {
        /// The most.
        most: u64,
        /// The number asked for.
        found: u64,
    },
    /// More coordinates than the set has; independent variates follow them anyway.
    TooManyDimensions {
        /// The most.
        most: usize,
        /// The number asked for.
        found: usize,
    },
}

impl std::fmt::Display for PointSetError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoPoints => write!(f, "a point set needs at least one point"),
            Self::TooManyPoints { most, found } => write!(f, "points must be at most {most}, found {found}"),
            Self::TooManyDimensions { most, found } => {
                write!(
                    f,
                    "dimensions must be at most {most}, found {found}; independent variates follow them"
                )
            }
        }
    }
}

impl std::error::Error for PointSetError {}

impl PointSetError {
    fn check_dimensions(most: usize, found: usize) -> Result<(), Self> {
        if found <= most { Ok(()) } else { Err(Self::TooManyDimensions { most, found }) }
    }

    fn check_points(most: u64, found: u64) -> Result<(), Self> {
        match found {
            0 => Err(Self::NoPoints),
            _ if found > most => Err(Self::TooManyPoints { most, found }),
            _ => Ok(()),
        }
    }
}

/// The points of one replica.
///
/// **Law.** For each index i by itself, over the seeds that replicas are made from, the coordinates of point i are independent and each
/// uniform on the lattice k · 2^-53. Nothing is promised of two points together but what the set is known for.
pub trait PointSet {
    /// Number of coordinates that the set orders; variates beyond are independent.
    fn dimensions(&self) -> usize;

    /// Number of points that the set orders; the sources of points beyond are independent from the first variate on.
    fn points(&self) -> u64;

    /// The seed of the replica.
    fn seed(&self) -> u64;

    /// The coordinate `dimension` of the point `index`, both within bounds. What the set leaves open below its resolution is
    /// taken from `filler`, the stream of this point.
    fn coordinate(&self, index: u64, dimension: usize, filler: &mut Seeded) -> f64;

    /// The stream that is the point's own: what it fills up with.
    fn filler(&self, index: u64) -> Seeded {
        Seeded::new(derive_seed(self.seed(), index))
    }

    /// The point `index` as a source.
    fn source(&self, index: u64) -> PointSource<'_, Self>
    where
        Self: Sized,
    {
        PointSource::new(self, index)
    }
}

/// One point as a source: its coordinates in order, then independent variates.
#[derive(Clone, Debug)]
pub struct PointSource<'a, P: ?Sized> {
    set: &'a P,
    index: u64,
    dimension: usize,
    ordered: usize,
    filler: Seeded,
}

impl<'a, P: PointSet + ?Sized> PointSource<'a, P> {
    /// The point `index` of `set`: [`PointSet::source`], also of a trait object.
    #[must_use]
    pub fn new(set: &'a P, index: u64) -> Self {
        let ordered = if index < set.points() { set.dimensions() } else { 0 };
        Self { set, index, dimension: 0, ordered, filler: set.filler(index) }
    }
}

impl<P: PointSet + ?Sized> UniformSource for PointSource<'_, P> {
    #[inline]
    fn next_uniform(&mut self) -> f64 {
        if self.dimension >= self.ordered {
            return self.filler.next_uniform();
        }
        let u = self.set.coordinate(self.index, self.dimension, &mut self.filler);
        self.dimension += 1;
        u
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every set, of `points` points, made from `seed`.
    pub(super) fn all(points: u64, seed: u64) -> [(&'static str, Box<dyn PointSet>); 4] {
        [
            ("sobol", Box::new(Sobol::new(4, seed).unwrap())),
            ("halton", Box::new(Halton::new(4, seed).unwrap())),
            ("hammersley", Box::new(Hammersley::new(points, 4, seed).unwrap())),
            ("latin hypercube", Box::new(LatinHypercube::new(points, 4, seed).unwrap())),
        ]
    }

    fn variates(set: &dyn PointSet, index: u64, n: usize) -> Vec<f64> {
        let mut source = PointSource::new(set, index);
        (0..n).map(|_| source.next_uniform()).collect()
    }

    #[test]
    fn every_variate_lies_on_the_lattice_and_points_are_reproducible() {
        for (name, set) in all(64, 5) {
            for index in 0..70 {
                let point = variates(&*set, index, 8);
                for &u in &point {
                    assert!(
                        (0.0..1.0).contains(&u) && (u * (1_u64 << 53) as f64).fract() == 0.0,
                        "{name}: {u}"
                    );
                }
                assert_eq!(point, variates(&*set, index, 8), "{name}");
            }
        }
    }

    #[test]
    fn replicas_differ_and_so_do_their_paddings() {
        for ((name, one), (_, other)) in all(64, 1).iter().zip(&all(64, 2)) {
            let (a, b) = (variates(&**one, 3, 6), variates(&**other, 3, 6));
            assert!(a.iter().zip(&b).all(|(a, b)| a != b), "{name}");
        }
    }

    /// One point in each of n strata of each coordinate: n a power of two, or of the base for Halton.
    #[test]
    fn each_coordinate_is_stratified_as_promised() {
        for seed in 0..20 {
            for (name, set) in all(64, seed) {
                for dimension in 0..4 {
                    // The bases of Halton 2, 3, 5, 7; of Hammersley none, 2, 3, 5.
                    let n: u64 = match (name, dimension) {
                        ("halton", 1) | ("hammersley", 2) => 27,
                        ("halton", 2) | ("hammersley", 3) => 25,
                        ("halton", 3) => 49,
                        _ => 64,
                    };
                    let mut met = vec![0; n as usize];
                    for index in 0..n {
                        met[(variates(&*set, index, 4)[dimension] * n as f64) as usize] += 1;
                    }
                    assert!(met.iter().all(|&times| times == 1), "{name} {dimension}: {met:?}");
                }
            }
        }
    }

    /// The law, for two points: means, squares and products of their coordinates over replicas, padding included. 27 numbers for each of
    /// four sets, each within six standard errors: a false alarm of 4e-7.
    #[test]
    fn a_point_is_uniform_over_replicas() {
        const REPLICAS: u64 = 20_000;
        for index in [0, 13] {
            let mut means = [[0.0; 6]; 4];
            let mut products = [[[0.0; 6]; 6]; 4];
            for seed in 0..REPLICAS {
                for ((_, set), (mean, product)) in
                    all(16, seed).iter().zip(means.iter_mut().zip(&mut products))
                {
                    let point = variates(&**set, index, 6);
                    for (i, u) in point.iter().enumerate() {
                        mean[i] += (u - 0.5) / REPLICAS as f64;
                        for (j, v) in point.iter().enumerate() {
                            product[i][j] += (u - 0.5) * (v - 0.5) / REPLICAS as f64;
                        }
                    }
                }
            }
            // Variances 1/12, 1/144 (a product) and 1/180 (a square).
            let error = |variance: f64| 6.0 * (variance / REPLICAS as f64).sqrt();
            for (mean, product) in means.iter().zip(&products) {
                assert!(mean.iter().all(|mean| mean.abs() < error(1.0 / 12.0)), "{mean:?}");
                for (i, row) in product.iter().enumerate() {
                    for (j, found) in row.iter().enumerate() {
                        let (exact, variance) =
                            if i == j { (1.0 / 12.0, 1.0 / 180.0) } else { (0.0, 1.0 / 144.0) };
                        assert!((found - exact).abs() < error(variance), "{i} {j}: {product:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_its_points_a_set_is_independent() {
        // Their two point sets of one replica share no padding either.
        let set = LatinHypercube::new(4, 2, 9).unwrap();
        assert_eq!(variates(&set, 4, 3)[0], set.filler(4).next_uniform());
        assert_ne!(variates(&set, 4, 3), variates(&set, 5, 3));
    }
}

#[cfg(test)]
mod rates;
