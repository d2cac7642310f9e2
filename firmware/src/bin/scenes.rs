//! The scenes in colours of the boards in examples/, one after another in the corner of a frame buffer.
#![no_std]
#![no_main]

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use microphong::Stream;
use microphong_firmware::Display;
use scenes::*;

#[macro_use]
#[path = "../scenes.rs"]
mod scenes;

microphong_firmware::framebuffer_board!(|display| {
    macro_rules! show {
        ($name:literal, $scene:ident, |$renderer:ident, $band:ident| $picture:expr) => {{
            let Ok(()) = display.clear(Rgb565::BLACK);
            // On the stack, of which these boards have plenty.
            let mut memory = [0; $scene::LAYOUT.words::<Rgb565>()];
            let mut band = [Rgb565::BLACK; $scene::LAYOUT.band()];
            let stream = Stream::parse_included($scene::MESH).expect("a stream");
            let ($renderer, $band) = (&mut $scene::renderer(stream, &mut memory).expect("a renderer"), &mut band);
            let Ok(stats) = $picture.expect("a picture").draw(display);
            // The host reads this line: keep its form.
            defmt::info!("frame {=str} triangles {=u32}", $name, stats.drawn);
            let _ = display.finish();
        }};
    }
    each_scene!(show);
    display.end();
    defmt::unreachable!("the emulation has ended")
});
