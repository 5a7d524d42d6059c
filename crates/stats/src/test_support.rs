//! Reproducible variates for this crate's own tests, which know no other crate of the workspace.

/// Uniform variates in (0, 1): SplitMix64 (Steele, Lea and Flood 2014), 53 bits, centred in their cells.
pub(crate) fn uniforms(seed: u64) -> impl Iterator<Item = f64> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0) + 0.5 / 9_007_199_254_740_992.0
    })
}
