//! Boards with a frame buffer and smooth outlines. It is a program of its own, because code for them makes plain frames a little slower.
#![no_std]
#![no_main]

microphong_firmware::framebuffer_board!(::microphong_firmware::shaders::every());
