//! See `microphong_stress::readers::mtl`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| microphong_stress::readers::mtl(bytes));
