//! What each board's memory is spent on. The host simulator includes this file, so both sides render with the same.

/// Sizes of a board's picture and of the renderer's memory.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// Rows drawn at once: more rows take more memory, fewer rows more time.
    pub rows: usize,
    /// Transformed vertices that are kept.
    pub vertices: usize,
    /// Triangles that are binned.
    pub triangles: usize,
    /// Materials that a stream may have.
    pub materials: usize,
    /// Triangles that one band hands on to the next: those beyond are set up anew there.
    pub legs: usize,
}

impl Budget {
    /// Pixels of a band: the size of its depth buffer and of each pixel buffer.
    #[must_use]
    pub const fn band(&self) -> usize {
        self.width * self.rows
    }
}

/// ST7789 panel; all of it stays within 128 KiB, half of what the RP2040 has.
pub const PICO: Budget = Budget { width: 240, height: 240, rows: 36, vertices: 1024, triangles: 1024, materials: 4, legs: 48 };
/// OLED; 64 KiB of RAM in all.
pub const LM3S6965EVB: Budget = Budget { width: 128, height: 64, rows: 16, vertices: 640, triangles: 1024, materials: 2, legs: 32 };
/// Frame buffer in plentiful RAM, one band for the whole picture.
pub const MPS2: Budget = Budget { width: 320, height: 240, rows: 240, vertices: 16384, triangles: 32768, materials: 16, legs: 0 };
