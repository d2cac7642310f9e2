//! Methods that split triangles: they cover what the others cover, pixel by pixel. What they shade: see `arithmetic`.

use embedded_graphics::{pixelcolor::Gray8, prelude::Size};
use microphong::{
    Shader,
    band::Band,
    cull::Extent,
    poly::{Constant, basis::Basis},
    raster::{
        cell::Cell,
        smooth::Part,
        triangle::{Bounds, Outline},
    },
    relay::Relay,
    tone::Solid,
    vertex::{ScreenVertex, State},
};
use microphong_sim::{level, render, scene};
use proptest::{
    prelude::Rng,
    test_runner::{RngAlgorithm, TestRng},
};
use std::ops::Range;

const SPLITTING: [Shader; 4] = [Shader::Gouraud4, Shader::PseudoPhong, Shader::SixPointCentre, Shader::SixPointAdaptive];

const WIDTH: usize = 96;
const HEIGHT: usize = 80;

struct Random(TestRng);

impl Random {
    fn pick(&mut self, range: Range<i32>) -> i32 {
        range.start + (self.0.next_u64() % (range.end - range.start) as u64) as i32
    }
}

/// Draws `cell`, or its parts if it is split `depth` times more: all of them, or by chance.
fn draw(outline: &Outline, cell: &Cell, depth: u32, random: &mut Option<&mut Random>, whole: &Shared<'_>, band: &mut Band<'_, u8>) -> u32 {
    let piece = outline.piece(cell);
    if !piece.meets(band) {
        return 0;
    }
    if depth == 0 || random.as_mut().is_some_and(|random| random.pick(0..3) == 0) {
        return piece.draw(&piece.basis(whole.basis), *whole.depth, Constant, Solid(1), band);
    }
    cell.split().iter().map(|part| draw(outline, part, depth - 1, random, whole, band)).sum()
}

struct Shared<'a> {
    basis: &'a microphong::poly::basis::Basis,
    depth: &'a microphong::poly::plane::Plane<1>,
}

#[test]
fn cells_of_random_triangles_cover_each_pixel_once() {
    let mut random = Random(TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]));
    let (w, h) = (WIDTH as i32 * 16, HEIGHT as i32 * 16);
    let (mut triangles, mut covered) = (0, 0u64);
    for i in 0..12_000 {
        let corners = match i % 5 {
            0 => [0; 3].map(|_| [random.pick(0..w), random.pick(0..h)]),
            1 => {
                let (x, y) = (random.pick(0..w), random.pick(0..h));
                [0; 3].map(|_| [x + random.pick(-90..90), y + random.pick(-90..90)])
            }
            2 => [0; 3].map(|_| [random.pick(-w..2 * w), random.pick(-h..2 * h)]),
            3 => [0; 3].map(|_| [random.pick(-65_536..65_536), random.pick(-65_536..65_536)]),
            // Corners, and with them many corners of cells, on pixel centres.
            _ => [0; 3].map(|_| [random.pick(-4..100) * 16 + 8, random.pick(-4..84) * 16 + 8]),
        };
        let [a, b, c] = corners.map(|[x, y]| ScreenVertex { x, y, depth: 1 << 27, light: [0; 3], state: State::Ready });
        let corners = if Extent::new(corners).area < 0 { [&a, &c, &b] } else { [&a, &b, &c] };
        let nowhere = Band::<u8> { pixels: &mut [], depth: &mut [], width: WIDTH, top: 0, rows: 0, blend: None, relay: Relay::default() };
        let outline = Outline::new(corners, Part::Centres, &nowhere);
        let Some(basis) = Basis::new(outline.corners, Bounds::new(&Extent::new(outline.corners)).clipped(w / 16, h / 16).sides()) else {
            continue;
        };
        let depth = outline.depth(&basis);
        let mut pictures = [[0u8; WIDTH * HEIGHT]; 2];
        let mut drawn = [0; 2];
        let rows = [HEIGHT, 7, 16, 1][i % 4];
        // The same splits in every band.
        let seed = random.0.next_u64().to_le_bytes();
        for top in (0..HEIGHT).step_by(rows) {
            let rows = rows.min(HEIGHT - top);
            for (k, picture) in pictures.iter_mut().enumerate() {
                let mut depth_rows = vec![0u16; rows * WIDTH];
                let mut pixels = vec![0u8; rows * WIDTH];
                let mut band = Band {
                    pixels: &mut pixels,
                    depth: &mut depth_rows,
                    width: WIDTH,
                    top: top as i32,
                    rows: rows as i32,
                    blend: None,
                    relay: Relay::default(),
                };
                drawn[k] += if k == 0 {
                    Outline::new(corners, Part::Centres, &band).draw(&basis, Constant, Solid(1), &mut band)
                } else {
                    let mut chance = Random(TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 4].concat()));
                    let mut chance = (i % 3 > 0 && rows == HEIGHT).then_some(&mut chance);
                    draw(&outline, &Cell::WHOLE, (i % 7) as u32, &mut chance, &Shared { basis: &basis, depth: &depth }, &mut band)
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
    assert!(triangles > 11_000);
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
                (covered, stats)
            };
            let gouraud = draw(Shader::Gouraud);
            for shader in SPLITTING {
                // The number of pixels counts those that are hidden later, and any that were drawn twice.
                assert!(draw(shader) == gouraud, "{name}, {}, frame {number}", shader.name());
            }
        }
    }
}
