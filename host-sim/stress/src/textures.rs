//! Random textures on the meshes of a stream.

use crate::{colours, random::Random, records::Records};
use microphong::stream::record::{Colour, HAS_COLOURS, HAS_TEXTURE, LARGEST_TEXTURE, Mesh, PALETTE, Texture, TextureCorners, Triangle};
use microphong_models::{
    bytes::StreamBytes,
    vector::{V3, dot},
};

/// How triangles lie in a texture.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Corners anywhere within so many steps, of which a texture has 4,096.
    Anywhere(i32),
    /// All corners of a triangle at one place.
    AtOnePlace,
    /// By the place in space, along these directions.
    Along([V3; 2]),
}

/// Gives about half of the meshes of a stream a texture, in place of the colours of corners. `None` if there is no room for palettes.
pub(crate) fn paint(random: &mut Random, stream: &StreamBytes) -> Option<StreamBytes> {
    let mut records = Records::of(&stream.parse().ok()?);
    for _ in 0..random.pick(1..3) {
        add(random, &mut records)?;
    }
    records.texels.resize(records.texels.len().next_multiple_of(4), 0);
    let (mut texture, mut kind) = (None, Kind::AtOnePlace);
    for number in 0..records.meshes.len() {
        // Levels of detail have the texture of their mesh.
        if records.meshes[number].error == 0 {
            texture = (!random.once_in(2)).then(|| random.pick(0..records.textures.len() as i32) as u8);
            kind = match random.pick(0..4) {
                0 => Kind::Anywhere(1 << 16),
                1 => Kind::Anywhere(random.octaves(2.0, 65_536.0) as i32),
                2 => Kind::AtOnePlace,
                _ => Kind::Along([random.direction(), random.direction()]),
            };
        }
        let Some(texture) = texture else { continue };
        let mesh = records.meshes[number];
        records.meshes[number] = Mesh { flags: mesh.flags & !HAS_COLOURS | HAS_TEXTURE, palette: texture, ..mesh };
        let first = mesh.first_triangle as usize;
        for k in first..first + mesh.triangles as usize {
            let corners = corners(random, kind, &records, &mesh, &records.triangles[k]);
            records.texture_corners.push(corners);
        }
    }
    records.written()
}

/// Adds a texture of a random size, with a palette of its own.
fn add(random: &mut Random, records: &mut Records) -> Option<()> {
    let palette = colours::palette(random);
    let next = records.colours.len().div_ceil(PALETTE);
    records.colours.resize(next * PALETTE, Colour::new([0; 3]));
    records.colours.extend(palette.iter().map(|&channels| Colour::new(channels)));
    let size = [(); 2].map(|()| random.pick(0..i32::from(LARGEST_TEXTURE) + 1) as u8);
    let texels = 1 << (size[0] + size[1]);
    let (kind, colours) = (random.pick(0..3), palette.len());
    records.texels.extend((0..texels).map(|texel: usize| {
        let (column, row) = (texel % (1 << size[0]), texel >> size[0]);
        let colour = match kind {
            0 => random.bits() as usize,
            1 => column ^ row,
            _ => (column + row) / 4,
        };
        (colour % colours) as u8
    }));
    records.textures.push(Texture { size, palette: u8::try_from(next).ok()?, has_holes: 0 });
    Some(())
}

/// Where a triangle lies in its texture.
fn corners(random: &mut Random, kind: Kind, records: &Records, mesh: &Mesh, triangle: &Triangle) -> TextureCorners {
    let mut anywhere = |range: i32| [(); 2].map(|()| random.pick(0..range) as u16);
    TextureCorners(match kind {
        Kind::Anywhere(range) => [(); 3].map(|()| anywhere(range)),
        Kind::AtOnePlace => [anywhere(1 << 16); 3],
        Kind::Along(directions) => triangle.corners.map(|corner| {
            let position = records.vertices[mesh.first_vertex as usize + usize::from(corner)].position.map(|c| f64::from(c) / 4.0);
            directions.map(|direction| (8_192.0 + dot(direction, position)) as u16)
        }),
    })
}
