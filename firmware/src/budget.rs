//! Sizes of each board's memory. The host simulator includes this file, so both render with the same sizes.

use microphong::Layout;

/// The height of a board's picture, and the renderer's memory.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Rows of the display.
    pub height: usize,
    /// The width of the picture, the rows of a band, and what the renderer has room for.
    pub layout: Layout,
}

/// ST7789 panel; all of it stays within 240 KiB of the 264 that the RP2040 has. It has room for a closed mesh of 3,776 triangles, which
/// has about 1,890 vertices. About half of its triangles face the viewer, and only these are in lists; both processors draw a frame if the lists have room
/// for twice as many. It has fewer tables of highlights than materials, because materials with equal highlights share one.
pub const PICO: Budget = Budget {
    height: 240,
    layout: Layout::new(240, 18)
        .processors(2)
        .vertices(1890)
        .triangles(3776)
        .materials(12)
        .highlight_tables(4)
        .objects(12)
        .active_triangles(113),
};
/// Sizes for the same panel with twice the room: all memory stays within 420 KiB of the 520 that the RP2350 has.
pub const PICO2: Budget =
    Budget { layout: PICO.layout.vertices(3780).triangles(7552).materials(24).highlight_tables(8).objects(24), ..PICO };
/// OLED; 64 KiB of RAM in all, of which the most demanding streams of the tests take up to 8.6 KB of stack.
pub const LM3S6965EVB: Budget = Budget { height: 64, layout: Layout::new(128, 16).vertices(448).materials(2).active_triangles(32) };
/// Frame buffer in plentiful RAM, one band for the whole picture; the edges are for firmware that draws smooth outlines.
pub const FRAMEBUFFER: Budget = Budget {
    height: 240,
    layout: Layout::new(320, 240).vertices(16384).triangles(32768).materials(16).objects(64).active_triangles(0).edges(4096),
};
