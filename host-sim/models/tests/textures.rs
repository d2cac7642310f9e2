//! Textures of files become textures of the stream, where colours at corners do not give them.

mod common;

use common::{MTL, png, square, textured};
use microphong::stream::record::{HAS_COLOURS, HAS_TEXTURE, Texture};
use microphong_models::{
    bytes::StreamBytes,
    coat::{TextureSize, texture_corners},
    convert::{Converted, Options},
    import::{Colours, Rules},
    mesh::Rgb,
    vector::V3,
};
use std::fs;
use tempfile::TempDir;

/// A face: for each corner its position and its place in the texture.
type Face = Vec<(V3, [f64; 2])>;

const DARK: Rgb = [20, 30, 40];
const LIGHT: Rgb = [250, 240, 30];

/// A checkerboard of square fields.
fn chequered(fields: usize, pixels: usize) -> Vec<Vec<Rgb>> {
    let colour = |x: usize, y: usize| if (x / pixels + y / pixels).is_multiple_of(2) { LIGHT } else { DARK };
    (0..fields * pixels).map(|y| (0..fields * pixels).map(|x| colour(x, y)).collect()).collect()
}

/// The face moved to the right, with its places scaled and moved.
fn moved(face: Face, right: f64, scale: f64, offset: [f64; 2]) -> Face {
    face.into_iter().map(|([x, y, z], [u, v])| ([x + right, y, z], [scale * u + offset[0], scale * v + offset[1]])).collect()
}

/// A model of these files, converted.
fn converted(files: &[(&str, &[u8])], options: &Options) -> anyhow::Result<Converted> {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    Converted::read(&folder.path().join(files[0].0), options, &())
}

fn with_textures() -> Options {
    Options { rules: Rules { colours: Colours::Texture, ..Rules::default() }, ..Options::default() }
}

fn model(faces: &[Face], image: &[Vec<Rgb>], options: &Options) -> (Converted, StreamBytes) {
    let converted = converted(&[("a.obj", textured(faces).as_bytes()), ("a.mtl", MTL), ("a.png", &png(image))], options).unwrap();
    let bytes = converted.stream().unwrap();
    (converted, bytes)
}

/// For each triangle the positions of its corners, as x and y of the square, with their places in the texture.
fn places(bytes: &StreamBytes) -> Vec<[([i16; 2], [u16; 2]); 3]> {
    let stream = bytes.parse().unwrap();
    let of_mesh = stream.meshes.iter().flat_map(|mesh| {
        let (triangles, vertices) = (stream.triangles_of(mesh).unwrap(), stream.vertices_of(mesh).unwrap());
        let corners = stream.texture_of(mesh).map_or(&[][..], |texture| texture.corners);
        let at = |corner: u16| {
            let [x, y, _] = vertices[usize::from(corner)].position;
            [x, y].map(i16::signum)
        };
        triangles
            .iter()
            .zip(corners)
            .map(move |(triangle, corners)| [0, 1, 2].map(|k| (at(triangle.corners[k]), corners.0[k])))
            .collect::<Vec<_>>()
    });
    of_mesh.collect()
}

/// A square with a checkerboard has its texels, with row 0 at the top, and its corners those of the texture.
#[test]
fn a_checkerboard_is_kept_exactly() {
    let mut image = chequered(8, 1);
    image[0][1] = [1, 2, 3];
    let (converted, bytes) = model(&[square()], &image, &with_textures());
    let stream = bytes.parse().unwrap();
    let [mesh] = stream.meshes else { panic!("{} meshes", stream.meshes.len()) };
    assert!(mesh.flags & (HAS_TEXTURE | HAS_COLOURS) == HAS_TEXTURE && stream.corner_colours.is_empty());
    let texture = stream.texture_of(mesh).unwrap();
    assert_eq!((texture.size, texture.texels.len(), stream.textures().texels.len(), stream.colours.len()), ([3, 3], 64, 64, 3));
    let texels: Vec<Rgb> = texture.texels.iter().map(|&texel| texture.palette[usize::from(texel)].channels).collect();
    assert_eq!(texels, image.concat());
    for (position, place) in places(&bytes).concat() {
        assert_eq!(place, [if position[0] > 0 { 4096 } else { 0 }, if position[1] > 0 { 0 } else { 4096 }], "{position:?}");
    }
    let painted = converted.painted;
    let textures = painted.textures.unwrap();
    assert!(painted.triangles == 0 && painted.lost_materials == 1 && painted.lost_area > 0.5 && painted.split == 0);
    assert_eq!((textures.triangles, &textures.sizes[..], textures.bytes), (2, &[[8, 8]][..], 64 + 4 + 3 * 4));
    assert_eq!((textures.rms, textures.lost_area, textures.repeating, textures.multiplied), (0.0, 0.0, 0, 0));
    assert_eq!(
        converted.remarks,
        [
            "2 triangles have 1 texture of 8x8 texels, 80 bytes: 0 % of the area is farther than 24 of 255 from the file, the root of the mean square is 0.0"
        ]
    );
}

/// A texture of MTL says where a material sends out light, which becomes one for all of it: the mean, or what the colours make most like it.
#[test]
fn light_of_mtl_is_that_of_its_texture() {
    let red_and_black = png(&[vec![[255, 0, 0], [0; 3]]]);
    let (white_and_black, grey) = (png(&[vec![[255; 3], [0; 3]]]), png(&[vec![[51; 3]]]));
    let of = |text: &str, mtl: &str, rules: Rules| {
        let mtl = format!("newmtl paint\n{mtl}");
        let files: [(&str, &[u8]); 5] = [
            ("a.obj", text.as_bytes()),
            ("a.mtl", mtl.as_bytes()),
            ("red.png", &red_and_black),
            ("white.png", &white_and_black),
            ("grey.png", &grey),
        ];
        let Converted { materials, remarks, .. } = converted(&files, &Options { rules, ..Options::default() }).unwrap();
        let is_near =
            remarks.iter().any(|remark| remark.starts_with("the light that these materials send out") && remark.ends_with(": paint"));
        let is_left_out = remarks.iter().any(|remark| remark.contains("light that materials send out by a texture"));
        assert!(is_left_out || rules != Rules::default() || !remarks.iter().any(|remark| remark.contains("left out")), "{remarks:?}");
        (materials[0].as_ref().unwrap().emission.map(|c| (1e3 * c).round()), is_near, is_left_out)
    };
    let (placed, all) = (textured(&[square()]), Rules::default());
    assert_eq!(of(&placed, "Kd 0\nmap_Ke red.png\n", all), ([500.0, 0.0, 0.0], true, false));
    assert_eq!(of(&placed, "Kd 0\nKe 0.5\nmap_Ke grey.png\n", all), ([100.0; 3], false, false));
    assert_eq!(of(&placed, "Ke 1\nmap_Kd red.png\nmap_Ke red.png\n", all), ([1000.0, 0.0, 0.0], false, false));
    assert_eq!(of(&placed, "Ke 0.1\nmap_Kd grey.png\n", all), ([500.0; 3], false, false));
    // Black surfaces of a material cannot send out light.
    assert_eq!(of(&placed, "Ke 0.4\nmap_Kd white.png\n", all), ([400.0; 3], true, false));
    let without = Rules { colours: Colours::None, ..all };
    assert_eq!(of(&placed, "Ke 0.4\nmap_Kd white.png\n", without), ([400.0; 3], false, false));
    assert_eq!(of(&placed, "map_Ke red.png\n", without), ([0.0; 3], false, true));
    assert_eq!(of(&placed, "map_Ke none.png\n", all), ([0.0; 3], false, true));
    let bare = "mtllib a.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(of(bare, "map_Ke red.png\n", all), ([0.0; 3], false, true));
}

/// Sides become the nearest power of two, at most the size that is asked for, and texels the means of areas.
#[test]
fn images_are_resampled_by_areas() {
    let sized = |size: u32| {
        let size = TextureSize::of(size).unwrap();
        Options { rules: Rules { texture_size: size, colours: Colours::Texture, ..Rules::default() }, ..Options::default() }
    };
    let size_of = |bytes: &StreamBytes| bytes.parse().unwrap().textures().list.iter().map(|texture| texture.size).collect::<Vec<_>>();
    // Four pixels become one texel, of their mean colour.
    let mut image = chequered(8, 2);
    image[0][1] = [50, 40, 230];
    let (_, bytes) = model(&[square()], &image, &sized(8));
    let stream = bytes.parse().unwrap();
    let texture = stream.texture_of(&stream.meshes[0]).unwrap();
    let texels: Vec<Rgb> = texture.texels.iter().map(|&texel| texture.palette[usize::from(texel)].channels).collect();
    assert_eq!((texture.size, texels[0], texels[1], texels[2]), ([3, 3], [200, 190, 80], DARK, LIGHT));
    // A pixel between two texels is shared by them.
    let row = vec![vec![[0; 3], [240; 3], [0; 3]]];
    let (_, bytes) = model(&[square()], &row, &sized(8));
    let stream = bytes.parse().unwrap();
    let texture = stream.texture_of(&stream.meshes[0]).unwrap();
    let texels: Vec<Rgb> = texture.texels.iter().map(|&texel| texture.palette[usize::from(texel)].channels).collect();
    assert_eq!((texture.size, &texels[..]), ([2, 0], &[[0; 3], [160; 3], [160; 3], [0; 3]][..]));
    for (fields, pixels, expected) in [(11, 1, 3), (12, 1, 4), (16, 8, 7), (16, 12, 7), (16, 16, 7)] {
        assert_eq!(size_of(&model(&[square()], &chequered(fields, pixels), &with_textures()).1), [[expected; 2]], "{fields} {pixels}");
    }
    assert_eq!(size_of(&model(&[square()], &chequered(16, 16), &sized(256)).1), [[8, 8]]);
    assert_eq!(TextureSize::ALL.map(TextureSize::texels), [8, 16, 32, 64, 128, 256]);
    assert!([0, 1, 4, 100, 512].into_iter().all(|size| TextureSize::of(size).is_none()));
}

/// An image of many colours has a palette of 256 that are near to them.
#[test]
fn many_colours_become_256() {
    let image: Vec<Vec<Rgb>> =
        (0..64u8).map(|y| (0..64u8).map(|x| [4 * x, 4 * y, if (x ^ y) & 1 > 0 { 200 } else { 20 }]).collect()).collect();
    let (converted, bytes) = model(&[square()], &image, &with_textures());
    let stream = bytes.parse().unwrap();
    let texture = stream.texture_of(&stream.meshes[0]).unwrap();
    assert_eq!((stream.colours.len(), texture.texels.len()), (256, 64 * 64));
    for (&texel, colour) in texture.texels.iter().zip(image.concat()) {
        let near = texture.palette[usize::from(texel)].channels;
        assert!((0..3).all(|k| near[k].abs_diff(colour[k]) <= 24), "{near:?} {colour:?}");
    }
    let textures = converted.painted.textures.unwrap();
    assert!(textures.lost_area == 0.0 && (1.0..12.0).contains(&textures.rms), "{textures:?}");
}

/// Places are shifted by whole numbers, and a triangle with a coordinate of 16 or more has colours at its corners.
#[test]
fn places_are_shifted_and_end_at_sixteen() {
    let corners = |places: [[i32; 2]; 3]| texture_corners(places).map(|corners| corners.0);
    assert_eq!(corners([[-1, 5000], [4095, 4096], [8191, 65535]]), Some([[4095, 904], [8191, 0], [12287, 61439]]));
    assert_eq!(corners([[0, 0], [65535, 0], [65535, 1]]), Some([[0, 0], [65535, 0], [65535, 1]]));
    assert_eq!(corners([[0, 0], [65536, 0], [0, 1]]), None);
    assert_eq!(corners([[4097, 0], [4096 + 65535, 0], [4097, 1]]), Some([[1, 0], [65535, 0], [1, 1]]));
    // The numbers wrap around, at a whole number of textures.
    assert_eq!(corners([[i32::MAX, 0], [i32::MIN, 0], [i32::MIN + 4096, 0]]), Some([[4095, 0], [4096, 0], [8192, 0]]));
    let image = chequered(8, 1);
    let near = moved(square(), 0.0, 1.0, [-2.75, 7.5]);
    let far = moved(square(), 2.0, 15.5, [0.25, 0.25]);
    let too_far = moved(square(), 4.0, 16.0, [0.25, 0.0]);
    let (converted, bytes) = model(&[near, far, too_far], &image, &with_textures());
    let stream = bytes.parse().unwrap();
    let all: Vec<[u16; 2]> = stream.textures().corners.iter().flat_map(|corners| corners.0).collect();
    assert_eq!(all.len(), 12);
    for place in &all[..6] {
        assert!(place[0] == 1024 || place[0] == 5120, "{place:?}");
        assert!(place[1] == 2048 || place[1] == 6144, "{place:?}");
    }
    for place in &all[6..] {
        assert!(place[0] == 1024 || place[0] == 1024 + 31 * 2048, "{place:?}");
        assert!(place[1] == 1024 || place[1] == 1024 + 31 * 2048, "{place:?}");
    }
    let textures = converted.painted.textures.unwrap();
    assert_eq!((textures.triangles, textures.repeating, textures.multiplied), (4, 2, 0));
    assert_eq!((converted.painted.triangles, stream.meshes.len(), stream.corner_colours.len()), (2, 2, 2));
    let kept = "2 triangles keep colours at the corners, because the texture repeats itself 16 times or more over it";
    assert!(converted.remarks.iter().any(|remark| remark == kept), "{:?}", converted.remarks);
}

/// A texture takes the place of colours at corners if more than 5 % of the area is farther than 24 of 255.
#[test]
fn the_area_that_is_far_decides() {
    // The small face has a checkerboard, and the large one a patch of one colour.
    let mut image = chequered(8, 1);
    image.iter_mut().for_each(|row| row.extend([LIGHT; 8]));
    let small = moved(square(), 0.0, 1.0, [0.0; 2]).into_iter().map(|(position, [u, v])| (position, [0.5 * u, v])).collect::<Face>();
    let large = |side: f64| -> Face { square().into_iter().map(|([x, y, z], _)| ([side * x + 2.0, side * y, z], [0.75, 0.5])).collect() };
    for (side, is_textured) in [(2.0, true), (6.0, false)] {
        let (converted, bytes) = model(&[small.clone(), large(side)], &image, &with_textures());
        let stream = bytes.parse().unwrap();
        assert_eq!((stream.textures().list.len(), stream.textures().corners.len()), if is_textured { (1, 4) } else { (0, 0) });
        assert_eq!((converted.painted.textures.is_some(), converted.painted.lost_materials), (is_textured, usize::from(is_textured)));
        assert_eq!(converted.painted.triangles, if is_textured { 0 } else { 4 });
    }
    // Colours at corners are between those of a checkerboard, about half of their distance away.
    for (distance, is_textured) in [(40, false), (60, true)] {
        let soft = |colour: Rgb| if colour == DARK { [100; 3] } else { [100 + distance, 100, 100] };
        let soft: Vec<Vec<Rgb>> = chequered(8, 1).into_iter().map(|row| row.into_iter().map(soft).collect()).collect();
        let (converted, _) = model(&[square()], &soft, &with_textures());
        assert_eq!(converted.painted.textures.is_some(), is_textured, "{distance} {:?}", converted.painted);
    }
    // By default the texture is only recommended.
    let (converted, bytes) = model(&[square()], &chequered(8, 1), &Options::default());
    assert!(bytes.parse().unwrap().textures().list.is_empty() && converted.painted.textures.is_none() && converted.painted.triangles == 2);
    let [remark] = &converted.remarks[..] else { panic!("{:?}", converted.remarks) };
    let share = (100.0 * converted.painted.lost_area).round();
    let end = format!(
        "; {share} % of the area of 1 material is farther than 24: --colours texture keeps the texture, for a program with the feature textures"
    );
    assert!(remark.starts_with("2 triangles have ") && remark.ends_with(&end), "{remark}");
}

/// Materials that need a texture have one, others keep colours at corners, and equal textures are written once.
#[test]
fn equal_textures_are_written_once() {
    let faces = [square(), moved(square(), 2.0, 1.0, [0.0; 2]), moved(square(), 4.0, 0.1, [0.0; 2])];
    let text = textured(&faces);
    // The materials of the three faces differ.
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut names = ["usemtl one", "usemtl two", "usemtl three"].into_iter();
    lines = lines
        .into_iter()
        .filter(|line| line != "usemtl paint")
        .flat_map(|line| if line.starts_with('f') { vec![names.next().unwrap().to_owned(), line] } else { vec![line] })
        .collect();
    let mtl = ["one", "two", "three"]
        .map(|name| format!("newmtl {name}\nKd 1 {} 1\nmap_Kd {name}.png\n", if name == "two" { 0.5 } else { 1.0 }))
        .concat();
    let image = png(&chequered(8, 1));
    // The other image has twice as many pixels of the same texels.
    let other = png(&chequered(8, 2));
    let even = png(&[vec![[7, 8, 9]]]);
    let files: [(&str, &[u8]); 5] = [
        ("a.obj", &lines.join("\n").into_bytes()),
        ("a.mtl", mtl.as_bytes()),
        ("one.png", &image),
        ("two.png", &other),
        ("three.png", &even),
    ];
    let small = Rules { texture_size: TextureSize::of(8).unwrap(), colours: Colours::Texture, ..Rules::default() };
    let converted = converted(&files, &Options { rules: small, ..Options::default() }).unwrap();
    let bytes = converted.stream().unwrap();
    let stream = bytes.parse().unwrap();
    let flags: Vec<u8> = stream.meshes.iter().map(|mesh| mesh.flags & (HAS_COLOURS | HAS_TEXTURE)).collect();
    assert_eq!(flags, [HAS_TEXTURE, HAS_TEXTURE, HAS_COLOURS]);
    // The palette of the colours at corners is apart from that of the texture.
    assert_eq!((stream.textures().list, stream.textures().texels.len()), (&[Texture { size: [3, 3], palette: 0, has_holes: 0 }][..], 64));
    assert_eq!((stream.meshes[2].palette, stream.colours[16].channels, stream.colours.len()), (1, [7, 8, 9], 17));
    assert_eq!(stream.materials[1].diffuse().map(|gain| gain.to_num::<f64>()), [1.0, 0.5, 1.0]);
    let painted = converted.painted;
    assert_eq!((painted.triangles, painted.lost_materials, painted.textures.unwrap().sizes), (2, 2, vec![[8, 8]]));
}

/// Backs have the places of their fronts.
#[test]
fn backs_have_the_same_texture() {
    use microphong_models::backs::Sides;
    let options = Options { rules: Rules { colours: Colours::Texture, sides: Sides::Two, ..Rules::default() }, ..Options::default() };
    let (_, bytes) = model(&[moved(square(), 0.0, 2.0, [0.5, 0.25])], &chequered(8, 1), &options);
    let places = places(&bytes);
    assert_eq!((places.len(), bytes.parse().unwrap().textures().list.len()), (4, 1));
    for (position, place) in places.concat() {
        assert_eq!(place, [if position[0] > 0 { 10240 } else { 2048 }, if position[1] > 0 { 3072 } else { 11264 }], "{position:?}");
    }
}

/// A tiled floor of many triangles, which is bent a little.
fn floor(tiles: usize, scale: f64) -> Vec<Face> {
    let at = |x: usize, y: usize| {
        let [u, v] = [x, y].map(|c| c as f64 / tiles as f64);
        ([u, v, 0.1 * (u * u + u * v * v)], [scale * u, scale * v])
    };
    (0..tiles * tiles).map(|k| (k % tiles, k / tiles)).map(|(x, y)| vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]).collect()
}

/// Collapsed edges take the places of vertices with them: the texture stays where it is.
#[test]
fn simplified_meshes_keep_their_texture() {
    let options = Options { simplify: Some(220), levels: vec![(32, 32)], ..with_textures() };
    let (converted, bytes) = model(&floor(20, 3.0), &chequered(8, 1), &options);
    let stream = bytes.parse().unwrap();
    assert!(stream.meshes.len() == 2 && stream.meshes[0].triangles <= 220 && stream.meshes[1].triangles < stream.meshes[0].triangles);
    assert_eq!(stream.textures().corners.len(), stream.triangles.len());
    let [part] = &converted.parts[..] else { panic!("{} parts", converted.parts.len()) };
    let first = |k: usize| f64::from(part.vertices.iter().map(|vertex| vertex.position[k]).min().unwrap());
    let (low, wide) = ([first(0), first(1)], -2.0 * first(0));
    for mesh in stream.meshes {
        let (triangles, vertices) = (stream.triangles_of(mesh).unwrap(), stream.vertices_of(mesh).unwrap());
        for (triangle, corners) in triangles.iter().zip(stream.texture_of(mesh).unwrap().corners) {
            let shifts = [0, 1, 2].map(|k| {
                let [x, y, _] = vertices[usize::from(triangle.corners[k])].position.map(f64::from);
                let [u, v] = [3.0 * (x - low[0]) / wide, 1.0 - 3.0 * (y - low[1]) / wide];
                let [placed_u, placed_v] = corners.0[k].map(|c| f64::from(c) / 4096.0);
                [placed_u - u, placed_v - v]
            });
            for shift in shifts {
                assert!((0..2).all(|axis| (shift[axis] - shifts[0][axis]).abs() < 2e-3), "{shifts:?}");
                assert!((0..2).all(|axis| (shift[axis] - shift[axis].round()).abs() < 2e-3), "{shifts:?}");
            }
        }
    }
}

/// A simplified triangle over which the texture repeats itself too often is an error, and no level of detail.
#[test]
fn simplified_triangles_have_room_in_the_texture() {
    let files = |options: &Options| {
        let flat: Vec<Face> =
            floor(10, 60.0).into_iter().map(|face| face.into_iter().map(|([x, y, _], place)| ([x, y, 0.0], place)).collect()).collect();
        converted(&[("a.obj", textured(&flat).as_bytes()), ("a.mtl", MTL), ("a.png", &png(&chequered(8, 1)))], options)
    };
    let error = format!("{:#}", files(&Options { simplify: Some(8), ..with_textures() }).unwrap_err());
    assert!(error.contains("a texture would repeat itself 16 times or more") && error.contains("--colours corners"), "{error}");
    let converted = files(&Options { levels: vec![(64, 64)], ..with_textures() }).unwrap();
    let bytes = converted.stream().unwrap();
    assert!(bytes.parse().unwrap().textures().corners.len() >= 200);
}
