//! See `microphong_stress::fuzz::scene`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| microphong_stress::fuzz::scene(bytes));
