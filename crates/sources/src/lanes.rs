//! Several seeded streams side by side, one a lane.

use crate::UniformSource;
use crate::seeded::{Seeded, step};
use fairflight_elementary::lanes::{LANES, Lanes, Mask, ln_of_normal};

/// xoshiro256++ in lanes, each a stream of its own seed.
///
/// **Law.** Lane i hands out, bit for bit, the variates of [`Seeded::new`](crate::Seeded::new) of the i-th seed: what is computed lane by lane from them is what one
/// walk after the other computes.
///
/// The words of the states lie lane beside lane, so that a step of all of them is a few vector instructions.
#[derive(Clone, Debug)]
pub struct SeededLanes {
    words: [[u64; LANES]; 4],
}

impl SeededLanes {
    /// Lanes that wait for a stream each: until then all their variates are 0.
    pub const IDLE: Self = Self { words: [[0; LANES]; 4] };

    /// The streams of these seeds.
    #[must_use]
    pub fn new(seeds: [u64; LANES]) -> Self {
        let mut lanes = Self::IDLE;
        for (lane, seed) in seeds.into_iter().enumerate() {
            lanes.set(lane, &Seeded::new(seed));
        }
        lanes
    }

    /// The stream of a lane as it stands.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, lane: usize) -> Seeded {
        let [a, b, c, d] = &self.words;
        Seeded { words: [a[lane], b[lane], c[lane], d[lane]] }
    }

    /// Puts a stream into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, stream: &Seeded) {
        for (word, of_stream) in self.words.iter_mut().zip(stream.words) {
            word[lane] = of_stream;
        }
    }

    /// The next variate of every lane, each a multiple of 2^−53 in \[0, 1).
    #[inline(always)]
    pub fn next_uniforms(&mut self) -> Lanes {
        self.next_uniforms_of(&[u64::MAX; LANES])
    }

    /// The next variates of these lanes; the streams of the others stay where they are, and what stands in their place is of no use.
    #[inline(always)]
    pub fn next_uniforms_of(&mut self, lanes: &Mask) -> Lanes {
        let mut variates = [0.0; LANES];
        let [a, b, c, d] = &mut self.words;
        for i in 0..LANES {
            let before = [a[i], b[i], c[i], d[i]];
            let (word, after) = step(before);
            variates[i] = on_lattice(word);
            let chosen = |k: usize| before[k] ^ ((before[k] ^ after[k]) & lanes[i]);
            (a[i], b[i], c[i], d[i]) = (chosen(0), chosen(1), chosen(2), chosen(3));
        }
        variates
    }

    /// The stream of one lane, to be drawn from alone.
    pub fn lane(&mut self, lane: usize) -> impl UniformSource {
        OneLane { words: &mut self.words, lane }
    }

    /// The next exponential variate of every lane, of rate 1.
    #[inline(always)]
    pub fn next_exponentials(&mut self) -> Lanes {
        let uniforms = self.next_uniforms();
        let mut rests = [0.0; LANES];
        for i in 0..LANES {
            rests[i] = 1.0 - uniforms[i];
        }
        // From 2^−53 to 1.
        let mut variates = ln_of_normal(&rests);
        for variate in &mut variates {
            *variate = -*variate;
        }
        variates
    }
}

/// A lane of [`SeededLanes`].
struct OneLane<'a> {
    words: &'a mut [[u64; LANES]; 4],
    lane: usize,
}

impl UniformSource for OneLane<'_> {
    #[inline]
    fn next_uniform(&mut self) -> f64 {
        let (word, after) = step(std::array::from_fn(|k| self.words[k][self.lane]));
        for (words, after) in self.words.iter_mut().zip(after) {
            words[self.lane] = after;
        }
        on_lattice(word)
    }
}

/// The 53 high bits of a word, as a multiple of 2^−53.
///
/// Their upper 21 and lower 32 bits become numbers by the bits of 2^84 and 2^52 in front of them, whose sum is exact: few instruction sets convert
/// integers of 64 bits.
#[inline(always)]
fn on_lattice(word: u64) -> f64 {
    const LOW: f64 = 4_503_599_627_370_496.0;
    const HIGH: f64 = 19_342_813_113_834_066_795_298_816.0;
    let k = word >> 11;
    let low = f64::from_bits(LOW.to_bits() | (k & 0xFFFF_FFFF)) - LOW;
    let high = f64::from_bits(HIGH.to_bits() | (k >> 32)) - HIGH;
    (high + low) * (1.0 / (1_u64 << 53) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_elementary::lanes::{lanes_of, mask};

    #[test]
    fn lanes_are_seeded_streams() {
        let seeds = std::array::from_fn(|lane| if lane == 3 { u64::MAX } else { lane as u64 });
        let mut lanes = SeededLanes::new(seeds);
        let mut streams = seeds.map(Seeded::new);
        for k in 0..1000 {
            let (found, expected) = if k % 3 == 0 {
                (lanes.next_exponentials(), streams.each_mut().map(UniformSource::next_exponential))
            } else {
                (lanes.next_uniforms(), streams.each_mut().map(UniformSource::next_uniform))
            };
            assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
        }
    }

    #[test]
    fn a_lane_goes_on_by_itself() {
        let seeds = std::array::from_fn(|lane| 7 * lane as u64);
        let mut lanes = SeededLanes::new(seeds);
        let mut streams = seeds.map(Seeded::new);
        for k in 0..200 {
            let drawn: Mask = std::array::from_fn(|lane| mask((k * 5 + lane) % 3 == 0));
            let found = lanes.next_uniforms_of(&drawn);
            for lane in lanes_of(&drawn) {
                assert_eq!(found[lane], streams[lane].next_uniform());
            }
            let alone = k % LANES;
            assert_eq!(lanes.lane(alone).next_exponential(), streams[alone].next_exponential());
        }
        assert!(streams.iter().enumerate().all(|(lane, stream)| lanes.get(lane) == *stream));
    }

    #[test]
    fn words_become_multiples_of_the_lattice() {
        for word in [0, 1 << 11, u64::MAX, 0xDEAD_BEEF_1234_5678] {
            assert_eq!(on_lattice(word), (word >> 11) as f64 / (1_u64 << 53) as f64);
        }
    }
}
