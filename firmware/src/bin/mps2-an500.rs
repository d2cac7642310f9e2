//! Arm MPS2 with a Cortex-M7 (AN500): the picture lies in memory.
#![no_std]
#![no_main]

microphong_firmware::framebuffer_board!(::microphong_firmware::shaders::every());
