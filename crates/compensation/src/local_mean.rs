//! The mean extinction around a point, from a downsampled field (engelhardt-2013 section 4.2).

use fairflight_media::{Bounds, Medium};
use glam::{DVec3, IVec3, dvec3};

/// σ̄_t in cells of a box around the medium \[1/length\].
///
/// It places vertices, and stands for the transmittance where that is approximated. Any positive values place them without bias; those of
/// empty cells are lifted to a floor for that purpose, since the density must be positive wherever there is matter.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalMean {
    min: DVec3,
    cells_per_length: DVec3,
    cells: IVec3,
    means: Vec<f64>,
    floor: f64,
    lookups: u64,
}

/// A cell's share of the greatest mean below which its placement rate does not fall.
const FLOOR: f64 = 1e-2;

impl LocalMean {
    /// The means of `cells` along each axis, each from `probes`³ look-ups of the medium; outside its bounds is nothing.
    pub fn of<M: Medium>(medium: &M, bounds: &Bounds, cells: [u32; 3], probes: u32) -> Self {
        let (min, max) = bounds.corners();
        let counts = cells.map(|count| count.max(1));
        let size = (max - min) / dvec3(f64::from(counts[0]), f64::from(counts[1]), f64::from(counts[2]));
        let probes = probes.max(1);
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(probes);
        let mut means = Vec::with_capacity(counts.iter().product::<u32>() as usize);
        let mut lookups = 0;
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    let corner = dvec3(f64::from(x), f64::from(y), f64::from(z));
                    let mut sum = 0.0;
                    for probe in 0..probes.pow(3) {
                        let within = dvec3(
                            place(probe % probes),
                            place(probe / probes % probes),
                            place(probe / (probes * probes)),
                        );
                        let point = min + (corner + within) * size;
                        if bounds.contains(point) {
                            sum += medium.sigma_t(point);
                            lookups += 1;
                        }
                    }
                    means.push((sum / f64::from(probes.pow(3))).max(0.0));
                }
            }
        }
        let floor = FLOOR * means.iter().copied().fold(0.0, f64::max);
        // A flat box has one cell across; whatever the factor, it is the first.
        let cells_per_length = size.recip().map(|x| if x.is_finite() { x } else { 0.0 });
        Self {
            min,
            cells_per_length,
            cells: IVec3::from_array(counts.map(|c| c as i32)),
            means,
            floor,
            lookups,
        }
    }

    /// Look-ups that were made.
    #[must_use]
    pub fn lookups(&self) -> u64 {
        self.lookups
    }

    /// σ̄_t around a point \[1/length\]; that of the nearest cell outside the box.
    #[inline]
    #[must_use]
    pub fn at(&self, point: DVec3) -> f64 {
        let cell = ((point - self.min) * self.cells_per_length).floor();
        let cell = cell.as_ivec3().clamp(IVec3::ZERO, self.cells - 1);
        self.means[(cell.x + self.cells.x * (cell.y + self.cells.y * cell.z)) as usize]
    }

    /// The rate at which vertices are placed around a point \[1/length\]: [`at`](Self::at), or the floor.
    #[inline]
    #[must_use]
    pub fn placement_rate(&self, point: DVec3) -> f64 {
        self.at(point).max(self.floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{AnalyticCosine, Homogeneous};

    #[test]
    fn a_homogeneous_box_has_its_extinction_everywhere() {
        let bounds = Bounds::aligned_box(DVec3::ZERO, dvec3(1.0, 2.0, 4.0)).unwrap();
        let mean = LocalMean::of(&Homogeneous::new(0.7).unwrap(), &bounds, [2, 3, 4], 2);
        for point in [DVec3::ZERO, dvec3(1.0, 2.0, 4.0), dvec3(-5.0, 1.0, 9.0)] {
            assert!((mean.at(point) - 0.7).abs() < 1e-15);
        }
        assert_eq!(mean.lookups(), 24 * 8);
        let flat = Bounds::aligned_box(DVec3::ZERO, dvec3(1.0, 0.0, 1.0)).unwrap();
        let mean = LocalMean::of(&Homogeneous::new(0.7).unwrap(), &flat, [4, 1, 4], 1);
        assert!((mean.at(dvec3(0.5, 0.0, 0.5)) - 0.7).abs() < 1e-15);
    }

    #[test]
    fn a_cell_is_the_mean_of_what_is_in_it() {
        let medium = AnalyticCosine::new(1.0).unwrap();
        let bounds = AnalyticCosine::default_bounds();
        let coarse = LocalMean::of(&medium, &bounds, [2; 3], 4);
        let fine = LocalMean::of(&medium, &bounds, [8; 3], 1);
        let point = bounds.enclosing_ball().0 + DVec3::splat(1.0);
        // 4³ probes of one coarse cell are the probes of 4³ fine ones.
        let (min, max) = bounds.corners();
        let step = (max - min) / 8.0;
        let mut sum = 0.0;
        for i in 0..64 {
            let cell = dvec3(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16));
            sum += fine.at(min + (cell + DVec3::splat(4.5)) * step);
        }
        assert!((coarse.at(point) - sum / 64.0).abs() < 1e-14);
        assert!(fine.placement_rate(min) > 0.0 && fine.at(min) == 0.0);
    }
}
