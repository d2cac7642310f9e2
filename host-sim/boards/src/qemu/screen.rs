//! Reads a board's display: the OLED that QEMU draws, or a frame buffer in memory.

use super::{Board, Elf, Qmp, Scratch};
use anyhow::{Context, Result, ensure};
use serde_json::json;
use std::io::Cursor;

/// The place of the picture in the emulator.
pub(super) enum Screen {
    /// Drawn by QEMU, every pixel four times as wide and high.
    Oled,
    /// Two bytes a pixel at this address.
    Memory { address: u32, size: u32 },
}

/// QEMU's enlargement of the OLED.
const SCALE: u32 = 4;
/// Brightness of a grey on QEMU's screen: 15 becomes 255.
const GREY: u32 = 17;

impl Screen {
    pub(super) fn of(board: Board, elf: &Elf) -> Result<Self> {
        if board == Board::Lm3s6965evb {
            return Ok(Self::Oled);
        }
        let (address, size) = elf.symbol("FRAMEBUFFER")?;
        let (width, height) = board.size();
        ensure!(size == 2 * width * height, "FRAMEBUFFER has {size} bytes, not {width} x {height} x 2");
        Ok(Self::Memory { address, size })
    }

    /// The current pixels.
    pub(super) fn picture(&self, qmp: &mut Qmp) -> Result<Vec<u32>> {
        match *self {
            Self::Oled => {
                let file = Scratch::new(&[])?;
                qmp.command("screendump", &json!({ "filename": file.path().to_string_lossy(), "format": "png" }))?;
                read_oled(&file.read()?).context("QEMU's picture of the OLED")
            }
            Self::Memory { address, size } => {
                let bytes = qmp.memory(address, size)?;
                Ok(bytes.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]).into()).collect())
            }
        }
    }
}

/// Undoes the enlargement; all samples of a pixel must agree.
fn read_oled(file: &[u8]) -> Result<Vec<u32>> {
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info()?;
    let mut samples = vec![0; reader.output_buffer_size().context("a picture too large")?];
    let info = reader.next_frame(&mut samples)?;
    let (width, height) = Board::Lm3s6965evb.size();
    ensure!((info.width, info.height) == (width * SCALE, height * SCALE), "it has {} x {} pixels", info.width, info.height);
    ensure!(info.bit_depth == png::BitDepth::Eight, "it does not have 8 bits per channel");
    let channels = info.color_type.samples();
    let at = |x: u32, y: u32| &samples[y as usize * info.line_size + x as usize * channels..][..channels];
    let pixel = |x: u32, y: u32| {
        let value = u32::from(at(x * SCALE, y * SCALE)[0]);
        let agree = (0..SCALE * SCALE).all(|i| at(x * SCALE + i % SCALE, y * SCALE + i / SCALE).iter().all(|&s| u32::from(s) == value));
        ensure!(agree && value % GREY == 0, "pixel {x}, {y} is not one of 16 greys");
        Ok(value / GREY)
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
}
