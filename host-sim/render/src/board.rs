//! Boards that there is firmware for: their memory, and what their firmware draws.

// The firmware's own file: the numbers exist once.
#[path = "../../../firmware/src/budget.rs"]
pub mod budget;

use crate::{chip::Core, render, shader::Shader};
use budget::Budget;
use serde::{Serialize, Serializer};
use std::fmt;

/// A board that the firmware runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Board {
    /// Raspberry Pi Pico, ST7789 panel of 240x240 pixels.
    Pico,
    /// Raspberry Pi Pico 2, the same panel.
    Pico2,
    /// TI LM3S6965 evaluation board, OLED of 128x64 pixels with 16 greys.
    Lm3s6965evb,
    /// Arm MPS2 with a Cortex-M3, frame buffer of 320x240 pixels.
    Mps2An385,
    /// Arm MPS2 with a Cortex-M4F, frame buffer of 320x240 pixels.
    Mps2An386,
    /// Arm MPS2 with a Cortex-M7, frame buffer of 320x240 pixels.
    Mps2An500,
    /// Arm MPS2 with a Cortex-M33, frame buffer of 320x240 pixels.
    Mps2An505,
    /// QEMU's machine `virt` with a RISC-V processor of 32 bits, frame buffer of 320x240 pixels.
    RiscvVirt,
}

/// Pixel formats of boards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Five, six and five bits of red, green and blue.
    Rgb565,
    /// Five, six and five bits of red, green and blue, the high byte first in memory.
    Rgb565Be,
    /// Sixteen greys.
    Gray4,
}

impl Format {
    /// The format, but for the order of bytes.
    #[must_use]
    pub const fn of_pixels(self) -> render::Format {
        match self {
            Self::Rgb565 | Self::Rgb565Be => render::Format::Rgb565,
            Self::Gray4 => render::Format::Gray4,
        }
    }
}

/// What is known of a board.
#[derive(Clone, Copy)]
struct Facts {
    name: &'static str,
    core: Core,
    budget: Budget,
    shaders: &'static [Shader],
    has_text: bool,
    smooths: bool,
    blank: u8,
    format: Format,
    memory: &'static str,
}

/// The first of the boards with a frame buffer, which differ in their processors and addresses alone.
const FRAMEBUFFER: Facts = Facts {
    name: "mps2-an385",
    core: Core::CortexM3,
    budget: budget::FRAMEBUFFER,
    shaders: &Shader::ALL,
    has_text: true,
    smooths: true,
    blank: 0,
    format: Format::Rgb565,
    memory: include_str!("../../../firmware/boards/mps2-an385.x"),
};

impl Board {
    /// All boards.
    pub const ALL: [Self; 8] =
        [Self::Pico, Self::Pico2, Self::Lm3s6965evb, Self::Mps2An385, Self::Mps2An386, Self::Mps2An500, Self::Mps2An505, Self::RiscvVirt];

    const fn facts(self) -> Facts {
        match self {
            Self::Pico => Facts {
                name: "pico",
                core: Core::CortexM0Plus,
                budget: budget::PICO,
                smooths: false,
                blank: 0xFF,
                format: Format::Rgb565Be,
                memory: include_str!("../../../memory.x"),
                ..FRAMEBUFFER
            },
            Self::Pico2 => Facts {
                name: "pico2",
                core: Core::CortexM33,
                budget: budget::PICO2,
                memory: include_str!("../../../firmware/boards/pico2.x"),
                ..Self::Pico.facts()
            },
            Self::Lm3s6965evb => Facts {
                name: "lm3s6965evb",
                budget: budget::LM3S6965EVB,
                shaders: &Shader::CORE,
                has_text: false,
                smooths: false,
                format: Format::Gray4,
                memory: include_str!("../../../firmware/boards/lm3s6965evb.x"),
                ..FRAMEBUFFER
            },
            Self::Mps2An385 => FRAMEBUFFER,
            Self::Mps2An386 => Facts {
                name: "mps2-an386",
                core: Core::CortexM4F,
                memory: include_str!("../../../firmware/boards/mps2-an386.x"),
                ..FRAMEBUFFER
            },
            // A Cortex-M7 executes code for a Cortex-M4F.
            Self::Mps2An500 => Facts {
                name: "mps2-an500",
                core: Core::CortexM4F,
                memory: include_str!("../../../firmware/boards/mps2-an500.x"),
                ..FRAMEBUFFER
            },
            Self::Mps2An505 => Facts {
                name: "mps2-an505",
                core: Core::CortexM33,
                memory: include_str!("../../../firmware/boards/mps2-an505.x"),
                ..FRAMEBUFFER
            },
            Self::RiscvVirt => Facts {
                name: "riscv-virt",
                core: Core::RiscV,
                memory: include_str!("../../../firmware/boards/riscv-virt.x"),
                ..FRAMEBUFFER
            },
        }
    }

    /// The name on the command line, of the firmware's feature and of its program.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// The names of these boards, separated by commas.
    #[must_use]
    pub fn names(boards: impl IntoIterator<Item = Self>) -> String {
        boards.into_iter().map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// The target that its firmware is compiled for.
    #[must_use]
    pub const fn target(self) -> &'static str {
        self.facts().core.target()
    }

    /// The sizes that its firmware is built with.
    #[must_use]
    pub const fn budget(self) -> Budget {
        self.facts().budget
    }

    /// Width and height of its display.
    #[must_use]
    pub const fn size(self) -> (u32, u32) {
        let budget = self.budget();
        (budget.layout.width as u32, budget.height as u32)
    }

    /// The methods for which its firmware has room.
    #[must_use]
    pub const fn shaders(self) -> &'static [Shader] {
        self.facts().shaders
    }

    /// Whether its firmware has room for the method.
    #[must_use]
    pub fn has(self, shader: Shader) -> bool {
        self.shaders().contains(&shader)
    }

    /// Whether its firmware has room for labels: for fonts.
    #[must_use]
    pub const fn has_text(self) -> bool {
        self.facts().has_text
    }

    /// Whether it has memory for smooth outlines, so that there is a firmware that draws them.
    #[must_use]
    pub const fn smooths(self) -> bool {
        self.facts().smooths
    }

    /// The value of a byte of the memory for streams before anything is written there: erased flash, but QEMU begins with zeros.
    #[must_use]
    pub const fn blank(self) -> u8 {
        self.facts().blank
    }

    /// The board's pixel format.
    #[must_use]
    pub const fn format(self) -> Format {
        self.facts().format
    }

    /// Bytes that a stream may have, as the board's linker script says.
    #[must_use]
    pub fn room(self) -> Option<usize> {
        let line = self.facts().memory.lines().find(|line| line.trim_start().starts_with("STREAM"))?;
        let length = line.split("LENGTH =").nth(1)?.trim();
        let unit = match length.chars().last()? {
            'K' => 1 << 10,
            'M' => 1 << 20,
            _ => return None,
        };
        length.get(..length.len() - 1)?.parse::<usize>().ok()?.checked_mul(unit)
    }
}

impl fmt::Display for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Board {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
