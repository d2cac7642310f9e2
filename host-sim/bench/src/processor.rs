//! Processors on which instructions are counted.

use microphong_boards::Board;

/// A processor that frames are measured on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Processor {
    /// On the board `mps2-an385`.
    CortexM3,
    /// On the board `mps2-an386`.
    CortexM4F,
    /// On the board `mps2-an500`. It executes what is compiled for the Cortex-M4F.
    CortexM7,
    /// On the board `mps2-an505`.
    CortexM33,
    /// On the board `riscv-virt`.
    RiscV,
    /// On the board `pico`.
    CortexM0Plus,
    /// Two Cortex-M33 on the board `pico2`.
    Rp2350,
    /// The host's.
    X86_64,
}

impl Processor {
    /// All processors that can be measured.
    pub const ALL: [Self; 8] =
        [Self::CortexM3, Self::CortexM4F, Self::CortexM7, Self::CortexM33, Self::RiscV, Self::CortexM0Plus, Self::Rp2350, Self::X86_64];

    /// The processor's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CortexM3 => "cortex-m3",
            Self::CortexM4F => "cortex-m4f",
            Self::CortexM7 => "cortex-m7",
            Self::CortexM33 => "cortex-m33",
            Self::RiscV => "risc-v",
            Self::CortexM0Plus => "cortex-m0plus",
            Self::Rp2350 => "rp2350",
            Self::X86_64 => "x86-64",
        }
    }

    /// The board that it sits on; `None` for the host's.
    #[must_use]
    pub const fn board(self) -> Option<Board> {
        match self {
            Self::CortexM3 => Some(Board::Mps2An385),
            Self::CortexM4F => Some(Board::Mps2An386),
            Self::CortexM7 => Some(Board::Mps2An500),
            Self::CortexM33 => Some(Board::Mps2An505),
            Self::RiscV => Some(Board::RiscvVirt),
            Self::CortexM0Plus => Some(Board::Pico),
            Self::Rp2350 => Some(Board::Pico2),
            Self::X86_64 => None,
        }
    }

    /// Its cycles in a second, where time is modelled.
    #[must_use]
    pub const fn clock(self) -> Option<f64> {
        match self {
            Self::CortexM0Plus => Some(125e6),
            Self::Rp2350 => Some(150e6),
            _ => None,
        }
    }

    /// The name on the command line: the board's; of the host its architecture.
    #[must_use]
    pub const fn board_name(self) -> &'static str {
        match self.board() {
            Some(board) => board.name(),
            None => self.name(),
        }
    }

    /// Width and height of the frame that is measured: the board's display, and on the host the display of the Cortex-M3's board.
    #[must_use]
    pub const fn size(self) -> (u32, u32) {
        match self.board() {
            Some(board) => board.size(),
            None => Board::Mps2An385.size(),
        }
    }
}
