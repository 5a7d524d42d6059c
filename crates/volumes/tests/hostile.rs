//! Damaged files: whatever is done to their bytes, reading ends with a grid or an error, within its memory.

mod common;

use std::cell::Cell;

use common::fixture;
use fairflight_volumes::{FIXED_ALLOWANCE, MAX_EXPANSION, VdbError, grids, read_float_grid};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// Bytes of the end offset of the first grid in files whose only grid is a 32-bit float grid `density`.
const END_OFFSET: std::ops::Range<usize> = 0x74..0x7c;

fn deterministic(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Reads what can be read and asserts what must hold of any grid that comes out.
fn read_anything(bytes: &[u8]) -> Result<(), VdbError> {
    let infos = grids(bytes)?;
    assert!(infos.iter().all(|info| !info.name.contains('\x1e')));
    let first = infos.iter().find(|info| info.value_type == "float").map(|info| info.name.as_str());
    let grid = read_float_grid(bytes, first)?;
    assert!(grid.memory_bytes() <= MAX_EXPANSION * bytes.len() + FIXED_ALLOWANCE);
    assert!(grid.minimum().is_finite() && grid.minimum() <= grid.maximum() && grid.maximum().is_finite());
    if let Some((lowest, highest)) = grid.active_bounds() {
        assert!((0..3).all(|axis| lowest[axis] <= highest[axis]));
        let [x, y, z] = lowest.map(|coordinate| f64::from(coordinate) - 0.5);
        let value = grid.trilinear(x, y, z);
        assert!(f64::from(grid.minimum()) <= value && value <= f64::from(grid.maximum()));
    }
    Ok(())
}

/// One act of damage; positions are fractions of the file in 2^-32.
#[derive(Debug, Clone)]
enum Damage {
    Overwrite { at: u32, with: Vec<u8> },
    FlipBit { at: u32, bit: u8 },
    Cut { at: u32, length: usize },
    Copy { from: u32, to: u32, length: usize },
    Truncate { at: u32 },
}

fn damage() -> impl Strategy<Value = Damage> {
    let extreme =
        prop_oneof![Just(vec![0xff; 4]), Just(vec![0xff; 8]), Just(vec![0; 8]), Just(vec![0, 0, 0, 0x80])];
    let with = prop_oneof![extreme, prop::collection::vec(any::<u8>(), 1..9)];
    prop_oneof![
        3 => (any::<u32>(), with).prop_map(|(at, with)| Damage::Overwrite { at, with }),
        3 => (any::<u32>(), 0..8_u8).prop_map(|(at, bit)| Damage::FlipBit { at, bit }),
        1 => (any::<u32>(), 1..300_usize).prop_map(|(at, length)| Damage::Cut { at, length }),
        1 => (any::<u32>(), any::<u32>(), 1..300_usize)
            .prop_map(|(from, to, length)| Damage::Copy { from, to, length }),
        1 => any::<u32>().prop_map(|at| Damage::Truncate { at }),
    ]
}

/// Damages the first `reach` bytes: heads are small, and damage spread evenly over a file would rarely meet them.
fn apply(damage: &Damage, bytes: &mut Vec<u8>, reach: usize) {
    let length_now = bytes.len().min(reach);
    if length_now == 0 {
        return;
    }
    let place = |fraction: u32| ((u64::from(fraction) * length_now as u64) >> 32) as usize;
    match damage {
        Damage::Overwrite { at, with } => {
            let at = place(*at);
            let end = (at + with.len()).min(bytes.len());
            bytes[at..end].copy_from_slice(&with[..end - at]);
        }
        Damage::FlipBit { at, bit } => bytes[place(*at)] ^= 1 << bit,
        Damage::Cut { at, length } => {
            let at = place(*at);
            let end = (at + length).min(bytes.len());
            bytes.drain(at..end);
        }
        Damage::Copy { from, to, length } => {
            let (from, to) = (place(*from), place(*to));
            let length = (*length).min(bytes.len() - from.max(to));
            bytes.copy_within(from..from + length, to);
        }
        Damage::Truncate { at } => bytes.truncate(place(*at)),
    }
}

/// Reads damaged copies of a file. Some must be refused, else the damage would test nothing.
fn survive(file: &str, reach: usize, cases: u32, seed: u64) {
    let sound = fixture(file);
    let refused = Cell::new(0);
    let acts = prop::collection::vec(damage(), 1..4);
    TestRunner::new(deterministic(cases, seed))
        .run(&acts, |acts| {
            let mut bytes = sound.clone();
            for act in &acts {
                apply(act, &mut bytes, reach);
            }
            if let Err(error) = read_anything(&bytes) {
                refused.set(refused.get() + 1);
                prop_assert!(!error.to_string().contains('\n'), "{error}");
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{file}: {error}"));
    assert!(refused.get() > cases / 10, "{file}: only {} of {cases} refused", refused.get());
}

#[test]
fn damaged_heads_are_survived() {
    for (seed, file) in
        ["tiles.vdb", "eq21_64_half.vdb", "vec_only.vdb", "codes.vdb", "zip.vdb"].iter().enumerate()
    {
        survive(file, 700, 400, seed as u64);
    }
}

#[test]
fn damaged_bodies_are_survived() {
    survive("tiles.vdb", usize::MAX, 2000, 10);
    survive("eq21_64_half.vdb", usize::MAX, 250, 11);
    survive("eq21_64.vdb", usize::MAX, 250, 12);
    survive("zip.vdb", 30_000, 1000, 13);
    survive("plain.vdb", usize::MAX, 250, 14);
}

#[test]
fn every_byte_of_a_head_may_be_wrong() {
    let mut bytes = fixture("tiles.vdb");
    for at in 0..1500 {
        let sound = bytes[at];
        for wrong in [0, 0x7f, 0xff, sound ^ 1, sound ^ 0x80] {
            bytes[at] = wrong;
            let _either_way = read_anything(&bytes);
        }
        bytes[at] = sound;
    }
}

#[test]
fn every_shorter_file_is_refused() {
    let bytes = fixture("tiles.vdb");
    for length in 0..bytes.len() {
        match read_anything(&bytes[..length]) {
            Err(VdbError::NotOpenVdb) => assert!(length < 8),
            Err(VdbError::Truncated { at, .. }) => assert_eq!(at, length),
            other => panic!("{length}: {other:?}"),
        }
    }
}

#[test]
fn a_grid_that_claims_to_end_early_is_refused() {
    for file in ["tiles.vdb", "eq21_64.vdb"] {
        let mut bytes = fixture(file);
        let whole = bytes.len();
        for end in (200..whole).step_by(whole / 500) {
            bytes[END_OFFSET].copy_from_slice(&(end as u64).to_le_bytes());
            assert!(read_anything(&bytes).is_err(), "{file} {end}");
        }
    }
}
