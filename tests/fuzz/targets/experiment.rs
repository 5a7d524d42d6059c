//! Fuzz target of `fairflight_fuzz::experiment`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::experiment::check(data));
