//! Scenes in colours, textures and glass: what the costs of these are counted with.

use anyhow::{Context, Result, ensure};
use microphong::stream::record::{Colour, CornerColours, HAS_COLOURS, HAS_TEXTURE, Mesh, TRANSPARENCY_SHIFT, Texture, TextureCorners};
use microphong_models::bytes::StreamBytes;
use microphong_stress::records::Records;

/// Number of colours in the palette.
const COLOURS: usize = 16;
/// Width and height of the texture, as powers of two.
const SIZE: u8 = 6;
/// Sixteenths of the light from behind that glass lets through.
const CLEAR: u8 = 8;

/// The records of a stream that has no colours of its own.
fn bare(stream: &StreamBytes) -> Result<Records> {
    let stream = stream.parse()?;
    ensure!(stream.colours.is_empty(), "the scene has colours of its own");
    Ok(Records::of(&stream))
}

/// The stream with colours at all corners, which differ between the corners of most triangles.
pub(super) fn coloured(stream: &StreamBytes) -> Result<StreamBytes> {
    let mut records = bare(stream)?;
    records.colours = palette(false);
    let corner_colours = records.triangles.iter().map(|triangle| {
        let indices = triangle.corners.map(|corner| usize::from(corner) % COLOURS);
        CornerColours::new(indices.map(|index| index as u8), indices.map(|index| records.colours[index]))
    });
    records.corner_colours = corner_colours.collect();
    records.meshes.iter_mut().for_each(|mesh| mesh.flags |= HAS_COLOURS);
    records.written().context("colours do not fit the scene")
}

/// The stream with a texture of 64x64 texels that lies across it, with holes or without.
pub(super) fn textured(stream: &StreamBytes, has_holes: bool) -> Result<StreamBytes> {
    let mut records = bare(stream)?;
    records.colours = palette(has_holes);
    let side = 1usize << SIZE;
    // Squares of four by four texels.
    records.texels = (0..side * side).map(|texel| ((5 * (texel % side / 4) + 3 * (texel / side / 4)) % COLOURS) as u8).collect();
    records.textures = vec![Texture { size: [SIZE; 2], palette: 0, has_holes: has_holes.into() }];
    let mut corners = Vec::new();
    for mesh in &records.meshes {
        let place = |corner: u16| {
            let [x, y, _] = records.vertices[mesh.first_vertex as usize + usize::from(corner)].position;
            // The middle of the texture lies at the origin, and its sides one unit from there.
            [x, y].map(|c| (i32::from(c) / 8 + 4_096) as u16)
        };
        let triangles = &records.triangles[mesh.first_triangle as usize..][..mesh.triangles as usize];
        corners.extend(triangles.iter().map(|triangle| TextureCorners(triangle.corners.map(place))));
    }
    records.texture_corners = corners;
    records.meshes.iter_mut().for_each(|mesh| *mesh = Mesh { flags: mesh.flags | HAS_TEXTURE, palette: 0, ..*mesh });
    records.written().context("a texture does not fit the scene")
}

/// The stream in glass.
pub(super) fn glass(stream: &StreamBytes) -> Result<StreamBytes> {
    let mut records = Records::of(&stream.parse()?);
    ensure!(records.meshes.iter().all(|mesh| !mesh.is_transparent()), "the scene has glass of its own");
    records.meshes.iter_mut().for_each(|mesh| mesh.flags |= CLEAR << TRANSPARENCY_SHIFT);
    records.written().context("glass does not fit the scene")
}

/// Bright and dark colours. A quarter of them can be holes.
fn palette(has_holes: bool) -> Vec<Colour> {
    let colour = |k: usize| Colour {
        hole: u8::from(has_holes && k.is_multiple_of(4)),
        ..Colour::new([255 - 16 * k, 16 * (5 * k % COLOURS) + 15, 16 * (11 * k % COLOURS) + 15].map(|c| c as u8))
    };
    (0..COLOURS).map(colour).collect()
}
