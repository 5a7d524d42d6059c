//! Fuzz target of `fairflight_fuzz::pfm`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::pfm::check(data));
