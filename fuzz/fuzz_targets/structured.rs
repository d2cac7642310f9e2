//! See `microphong_stress::fuzz::structured`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| microphong_stress::fuzz::structured(bytes));
