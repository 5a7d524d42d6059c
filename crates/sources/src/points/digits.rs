//! Parts that the sets share: exact uniform integers, and numbers of the lattice from a stratum and what lies inside of it.

use crate::Seeded;
use rand::rand_core::Rng;

/// Points of the lattice: 2^53.
const LATTICE: u64 = 1 << 53;

/// 53 random bits.
#[inline]
pub(super) fn bits_53(source: &mut Seeded) -> u64 {
    source.next_u64() >> 11
}

/// A uniform integer below `n`, exactly: multiples that do not fit whole are drawn again (lemire-2019, without his short cut).
pub(super) fn below(n: u64, source: &mut Seeded) -> u64 {
    debug_assert!(n > 0, "an integer below nothing");
    // 2^64 mod n: that many of the least products would have one representative too many.
    let excess = n.wrapping_neg() % n;
    loop {
        let product = u128::from(source.next_u64()) * u128::from(n);
        if product as u64 >= excess {
            return (product >> 64) as u64;
        }
    }
}

/// A number of the lattice uniform in the stratum `stratum` of `strata` equal ones, by what `inside` says of 53 bits.
///
/// With a uniform stratum and uniform bits, (stratum · 2^53 + inside)/strata is uniform on multiples of 1/strata, of which each
/// number of the lattice gets exactly `strata`: uniform on the lattice, without an error. Within one stratum the lattice
/// point may lie below its border by less than 2^-53.
#[inline]
pub(super) fn within(stratum: u64, strata: u64, inside: u64) -> f64 {
    debug_assert!(stratum < strata && inside < LATTICE, "outside of the cube");
    let number = ((u128::from(stratum) << 53) + u128::from(inside)) / u128::from(strata);
    number as u64 as f64 / LATTICE as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_below_are_uniform() {
        let mut source = Seeded::new(1);
        let mut met = [0_u32; 7];
        for _ in 0..70_000 {
            met[below(7, &mut source) as usize] += 1;
        }
        // Standard deviation 93: five of them.
        assert!(met.iter().all(|&times| times.abs_diff(10_000) < 465), "{met:?}");
        assert_eq!(below(1, &mut source), 0);
    }

    #[test]
    fn strata_cover_the_lattice() {
        assert_eq!(within(0, 3, 0), 0.0);
        assert_eq!(within(2, 3, LATTICE - 1), crate::LARGEST_VARIATE);
        assert_eq!(within(1, 2, 0), 0.5);
        assert_eq!(within(5, 8, LATTICE / 2), 0.6875);
    }
}
