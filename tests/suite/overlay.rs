//! What is drawn over a picture, band by band, is what is drawn on a display that shows the picture.

use embedded_graphics::{
    image::{Image, ImageRaw},
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    pixelcolor::{BinaryColor, Rgb565, raw::BigEndian},
    prelude::*,
    primitives::{Circle, Line, PrimitiveStyle, PrimitiveStyleBuilder, Rectangle, RoundedRectangle, StyledDrawable},
    text::{Alignment, Text},
};
use embedded_graphics_simulator::SimulatorDisplay;
use microphong::{BandTarget, Layout, Picture, Renderer, pixel::Pixel};
use microphong_sim::{scene, shader::Shader};
use std::{convert::Infallible, fmt::Debug};

const SIZE: Size = Size::new(96, 64);
const IMAGE: [u8; 32] = [0xF8; 32];

/// Shapes of all kinds, some of them partly or wholly outside of the picture.
fn gauge<D: DrawTarget<Error = Infallible>>(target: &mut D, dark: D::Color, bright: D::Color)
where
    D::Color: PixelColor + From<BinaryColor>,
{
    let style = MonoTextStyle::new(&FONT_6X10, bright);
    let Ok(_) = Text::with_alignment("12.3 V", Point::new(48, 12), style, Alignment::Center).draw(target);
    let Ok(_) = Text::new("over the edge", Point::new(60, 62), style).draw(target);
    let Ok(()) = Line::new(Point::new(-20, -7), Point::new(200, 90)).draw_styled(&PrimitiveStyle::with_stroke(bright, 2), target);
    let Ok(()) = Circle::new(Point::new(70, 20), 40).draw_styled(&PrimitiveStyle::with_stroke(dark, 3), target);
    let fill = PrimitiveStyleBuilder::new().fill_color(dark).stroke_color(bright).stroke_width(1).build();
    let bar = Rectangle::new(Point::new(4, 40), Size::new(30, 17));
    let Ok(()) = RoundedRectangle::with_equal_corners(bar, Size::new(4, 4)).draw_styled(&fill, target);
    for corner in [Point::new(-30_000, -30_000), Point::new(30_000, 3), Point::new(-5, 60)] {
        let Ok(()) = target.fill_solid(&Rectangle::new(corner, Size::new(12, 12)), bright);
        let Ok(()) = target.draw_iter([embedded_graphics::Pixel(corner, dark)]);
    }
    let image = ImageRaw::<BinaryColor, BigEndian>::new(&IMAGE, 16);
    let Ok(()) = Image::new(&image, Point::new(80, 4)).draw(&mut target.color_converted());
}

fn over<C: Pixel + PixelColor + From<BinaryColor> + Debug>(dark: C, bright: C) {
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    for rows in [1, 7, 16, 64] {
        let layout = Layout::new(SIZE.width as usize, rows).vertices(stream.vertices.len()).triangles(stream.triangles.len());
        let mut memory = vec![0; layout.words::<C>()];
        let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
        let mut band = vec![dark; layout.band()];
        let [mut expected, mut drawn] = [(); 2].map(|()| SimulatorDisplay::<C>::with_default_color(SIZE, dark));
        let Ok(before) = Picture::new(&mut renderer, &mut band, 3).expect("a band").draw(&mut expected);
        gauge(&mut expected, dark, bright);
        let picture = Picture::new(&mut renderer, &mut band, 3).expect("a band");
        let Ok(stats) = picture.over(|band: &mut BandTarget<'_, C>| gauge(band, dark, bright)).draw(&mut drawn);
        assert_eq!(stats, before);
        assert_eq!(drawn.diff(&expected).map(|_| ()), None, "{rows} rows");
    }
}

#[test]
fn drawing_over_bands_is_drawing_over_the_picture() {
    over(Rgb565::new(2, 4, 6), Rgb565::YELLOW);
    over(BinaryColor::Off, BinaryColor::On);
}
