//! The variates of a case.

use crate::number::{Number, Precise};
use std::cell::OnceCell;

/// A variate of a case.
#[derive(Clone, Debug)]
pub enum Draw {
    /// u = k 2^−53, and −ln(1 − u) once it is asked for.
    Lattice {
        /// k < 2^53.
        k: u64,
        /// The exponential.
        exponential: OnceCell<Precise>,
    },
    /// u = k 2^−53, and −ln(1 − u) by a library in doubles: of scripts in great number, which are no cases.
    Rounded(u64),
    /// An exponential that no lattice variate has: of ties.
    Given(f64),
}

/// The variates of a case, in the order in which they are drawn.
#[derive(Clone, Debug)]
pub struct Script {
    draws: Vec<Draw>,
    behind: Draw,
}

/// Step of the variates that single precision holds too: 2^29 · 2^−53 = 2^−24.
const STEP: u64 = 1 << 29;

impl Script {
    /// These variates.
    #[must_use]
    pub fn new(draws: Vec<Draw>) -> Self {
        Self { draws, behind: Draw::uniform(0.5) }
    }

    /// As many variates as an estimate may need, multiples of 2^−24, from the name of a case: bits of a generator of their own (splitmix64 over the FNV
    /// hash of the name), so that no change of another stream moves a vector.
    #[must_use]
    pub fn of(name: &str, draws: usize) -> Self {
        Self::drawn(name, draws, Draw::lattice)
    }

    /// The same variates with exponentials by a library in doubles.
    pub(crate) fn rounded(name: &str, draws: usize) -> Self {
        Self::drawn(name, draws, Draw::Rounded)
    }

    fn drawn(name: &str, draws: usize, of: fn(u64) -> Draw) -> Self {
        let hash = name.bytes().fold(0xCBF2_9CE4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
        });
        let mut state = hash;
        let draw = |_| {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            of(((mixed ^ (mixed >> 31)) >> 40) * STEP)
        };
        Self::new((0..draws).map(draw).collect())
    }

    /// The variate of this number; behind the last one 1/2, which no right run sees.
    pub(crate) fn get(&self, number: usize) -> &Draw {
        self.draws.get(number).unwrap_or(&self.behind)
    }

    /// Variates that there are.
    pub(crate) fn len(&self) -> usize {
        self.draws.len()
    }
}

impl Draw {
    /// The variate k 2^−53.
    #[must_use]
    pub fn lattice(k: u64) -> Self {
        assert!(k < 1 << 53, "{k} is no lattice variate");
        Self::Lattice { k, exponential: OnceCell::new() }
    }

    /// The variate u, a multiple of 2^−53.
    #[must_use]
    pub fn uniform(u: f64) -> Self {
        Self::lattice((u * 2.0_f64.powi(53)) as u64)
    }

    /// k.
    #[must_use]
    pub fn k(&self) -> Option<u64> {
        match self {
            Self::Lattice { k, .. } | Self::Rounded(k) => Some(*k),
            Self::Given(_) => None,
        }
    }

    /// The exponential of this variate.
    #[must_use]
    pub fn exponential(&self) -> Precise {
        match self {
            Self::Lattice { k, exponential } => exponential.get_or_init(|| Precise::exponential(*k)).clone(),
            Self::Rounded(k) => Precise::of(-libm::log1p(-(*k as f64) * 2.0_f64.powi(-53))),
            Self::Given(exponential) => Precise::of(*exponential),
        }
    }
}
