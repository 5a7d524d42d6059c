//! Instruction sets that loops over lanes are compiled for.

use pulp::{Simd, WithSimd};

/// A loop over lanes, compiled once for each instruction set.
///
/// [`run`](Self::run) and all that it calls have to be inlined into it (`#[inline(always)]`): a function that stays apart is compiled for the common set.
pub trait LaneWork {
    /// Result of the loop.
    type Output;

    /// Runs the loop.
    fn run(self) -> Self::Output;
}

/// Work as the dispatcher takes it.
struct Dispatched<W>(W);

impl<W: LaneWork> WithSimd for Dispatched<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.run()
    }
}

/// Instruction sets that lanes make use of. Results are the same bits on all: only their time differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// The one that every machine of the target has: SSE2 on x86-64, NEON on 64-bit ARM.
    Common,
    /// Four numbers in a register (AVX2, with what x86-64-v3 has besides).
    Avx2,
    /// Eight numbers in a register (AVX-512, with what x86-64-v4 has besides).
    Avx512,
}

impl InstructionSet {
    /// All of them, the widest last.
    pub const ALL: [Self; 3] = [Self::Common, Self::Avx2, Self::Avx512];

    /// True if this machine has it.
    #[must_use]
    pub fn is_there(self) -> bool {
        match self {
            Self::Common => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => pulp::x86::V3::try_new().is_some(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => pulp::x86::V4::try_new().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Those that this machine has, the widest last.
    pub fn of_this_machine() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|set| set.is_there())
    }

    /// The widest that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        Self::of_this_machine().last().unwrap_or(Self::Common)
    }

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Common if cfg!(target_arch = "x86_64") => "SSE2",
            Self::Common => "common set",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        }
    }

    /// Runs work compiled for it, or for the common set on a machine that lacks it.
    #[inline]
    pub fn run<W: LaneWork>(self, work: W) -> W::Output {
        let work = Dispatched(work);
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Common => {}
            Self::Avx2 => {
                if let Some(v3) = pulp::x86::V3::try_new() {
                    return Simd::vectorize(v3, work);
                }
            }
            Self::Avx512 => {
                if let Some(v4) = pulp::x86::V4::try_new() {
                    return Simd::vectorize(v4, work);
                }
            }
        }
        work.with_simd(pulp::Scalar::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{self, Lanes};

    struct Exponentials([f64; 16]);

    impl LaneWork for Exponentials {
        type Output = Lanes;

        #[inline(always)]
        fn run(self) -> Lanes {
            lanes::exp(&self.0)
        }
    }

    #[test]
    fn results_are_the_same_on_all_sets() {
        let arguments: [f64; 16] = std::array::from_fn(|lane| 1.7 * lane as f64 - 12.3);
        let expected = arguments.map(|x| crate::exp(x).to_bits());
        for set in InstructionSet::ALL {
            assert_eq!(set.run(Exponentials(arguments)).map(f64::to_bits), expected, "{}", set.name());
        }
    }

    #[test]
    fn the_common_set_is_there_and_the_widest_is_the_last() {
        let sets: Vec<InstructionSet> = InstructionSet::of_this_machine().collect();
        assert_eq!((sets[0], sets.last()), (InstructionSet::Common, Some(&InstructionSet::widest())));
        assert!(sets.is_sorted());
    }
}
