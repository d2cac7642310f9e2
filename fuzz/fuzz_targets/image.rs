//! See `microphong_stress::readers::image`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| microphong_stress::readers::image(bytes));
