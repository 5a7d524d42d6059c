//! Fuzz target of `fairflight_fuzz::png`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::png::check(data));
