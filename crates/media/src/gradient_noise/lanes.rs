//! The noise in lanes: the twin of `GradientNoise::at`.

use super::{AMPLITUDE, GradientNoise, mix, quintic};
use fairflight_elementary::lanes::{LANES, Lanes};

impl GradientNoise {
    /// The noise at the points of all lanes, each with the bits of [`at`](Self::at). Coordinates are below 2^31.
    #[inline(always)]
    pub(crate) fn at_lanes(&self, points: &[Lanes; 3]) -> Lanes {
        let [(i, x), (j, y), (k, z)] = [split(&points[0]), split(&points[1]), split(&points[2])];
        let hashes = self.hashes_of_lanes(&[i, j, k]);
        let (x, y, z) = ([x, below_one(&x)], [y, below_one(&y)], [z, below_one(&z)]);
        let mut corners = [[0.0; LANES]; 8];
        for (corner, slope) in corners.iter_mut().enumerate() {
            let offsets = [&x[corner >> 2], &y[corner >> 1 & 1], &z[corner & 1]];
            *slope = slopes(&gradients(&hashes[corner]), offsets);
        }
        let [u, v, w] = [quintics(&x[0]), quintics(&y[0]), quintics(&z[0])];
        let near = mixed(&mixed(&corners[0], &corners[1], &w), &mixed(&corners[2], &corners[3], &w), &v);
        let far = mixed(&mixed(&corners[4], &corners[5], &w), &mixed(&corners[6], &corners[7], &w), &v);
        let mut noise = mixed(&near, &far, &u);
        for noise in &mut noise {
            *noise = (*noise * AMPLITUDE).clamp(-1.0, 1.0);
        }
        noise
    }

    /// The hashes of all corners of all lanes: the permutation is read lane by lane, all else of the noise is arithmetic of whole lanes. Not
    /// inlined, so that no lane of it is put into a vector register.
    #[inline(never)]
    fn hashes_of_lanes(&self, [i, j, k]: &[[u8; LANES]; 3]) -> [[u8; LANES]; 8] {
        let mut hashes = [[0; LANES]; 8];
        for lane in 0..LANES {
            for (corner, hash) in self.hashes(i[lane], j[lane], k[lane]).into_iter().enumerate() {
                hashes[corner][lane] = hash;
            }
        }
        hashes
    }
}

#[inline(always)]
fn below_one(offsets: &Lanes) -> Lanes {
    let mut values = [0.0; LANES];
    for l in 0..LANES {
        values[l] = offsets[l] - 1.0;
    }
    values
}

#[inline(always)]
fn quintics(offsets: &Lanes) -> Lanes {
    let mut values = [0.0; LANES];
    for l in 0..LANES {
        values[l] = quintic(offsets[l]);
    }
    values
}

/// Gradients times the offsets from their corner.
#[inline(always)]
fn slopes([gx, gy, gz]: &[[i8; LANES]; 3], [x, y, z]: [&Lanes; 3]) -> Lanes {
    let mut slopes = [0.0; LANES];
    for l in 0..LANES {
        slopes[l] = f64::from(gx[l]) * x[l] + f64::from(gy[l]) * y[l] + f64::from(gz[l]) * z[l];
    }
    slopes
}

/// The gradients of these hashes, axis by axis: the table `GRADIENTS` by arithmetic of bytes, of which a register holds those of all lanes.
#[inline(always)]
fn gradients(hashes: &[u8; LANES]) -> [[i8; LANES]; 3] {
    let mut gradients = [[0; LANES]; 3];
    for (l, hash) in hashes.iter().enumerate() {
        let quarter = hash & 12;
        let is_last_pair = hash & 14 == 14;
        // 1 or −1 by the two lowest bits.
        let (first, second) = (1 - 2 * (hash & 1).cast_signed(), 1 - (hash & 2).cast_signed());
        gradients[0][l] = if (quarter == 8) | is_last_pair { 0 } else { first };
        let other = if quarter == 4 { 0 } else { second };
        gradients[1][l] = if quarter == 8 { first } else { other };
        let middle = if (quarter == 4) | (quarter == 8) { second } else { 0 };
        gradients[2][l] = if is_last_pair { first } else { middle };
    }
    gradients
}

#[inline(always)]
fn mixed(a: &Lanes, b: &Lanes, t: &Lanes) -> Lanes {
    let mut values = [0.0; LANES];
    for l in 0..LANES {
        values[l] = mix(a[l], b[l], t[l]);
    }
    values
}

/// The cell that holds each coordinate, modulo 256, and the distance from its lower end.
#[inline(always)]
fn split(coordinates: &Lanes) -> ([u8; LANES], Lanes) {
    /// 1.5 · 2^52: a number of at most 2^51 that is added to it is rounded to an integer, which stands in the lowest bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let (mut cells, mut offsets) = ([0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        let nearest = (coordinates[l] + ROUND) - ROUND;
        let lower = if nearest > coordinates[l] { nearest - 1.0 } else { nearest };
        cells[l] = ((lower + ROUND).to_bits() & 0xff) as u8;
        offsets[l] = coordinates[l] - lower;
    }
    (cells, offsets)
}
