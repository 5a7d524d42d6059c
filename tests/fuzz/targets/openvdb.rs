//! Fuzz target of `fairflight_fuzz::openvdb`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fairflight_fuzz::openvdb::check(data));
