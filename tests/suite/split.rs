//! Methods that split triangles: they cover what the others cover, pixel by pixel. What they shade: see `arithmetic`.

use embedded_graphics::{
    pixelcolor::Gray8,
    prelude::{GrayColor, Size},
};
use microphong::{
    Counts, Stats,
    format::RAMP,
    geometry::{
        cull::Extent,
        projection::{ScreenVertex, State},
        viewport::Bounds,
    },
    interpolate::{Constant, plane::Plane},
    lighting::{
        material_tables::MaterialTables,
        reflectance::{LitMaterial, Reflectance},
    },
    method::Uniform,
    raster::{
        active::ActiveTriangles,
        band::Band,
        canvas::{BandCanvas, Canvas, Colourist, Shaded},
        pixel_shader::Solid,
        triangle::{ScreenTriangle, turned},
    },
    setup::gradients::Gradients,
};
use microphong_literature::sub_triangle::{ScreenSubTriangle, SubTriangle};
use microphong_sim::{level, render, scene, shader::Shader, stress::random::Random};
use microphong_tests::{cases, named, seed};
use zerocopy::FromZeros;

const SPLITTING: [&str; 4] = ["gouraud4", "pseudo-phong", "six-point-centre", "six-point-adaptive"];

const WIDTH: usize = 96;
const HEIGHT: usize = 80;

/// Data that all parts of a triangle share.
struct Whole<'a> {
    screen: &'a ScreenTriangle<'a>,
    gradients: &'a Gradients,
    depth: Plane<1>,
}

impl Whole<'_> {
    /// Draws `part`, or its own parts until they are of this `level`: all of them, or by chance.
    fn draw(&self, part: &SubTriangle, level: u32, random: &mut Option<&mut Random>, canvas: &mut dyn Canvas) -> u32 {
        let place = ScreenSubTriangle::new(self.screen, part);
        if !place.meets(canvas) {
            return 0;
        }
        if part.level() == level || random.as_mut().is_some_and(|random| random.pick(0..3) == 0) {
            let mut shaded = Shaded::new(Constant, Uniform([0; 3]));
            return place.draw(place.gradients(self.gradients).row(), self.depth, &mut shaded, canvas);
        }
        part.split().iter().map(|part| self.draw(part, level, random, canvas)).sum()
    }
}

#[test]
fn parts_of_random_triangles_cover_each_pixel_once() {
    let mut random = Random::new(seed(), 0);
    let (w, h) = (WIDTH as i32 * 16, HEIGHT as i32 * 16);
    let (mut triangles, mut covered) = (0, 0u64);
    // Every level is the same colour.
    let reflectance = Reflectance::new_zeroed();
    let tables = MaterialTables::<Gray8> { ramps: &[[1; RAMP]], reflectance: &LitMaterial::new(&reflectance, None) };
    let cases = cases(12_000) as usize;
    for i in 0..cases {
        let corners = match i % 5 {
            0 => [0; 3].map(|_| [random.pick(0..w), random.pick(0..h)]),
            1 => {
                let (x, y) = (random.pick(0..w), random.pick(0..h));
                [0; 3].map(|_| [x + random.pick(-90..90), y + random.pick(-90..90)])
            }
            2 => [0; 3].map(|_| [random.pick(-w..2 * w), random.pick(-h..2 * h)]),
            3 => [0; 3].map(|_| [random.pick(-65_536..65_536), random.pick(-65_536..65_536)]),
            // Corners, and with them many corners of parts, on pixel centres.
            _ => [0; 3].map(|_| [random.pick(-4..100) * 16 + 8, random.pick(-4..84) * 16 + 8]),
        };
        let [a, b, c] = corners.map(|[x, y]| ScreenVertex { x, y, depth: 1 << 27, light: [0; 4], state: State::READY });
        let corners = if Extent::new(corners).area < 0 { [&a, &c, &b] } else { [&a, &b, &c] };
        let (_, corners) = turned(corners);
        let nowhere = ScreenTriangle::new(corners, [0, WIDTH as i32], [0; 2]);
        let visible = Bounds::new(&Extent::new(nowhere.corners())).clipped(Bounds::whole(w / 16, h / 16)).sides();
        let Some(gradients) = Gradients::new(nowhere.corners(), visible) else { continue };
        let whole = Whole { screen: &nowhere, gradients: &gradients, depth: nowhere.plane(&gradients, 0) };
        let mut pictures = [[Gray8::BLACK; WIDTH * HEIGHT]; 2];
        let mut drawn = [0; 2];
        let rows = [HEIGHT, 7, 16, 1][i % 4];
        // The same splits in every band.
        let splits = random.bits();
        for top in (0..HEIGHT).step_by(rows) {
            let rows = rows.min(HEIGHT - top);
            for (k, picture) in pictures.iter_mut().enumerate() {
                let mut depth_rows = vec![0u16; rows * WIDTH];
                let mut pixels = vec![Gray8::BLACK; rows * WIDTH];
                let mut band = Band {
                    pixels: &mut pixels,
                    depth: &mut depth_rows,
                    width: WIDTH,
                    top: top as i32,
                    rows: rows as i32,
                    active: ActiveTriangles::default(),
                    counts: Counts::default(),
                    sheet: Default::default(),
                };
                drawn[k] += if k == 0 {
                    let screen = ScreenTriangle::new(corners, [0, WIDTH as i32], [top, top + rows].map(|row| row as i32));
                    screen.draw(&gradients, Constant, Solid::<Gray8>::new([1; 2]), &mut band)
                } else {
                    let mut chance = Random::new(splits, 0);
                    let mut chance = (i % 3 > 0 && rows == HEIGHT).then_some(&mut chance);
                    let colourist = Colourist::new(tables, false, None);
                    let mut canvas = BandCanvas { band: &mut band, colourist: &colourist };
                    whole.draw(&SubTriangle::WHOLE, (i % 7) as u32, &mut chance, &mut canvas)
                };
                picture[top * WIDTH..][..rows * WIDTH].copy_from_slice(&pixels);
            }
        }
        // As many pixels as the triangle has, all of them: so none twice.
        assert!(pictures[0] == pictures[1], "triangle {i}");
        assert_eq!(drawn[0], drawn[1], "triangle {i}");
        triangles += 1;
        covered += u64::from(drawn[0]);
    }
    println!("{triangles} triangles, {covered} pixels");
    assert!(triangles > cases / 12 * 11);
}

#[test]
fn parts_cover_what_triangles_cover() {
    for name in scene::NAMES {
        let scene = scene::load(name).unwrap();
        let (width, height) = scene.size;
        for number in [0, 63] {
            let draw = |shader| {
                let (stream, size) = (scene.stream.parse().unwrap(), Size::new(width, height));
                let picture = level::picture(stream, size, shader, number).unwrap();
                let covered: Vec<bool> = picture.iter().map(Option::is_some).collect();
                let (_, stats) = render::frame::<Gray8>(stream, size, shader, 16, number).unwrap();
                // What is left out differs from method to method.
                (covered, Stats { counts: Counts::default(), ..stats })
            };
            let gouraud = draw(Shader::GOURAUD);
            for shader in SPLITTING.map(named) {
                // The number of pixels counts those that are hidden later, and any that were drawn twice.
                assert!(draw(shader) == gouraud, "{name}, {}, frame {number}", shader.name());
            }
        }
    }
}
