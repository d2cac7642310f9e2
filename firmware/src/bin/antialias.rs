//! Boards with a frame buffer, smooth outlines, and lights with a range or a cone or from the sky. It is a program of its own, because code for them
//! makes plain frames a little slower.
#![no_std]
#![no_main]

microphong_firmware::framebuffer_board!(::microphong_firmware::shaders::every());
