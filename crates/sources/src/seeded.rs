//! The seeded generator, and how one seed becomes one independent stream per batch.

use crate::UniformSource;
use rand::SeedableRng;
use rand::rand_core::utils::fill_bytes_via_next_word;
use rand::rand_core::{Rng, TryRng};
use rand_xoshiro::SplitMix64;
use std::convert::Infallible;

/// xoshiro256++ (Blackman & Vigna 2021) from a 64-bit seed: the default source, and a generator that the distributions of `rand` draw from.
///
/// Word by word it is `rand_xoshiro`'s `Xoshiro256PlusPlus`, as a test says. Its state is its own, so that a lane of [`SeededLanes`](crate::SeededLanes) can take a
/// stream up where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seeded {
    pub(crate) words: [u64; 4],
}

impl Seeded {
    /// The stream of `seed`; the state is filled by SplitMix64, as the generator's authors advise.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut filler = SplitMix64::seed_from_u64(seed);
        Self { words: std::array::from_fn(|_| filler.next_u64()) }
    }

    /// The stream of one batch of a run: independent of how batches are spread over threads or processes.
    #[must_use]
    pub fn for_batch(seed: u64, batch: u64) -> Self {
        Self::new(derive_seed(seed, batch))
    }
}

/// A step of the generator: 64 bits, and the state behind them.
#[inline(always)]
pub(crate) fn step([a, b, c, d]: [u64; 4]) -> (u64, [u64; 4]) {
    let word = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
    let (third, fourth) = (c ^ a, d ^ b);
    (word, [a ^ fourth, b ^ third, third ^ (b << 17), fourth.rotate_left(45)])
}

impl TryRng for Seeded {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        // The high bits: the lowest have linear dependencies.
        Ok((self.next_u64() >> 32) as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let (word, words) = step(self.words);
        self.words = words;
        Ok(word)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

impl UniformSource for Seeded {
    #[inline]
    fn next_uniform(&mut self) -> f64 {
        // The 53 high bits, as a multiple of 2^-53.
        (self.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }
}

/// The seed of the `index`-th child of `seed`.
///
/// Two rounds of SplitMix64's finaliser (Steele, Lea & Flood 2014): a bijection of `index` for a fixed seed, so that no
/// two batches of one run share a stream, and nested derivations (run, check, batch) do not collide by addition.
#[must_use]
pub fn derive_seed(seed: u64, index: u64) -> u64 {
    mix(mix(seed.wrapping_add(GOLDEN_GAMMA)) ^ index.wrapping_mul(GOLDEN_GAMMA))
}

/// The seed of the child of `seed` that has this name: [`derive_seed`] of the name's hash.
///
/// A stream with a name keeps its variates when others are added, moved or taken away. The hash is FNV-1a of 64 bits (Fowler, Noll & Vo
/// 1991) over the bytes of the name in UTF-8, from 0xCBF29CE484222325 on: xor the byte, multiply by 2^40 + 2^8 + 0xB3. It is the
/// same on every machine and in every version of every compiler.
#[must_use]
pub fn named_seed(seed: u64, name: &str) -> u64 {
    derive_seed(seed, fnv_1a(name.as_bytes()))
}

fn fnv_1a(bytes: &[u8]) -> u64 {
    const OFFSET: u64 = 0xCBF2_9CE4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    bytes.iter().fold(OFFSET, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}

const GOLDEN_GAMMA: u64 = 0x9E37_79B9_7F4A_7C15;

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_words_are_those_of_the_generator() {
        for seed in [0, 1, u64::MAX] {
            let (mut ours, mut theirs) = (Seeded::new(seed), Xoshiro256PlusPlus::seed_from_u64(seed));
            assert!((0..100).all(|_| ours.next_u64() == theirs.next_u64()));
        }
    }

    /// Golden: the first variates of seed 1. They change only if the generator does, and then every report does.
    #[test]
    fn the_first_variates_of_a_seed_are_fixed() {
        let mut source = Seeded::new(1);
        let first: Vec<f64> = (0..3).map(|_| source.next_uniform()).collect();
        assert_eq!(first, [0.811_612_158_881_884_8, 0.747_104_716_158_218_7, 0.100_150_903_533_783_75]);
    }

    /// The test vectors that the authors publish.
    #[test]
    fn the_hash_of_a_name_is_fnv_1a() {
        let found = ["", "a", "foobar"].map(|name| fnv_1a(name.as_bytes()));
        assert_eq!(found, [0xCBF2_9CE4_8422_2325, 0xAF63_DC4C_8601_EC8C, 0x8594_4171_F739_67E8]);
        assert_eq!(named_seed(7, "a"), derive_seed(7, 0xAF63_DC4C_8601_EC8C));
    }

    #[test]
    fn children_of_a_seed_differ() {
        let mut children: Vec<u64> =
            (0..100).flat_map(|seed| (0..100).map(move |i| derive_seed(seed, i))).collect();
        children.sort_unstable();
        children.dedup();
        assert_eq!(children.len(), 100 * 100);
    }

    #[test]
    fn variates_lie_on_the_lattice() {
        let mut source = Seeded::new(7);
        for _ in 0..1000 {
            let u = source.next_uniform();
            assert!((0.0..1.0).contains(&u));
            assert_eq!((u * (1_u64 << 53) as f64).fract(), 0.0);
        }
    }
}
