//! Processors that programs are compiled for, and common chips that have them.

/// A processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// A Cortex-M0+: no division and no long multiplication.
    CortexM0Plus,
    /// A Cortex-M3: no floating point.
    CortexM3,
    /// A Cortex-M4F: floating point.
    CortexM4F,
    /// A Cortex-M33: floating point, a later architecture.
    CortexM33,
    /// A RISC-V processor without floating point.
    RiscV,
}

impl Core {
    /// All kinds of processors.
    pub const ALL: [Self; 5] = [Self::CortexM0Plus, Self::CortexM3, Self::CortexM4F, Self::CortexM33, Self::RiscV];

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CortexM0Plus => "cortex-m0plus",
            Self::CortexM3 => "cortex-m3",
            Self::CortexM4F => "cortex-m4f",
            Self::CortexM33 => "cortex-m33",
            Self::RiscV => "risc-v",
        }
    }

    /// The name in tables.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::CortexM0Plus => "Cortex-M0+",
            Self::CortexM3 => "Cortex-M3",
            Self::CortexM4F => "Cortex-M4F",
            Self::CortexM33 => "Cortex-M33",
            Self::RiscV => "RISC-V",
        }
    }

    /// The target of the compiler.
    #[must_use]
    pub const fn target(self) -> &'static str {
        match self {
            Self::CortexM0Plus => "thumbv6m-none-eabi",
            Self::CortexM3 => "thumbv7m-none-eabi",
            Self::CortexM4F => "thumbv7em-none-eabihf",
            Self::CortexM33 => "thumbv8m.main-none-eabihf",
            Self::RiscV => "riscv32imc-unknown-none-elf",
        }
    }
}

/// A chip that is in common use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chip {
    /// The name on the command line.
    pub name: &'static str,
    /// Processor of the chip.
    pub core: Core,
    /// Bytes of flash, of the chip or of the board's flash chip.
    pub flash_bytes: u64,
    /// Bytes of RAM.
    pub ram_bytes: u64,
}

const fn chip(name: &'static str, core: Core, flash: u64, ram: u64) -> Chip {
    Chip { name, core, flash_bytes: flash << 10, ram_bytes: ram << 10 }
}

impl Chip {
    /// All chips, the one with the least flash first.
    pub const ALL: [Self; 7] = [
        chip("stm32f103", Core::CortexM3, 64, 20),
        chip("samd21", Core::CortexM0Plus, 256, 32),
        chip("stm32f411", Core::CortexM4F, 512, 128),
        chip("nrf52840", Core::CortexM4F, 1024, 256),
        chip("rp2040", Core::CortexM0Plus, 2048, 264),
        chip("rp2350", Core::CortexM33, 4096, 520),
        chip("esp32-c3", Core::RiscV, 4096, 400),
    ];

    /// The share of its flash that these bytes take, or the share of its RAM if that is larger: at most 1 if it has room for them.
    #[must_use]
    pub const fn load(&self, flash: u64, ram: u64) -> f64 {
        (flash as f64 / self.flash_bytes as f64).max(ram as f64 / self.ram_bytes as f64)
    }
}
