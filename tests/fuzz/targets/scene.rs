//! Fuzz target of `fairflight_fuzz::scene`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::scene::check(data));
