//! Fuzz target of `fairflight_fuzz::exr`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::exr::check(data));
