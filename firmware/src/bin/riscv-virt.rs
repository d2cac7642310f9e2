//! QEMU's machine virt with a RISC-V processor of 32 bits: the picture lies in memory.
#![no_std]
#![no_main]

microphong_firmware::framebuffer_board!(::microphong_firmware::shaders::every());
