//! Arm MPS2 with a Cortex-M3 (AN385), and no shading method but one of a user's own.
#![no_std]
#![no_main]

#[path = "../../../examples/own_method.rs"]
mod own_method;

microphong_firmware::framebuffer_board!(&[::microphong::Shader::new(&own_method::Cartoon)]);
