//! See `microphong_stress::readers::threemf`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| microphong_stress::readers::threemf(bytes));
