//! Drawing over a picture, band by band, gives the result of drawing on a display that shows the picture, wherever the picture lies on it. Drawing
//! under a picture gives the result of a background.

use embedded_graphics::{
    image::{Image, ImageRaw},
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    pixelcolor::{BinaryColor, Gray4, Rgb565, raw::BigEndian},
    prelude::*,
    primitives::{Circle, Line, PrimitiveStyle, PrimitiveStyleBuilder, Rectangle, RoundedRectangle, StyledDrawable},
    text::{Alignment, Text},
};
use embedded_graphics_simulator::SimulatorDisplay;
use microphong::{
    BandTarget, Layout, Picture, RenderError, Renderer,
    format::Share,
    pixel::{FromDrawn, Light, LightGray, Pixel, Rgb565Be},
    stream::record::{LEFT, Label, MIDDLE, RIGHT},
};
use microphong_sim::{records::label, scene, script, shader::Shader};
use std::{convert::Infallible, fmt::Debug, thread};

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

fn over<C, F>(dark: F, bright: F)
where
    C: Pixel + From<F>,
    F: FromDrawn<C> + PixelColor + From<BinaryColor> + Debug,
{
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    for rows in [1, 7, 16, 64] {
        let layout = Layout::new(SIZE.width as usize, rows).vertices(stream.vertices.len()).triangles(stream.triangles.len());
        let mut memory = vec![0; layout.words::<C>()];
        let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
        let mut band = vec![C::from(dark); layout.band()];
        let [mut expected, mut drawn] = [(); 2].map(|()| SimulatorDisplay::<F>::with_default_color(SIZE, dark));
        let Ok(before) = Picture::new(&mut renderer, &mut band, 3).expect("a band").shown_as::<F>().draw(&mut expected);
        gauge(&mut expected, dark, bright);
        let picture = Picture::new(&mut renderer, &mut band, 3).expect("a band").shown_as::<F>();
        let Ok(stats) = picture.over(|band: &mut BandTarget<'_, C, F>| gauge(band, dark, bright)).draw(&mut drawn);
        assert_eq!(stats, before);
        assert_eq!(drawn.diff(&expected).map(|_| ()), None, "{rows} rows");
    }
}

#[test]
fn drawing_over_bands_is_drawing_over_the_picture() {
    over::<Rgb565, _>(Rgb565::new(2, 4, 6), Rgb565::YELLOW);
    over::<Light<5, 6, 5>, _>(Rgb565::new(2, 4, 6), Rgb565::YELLOW);
    over::<LightGray<1>, _>(BinaryColor::Off, BinaryColor::On);
}

/// A display that begins at any pixel, and knows which pixels were drawn.
struct Recorder {
    area: Rectangle,
    pixels: Vec<Option<Rgb565>>,
}

impl Recorder {
    fn new(area: Rectangle) -> Self {
        Self { area, pixels: vec![None; (area.size.width * area.size.height) as usize] }
    }

    fn drawn(&self, area: Rectangle) -> Vec<Option<Rgb565>> {
        let at = |point: Point| {
            let Point { x, y } = point - self.area.top_left;
            self.pixels[(y as u32 * self.area.size.width + x as u32) as usize]
        };
        area.points().map(at).collect()
    }
}

impl Dimensions for Recorder {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl DrawTarget for Recorder {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics::Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for embedded_graphics::Pixel(point, color) in pixels {
            assert!(self.area.contains(point), "{point} is drawn beyond {:?}", self.area);
            let Point { x, y } = point - self.area.top_left;
            self.pixels[(y as u32 * self.area.size.width + x as u32) as usize] = Some(color);
        }
        Ok(())
    }
}

/// A picture draws all of its own pixels and all that lies over it, and no others.
#[test]
fn pictures_lie_anywhere_on_the_display() {
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    let layout = Layout::new(SIZE.width as usize, 7).with_room_for(&stream);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
    let mut band = vec![Rgb565::BLACK; layout.band()];
    let whole = Rectangle::new(Point::zero(), SIZE);
    let [mut alone, mut with_lines] = [(); 2].map(|()| Recorder::new(whole));
    let lines = |corner: Point| {
        move |band: &mut BandTarget<'_, Rgb565>| {
            let [from, to] = [Point::new(-9, 3), Point::new(300, 70)].map(|point| point + corner);
            let Ok(()) = Line::new(from, to).draw_styled(&PrimitiveStyle::with_stroke(Rgb565::CYAN, 3), band);
        }
    };
    let Ok(_) = Picture::new(&mut renderer, &mut band, 3).expect("a band").draw(&mut alone);
    let Ok(_) = Picture::new(&mut renderer, &mut band, 3).expect("a band").over(lines(Point::zero())).draw(&mut with_lines);
    for start in [Point::zero(), Point::new(-40, 1000)] {
        let display = Rectangle::new(start, Size::new(200, 90));
        for offset in [Point::zero(), Point::new(104, 26), Point::new(104, 0), Point::new(37, 11)] {
            let corner = start + offset;
            let (mut drawn, mut both) = (Recorder::new(display), Recorder::new(display));
            let Ok(_) = Picture::new(&mut renderer, &mut band, 3).expect("a band").at(corner, &drawn).expect("a place").draw(&mut drawn);
            let picture = Picture::new(&mut renderer, &mut band, 3).expect("a band").over(lines(corner));
            let Ok(_) = picture.at(corner, &both).expect("a place").draw(&mut both);
            let area = Rectangle::new(corner, SIZE);
            for (display, expected) in [(&drawn, &alone), (&both, &with_lines)] {
                assert_eq!(display.drawn(area), expected.pixels, "at {corner}");
                assert_eq!(display.pixels.iter().flatten().count(), expected.pixels.len(), "at {corner}: pixels beside the picture");
            }
        }
        for offset in [Point::new(105, 0), Point::new(0, 27), Point::new(-1, 0), Point::new(0, -1), Point::new(i32::MAX - 1000, 0)] {
            let corner = start + offset;
            let place = Picture::new(&mut renderer, &mut band, 3).expect("a band").at(corner, &display).map(drop);
            assert_eq!(place, Err(RenderError::Corner));
            assert!(place.unwrap_err().to_string().contains("beyond the display; move it"));
        }
    }
    let small = Rectangle::new(Point::zero(), Size::new(95, 64));
    assert!(Picture::new(&mut renderer, &mut band, 3).expect("a band").at(Point::zero(), &small).is_err(), "a display too small");
}

/// Width of a stripe.
const STRIPE: i32 = 5;

/// Stripes of two colours, slanting down to the right.
fn is_bright(point: Point) -> bool {
    (point.x + point.y).div_euclid(STRIPE) % 2 == 0
}

fn stripes<D: DrawTarget<Error = Infallible>>(target: &mut D, [dark, bright]: [D::Color; 2]) {
    let points = Rectangle::new(Point::zero(), SIZE).points();
    let Ok(()) = target.draw_iter(points.map(|point| embedded_graphics::Pixel(point, if is_bright(point) { bright } else { dark })));
}

/// Each pixel over stripes equals the pixel over a background of the stripe's colour, at antialiased edges as well unless a neighbour has the other
/// colour.
fn under<C, F>(antialias: bool, dither: bool)
where
    C: Pixel + From<F> + Send + Sync,
    F: FromDrawn<C> + PixelColor + Debug + Send + Sync,
{
    let scene = scene::load("torus").expect("a built-in scene");
    let smooth = scene.stream.with_neighbours().expect("neighbours");
    let stream = smooth.parse().expect("a stream");
    // Each channel's bits are those of the format, or none.
    let colours = [[0, 255, 0], [255, 0, 255]];
    let packed = colours.map(|colour| {
        let [dr, dg, db] = F::DEPTH;
        let luma = (u32::from(colour[0]) * 77 + u32::from(colour[1]) * 150 + u32::from(colour[2]) * 29) >> 8;
        let [r, g, b] = if F::GRAY { [luma; 3] } else { colour.map(u32::from) };
        F::pack([r >> (8 - dr), g >> (8 - dg), b >> (8 - db)])
    });
    for rows in [1, 7, 64] {
        let layout = Layout::new(SIZE.width as usize, rows).with_room_for(&stream).antialias(antialias).processors(2);
        let mut memory = vec![0; layout.words::<C>()];
        let mut renderer = Renderer::<C>::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
        renderer.set_dither(dither);
        renderer.set_antialias(antialias).expect("room");
        let mut band = vec![C::from(packed[0]); layout.band()];
        let whole = Rectangle::new(Point::zero(), SIZE);
        let [dark, bright] = colours.map(|colour| {
            renderer.scene().set_background(colour);
            let mut display = SimulatorDisplay::<F>::with_default_color(SIZE, packed[0]);
            let Ok(_) = Picture::of_scene(&mut renderer, &mut band).expect("a band").shown_as::<F>().draw(&mut display);
            display
        });
        let of = |point: Point| if is_bright(point) { bright.get_pixel(point) } else { dark.get_pixel(point) };
        let beside = |point: Point| [(0, -1), (0, 1), (-1, 0), (1, 0)].map(|(x, y)| point + Point::new(x, y));
        let is_alone = |point: Point| !antialias || beside(point).into_iter().all(|other| is_bright(other) == is_bright(point));
        let known: Vec<_> = whole.points().map(is_alone).collect();
        let expected: Vec<_> = whole.points().map(of).collect();
        let equal = |shown: &[F]| known.iter().zip(shown.iter().zip(&expected)).all(|(known, (a, b))| !known || a == b);
        assert!(whole.points().any(|point| dark.get_pixel(point) == bright.get_pixel(point)), "there is an object");

        let mut display = SimulatorDisplay::<F>::with_default_color(SIZE, packed[0]);
        let picture = Picture::of_scene(&mut renderer, &mut band).expect("a band").shown_as::<F>().under(|band| stripes(band, packed));
        let Ok(_) = picture.draw(&mut display);
        let shown: Vec<_> = whole.points().map(|point| display.get_pixel(point)).collect();
        assert!(equal(&shown), "{rows} rows");

        // Two processors, as firmware with DMA draws: bands are handed on, and no display is drawn to.
        let mut frame = renderer.draw().in_two(30);
        let parts = thread::scope(|threads| {
            let draw = |mut part: microphong::FramePart<'_, '_, C>| {
                let (mut band, mut pixels) = (vec![C::from(packed[0]); layout.band()], Vec::new());
                let under = |pixels: &mut [C], area| stripes(&mut BandTarget::<C, F>::new(pixels, area), packed);
                while let Some(area) = part.next_band_over(&mut band, under).expect("a row") {
                    pixels.extend(part.output().pixels::<C, F>(&band, area));
                }
                pixels
            };
            frame.parts().map(|part| threads.spawn(move || draw(part))).map(|thread| thread.join().expect("a part"))
        });
        assert!(parts.iter().all(|part| !part.is_empty()), "both draw");
        assert!(parts.concat() == shown, "{rows} rows, two processors");
    }
}

#[test]
fn what_is_under_a_picture_is_its_background() {
    for antialias in [false, true] {
        under::<Rgb565, Rgb565>(antialias, false);
        under::<Rgb565, Rgb565>(antialias, true);
        under::<Rgb565Be, Rgb565Be>(antialias, false);
        under::<Light<5, 6, 5>, Rgb565Be>(antialias, true);
        under::<LightGray<4>, Gray4>(antialias, true);
    }
}

/// If nothing is drawn under a picture, the background of the scene is seen, in every band.
#[test]
fn nothing_under_a_picture_is_its_background() {
    let scene = scene::load("torus").expect("a built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    let layout = Layout::new(SIZE.width as usize, 7).with_room_for(&stream);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
    let mut band = vec![Rgb565::BLACK; layout.band()];
    let [mut expected, mut drawn] = [(); 2].map(|()| SimulatorDisplay::<Rgb565>::new(SIZE));
    let Ok(_) = Picture::new(&mut renderer, &mut band, 3).expect("a band").draw(&mut expected);
    let Ok(_) = Picture::new(&mut renderer, &mut band, 3).expect("a band").under(|_| ()).draw(&mut drawn);
    assert_eq!(drawn.diff(&expected).map(|_| ()), None);
}

/// A torus, and these labels over it.
fn labelled(labels: Vec<Label>) -> microphong_sim::bytes::StreamBytes {
    let text = "
        frames = 1
        [camera]
        at = [0, 0, 5]
        [[mesh]]
        name = \"ring\"
        shape = \"torus\"
        [[object]]
        mesh = \"ring\"";
    let (bytes, _) = script::stream(text, None).expect("a scene");
    let stream = bytes.parse().expect("a stream");
    let header = microphong::stream::record::Header { labels: labels.len() as u8, ..*stream.header };
    // Names follow the labels.
    let records = size_of_val(&header)..bytes.as_bytes().len() - stream.names.len();
    let mut all = [zerocopy::IntoBytes::as_bytes(&header), &bytes.as_bytes()[records]].concat();
    labels.iter().for_each(|label| all.extend_from_slice(zerocopy::IntoBytes::as_bytes(label)));
    all.extend_from_slice(stream.names);
    let length = all.len() as u32;
    all[8..12].copy_from_slice(&length.to_le_bytes());
    microphong::stream::seal(&mut all);
    all.as_slice().into()
}

/// Labels are the texts that embedded-graphics draws, at the same share of pictures of any size, in the largest font that is not too high.
#[test]
fn labels_lie_over_the_picture() {
    use embedded_graphics::{
        mono_font::iso_8859_1::{FONT_4X6, FONT_6X10, FONT_7X13, FONT_9X15, FONT_10X20},
        text::{Baseline, TextStyleBuilder},
    };
    let share = |value: f64| Share::from_num(value);
    let labels = [
        label([share(0.0), share(0.0)], share(0.16), [255, 255, 0], MIDDLE, b"12 \xB0C"),
        label([share(-0.75), share(-0.4)], share(0.25), [0, 0, 255], LEFT, b"left"),
        label([share(0.75), share(0.4)], share(0.1), [255, 255, 255], RIGHT, b"right"),
        // Beyond every side.
        label([share(-7.9), share(7.9)], share(0.1), [255; 3], RIGHT, b"nowhere"),
        label([share(0.75), share(0.5)], share(0.15), [255; 3], MIDDLE, b"over the edge"),
        // Left out of small pictures.
        label([share(-0.2), share(0.3)], share(0.07), [0, 255, 255], LEFT, b"small"),
    ];
    let fonts = |height: u32| match height {
        64 => [&FONT_6X10, &FONT_9X15, &FONT_4X6, &FONT_4X6, &FONT_6X10].map(Some).into_iter().chain([None]).collect::<Vec<_>>(),
        _ => [&FONT_10X20; 5].into_iter().chain([&FONT_7X13]).map(Some).collect(),
    };
    let [plain, bytes] = [labelled(Vec::new()), labelled(labels.to_vec())];
    let [plain, with_labels] = [&plain, &bytes].map(|bytes| bytes.parse().expect("a stream"));
    for (size, rows) in [(Size::new(96, 64), 1), (Size::new(96, 64), 7), (Size::new(96, 64), 64), (Size::new(310, 201), 40)] {
        let [mut expected, drawn] = [plain, with_labels].map(|stream| {
            let layout = Layout::new(size.width as usize, rows).with_room_for(&stream);
            let mut memory = vec![0; layout.words::<Rgb565>()];
            let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, Shader::PHONG.on()).expect("a renderer");
            let mut band = vec![Rgb565::BLACK; layout.band()];
            let mut display = SimulatorDisplay::<Rgb565>::new(size);
            let Ok(_) = Picture::new(&mut renderer, &mut band, 0).expect("a band").draw(&mut display);
            display
        });
        for (label, font) in labels.iter().zip(fonts(size.height)) {
            let Some(font) = font else { continue };
            let side = f64::from(size.width.min(size.height));
            let place = |share: Share, whole: u32| (f64::from(share) * side + f64::from(whole) / 2.0 + 0.5).floor() as i32;
            let [x, y] = label.position();
            let alignment = [Alignment::Left, Alignment::Center, Alignment::Right][usize::from(label.alignment)];
            let style = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
            let [r, g, b] = label.colour;
            let ink = MonoTextStyle::new(font, Rgb565::new(r >> 3, g >> 2, b >> 3));
            let text: String = label.characters().collect();
            let position = Point::new(place(x, size.width), place(y, size.height));
            let Ok(_) = Text::with_text_style(&text, position, ink, style).draw(&mut expected);
        }
        assert_eq!(drawn.diff(&expected).map(|_| ()), None, "{size}, {rows} rows");
    }
}

#[test]
fn what_is_no_label_is_refused() {
    let good = label([Share::ZERO; 2], Share::from_num(0.1), [255; 3], MIDDLE, b"12 V");
    let text = |text: &[u8]| label([Share::ZERO; 2], Share::from_num(0.1), [255; 3], MIDDLE, text);
    let hole = Label {
        text: {
            let mut text = good.text;
            text[1] = 0;
            text
        },
        ..good
    };
    let faults = [
        text(b""),
        text(b"1\n2"),
        text(b"1\x7F"),
        text(b"\x9F"),
        hole,
        Label { height: 0, ..good },
        Label { height: -1, ..good },
        Label { alignment: RIGHT + 1, ..good },
    ];
    for label in faults {
        let bytes = labelled(vec![good, label]);
        assert_eq!(
            bytes.parse().err().map(|error| error.to_string()),
            Some("label of record 1 is out of range; convert the mesh again".to_owned()),
            "{label:?}"
        );
    }
    assert!(labelled(vec![good, text(&[b'~'; 30]), text(b" \xA0\xFF")]).parse().is_ok());
}
