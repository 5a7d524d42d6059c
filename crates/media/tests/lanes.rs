//! Media in lanes: the bits of one point after the other.

use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_media::{AnalyticCosine, Homogeneous, Medium, Perlin, PerlinParameters};
use glam::DVec3;

fn is_the_same(name: &str, medium: &impl Medium, points: &[Lanes; 3]) {
    let [x, y, z] = points;
    let found = medium.sigma_t_local_lanes(points);
    for lane in 0..LANES {
        let point = DVec3::new(x[lane], y[lane], z[lane]);
        assert_eq!(found[lane].to_bits(), medium.sigma_t_local(point).to_bits(), "{name} {point}");
    }
}

#[test]
fn a_lane_is_a_point() {
    let perlin = |octaves, offset| {
        Perlin::new(PerlinParameters { octaves, offset, ..PerlinParameters::default() }).unwrap()
    };
    // Steps of the golden ratio.
    let mut variate = 0.0;
    let mut next = || {
        variate = (variate + 0.618_033_988_749_894_8_f64).fract();
        variate - 0.5
    };
    // Sizes beyond the reach of lattice coordinates, and of the common range of sines, among them.
    for size in [1.0, 30.0, 1e4, 1e8, 1e300] {
        for _ in 0..200 {
            let mut points = [[0.0; LANES]; 3];
            for coordinate in points.iter_mut().flatten() {
                *coordinate = size * next();
            }
            // On planes, edges and corners of the lattice, and at zeros of both signs.
            for lane in 0..8 {
                for (axis, coordinates) in points.iter_mut().enumerate() {
                    if lane >> axis & 1 == 1 {
                        coordinates[lane] = coordinates[lane].round();
                    }
                }
            }
            (points[0][8], points[1][8], points[2][9]) = (-0.0, 0.0, -0.0);
            is_the_same("eq. 21", &AnalyticCosine::new(0.7).unwrap(), &points);
            is_the_same("homogeneous", &Homogeneous::new(0.7).unwrap(), &points);
            is_the_same("Perlin", &perlin(12, 0.1), &points);
            is_the_same("Perlin", &perlin(1, -0.0), &points);
        }
    }
}
