//! Random transparent meshes and holes in textures.

use crate::{
    case::Case,
    random::Random,
    records::Records,
    scenes::{self, Hard, Wishes},
};
use microphong::stream::record::{Mesh, TRANSPARENCY_SHIFT};
use microphong_models::{bytes::StreamBytes, look::Surface, mesh::Submesh};

/// In about a quarter of all cases, makes some meshes of a stream transparent, and some colours of its textures holes. All else of the stream is the same.
pub(crate) fn sometimes(random: &mut Random, stream: StreamBytes) -> StreamBytes {
    let mut aside = random.aside(1 << 33);
    if !aside.once_in(4) {
        return stream;
    }
    seen_through(&mut aside, &stream).unwrap_or(stream)
}

fn seen_through(random: &mut Random, stream: &StreamBytes) -> Option<StreamBytes> {
    let mut records = Records::of(&stream.parse().ok()?);
    let mut transparency = 0;
    for mesh in &mut records.meshes {
        // Levels of detail are as transparent as their mesh.
        if mesh.error == 0 {
            transparency = if random.once_in(2) { random.pick(1..16) as u8 } else { 0 };
        }
        *mesh = Mesh { flags: mesh.flags | transparency << TRANSPARENCY_SHIFT, ..*mesh };
    }
    if random.once_in(2) {
        pierce(random, &mut records);
    }
    records.written()
}

/// In half of all cases, makes some colours of the textures of a stream holes. All else of the stream is the same.
pub(crate) fn sometimes_pierced(random: &Random, stream: StreamBytes) -> StreamBytes {
    let mut aside = random.aside(1 << 34);
    if !aside.once_in(2) {
        return stream;
    }
    pierced(&mut aside, &stream).unwrap_or(stream)
}

fn pierced(random: &mut Random, stream: &StreamBytes) -> Option<StreamBytes> {
    let mut records = Records::of(&stream.parse().ok()?);
    pierce(random, &mut records);
    records.written()
}

/// Makes some colours of all textures holes.
fn pierce(random: &mut Random, records: &mut Records) {
    records.textures.iter_mut().for_each(|texture| texture.has_holes = 1);
    let share = random.pick(1..6);
    records.colours.iter_mut().for_each(|colour| colour.hole = u8::from(random.once_in(share)));
}

/// A scene in which triangles of six materials lie among one another, of which four are transparent, drawn in a random way; `None` if it would not
/// make a valid stream.
pub(crate) fn sheets(random: &mut Random, hard: Hard) -> Option<Case> {
    let wishes = Wishes { closed: false, unclipped: true, triangles: 120, hard };
    let width = random.between(20.0, 100.0);
    let size = scenes::size(random, width);
    let mut mesh = scenes::mesh(random, wishes);
    let material = |random: &mut Random| Submesh { material: random.pick(0..6) as usize, ..Submesh::default() };
    mesh.submeshes = mesh.triangles.iter().map(|_| material(random)).collect();
    let mut look = scenes::look(random, &mesh, size, wishes);
    let transparency = |random: &mut Random, material: i32| if material < 2 { 0.0 } else { random.between(0.05, 0.95) };
    look.surfaces = (0..6).map(|k| Surface { transparency: transparency(random, k), ..scenes::surface(random, hard.steep) }).collect();
    scenes::drawn(random, &mesh, size, &look)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{LIMIT, PER_LIGHT};
    use microphong_compare::{Comparison, Reference};
    use microphong_render::shader::Shader;

    /// Many cases have transparent meshes, and some have holes.
    #[test]
    fn it_is_not_rare() {
        let [mut transparent, mut holes] = [0; 2];
        for number in 0..1200 {
            let mut random = Random::new(5, number);
            let wishes = Wishes { closed: false, unclipped: true, triangles: 60, hard: Hard::default() };
            let Some(case) = scenes::case(&mut random, wishes) else { continue };
            let stream = sometimes(&mut random, case.stream);
            let stream = stream.parse().unwrap();
            transparent += u32::from(stream.meshes.iter().any(Mesh::is_transparent));
            holes += u32::from(stream.textures().list.iter().any(|texture| texture.has_holes != 0));
        }
        assert!(transparent > 40 && holes > 4, "{transparent} {holes}");
    }

    /// Pixels of methods that interpolate light, which are right everywhere, show the sheets that the reference in floating point shows, in the same
    /// order. Rounding does not grow by mixing.
    #[test]
    fn sheets_are_mixed_as_in_the_reference() {
        let (mut scenes, mut pixels) = (0, 0);
        for number in 0..400 {
            let mut random = Random::new(6, number);
            let Some(Case { stream, size: [width, height], .. }) = sheets(&mut random, Hard::default()) else { continue };
            let stream = stream.parse().unwrap();
            let of = if random.once_in(3) { Reference::perspective_correct } else { Reference::new };
            let Ok(reference) = of(stream, (width, height), 0) else { continue };
            let shader = random.among(&[Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT]);
            let Ok(Comparison { arithmetic, unmatched, pixels: compared, .. }) = reference.compare(shader) else { continue };
            let limit = LIMIT + PER_LIGHT * stream.lights.len().saturating_sub(1) as f64;
            assert!(unmatched == 0 && arithmetic.max <= limit, "case {number}, {}: {unmatched}, {arithmetic:?}", shader.name());
            (scenes, pixels) = (scenes + 1, pixels + compared);
        }
        println!("{pixels} pixels of {scenes} scenes");
        assert!(scenes > 300 && pixels > 100_000, "{scenes} {pixels}");
    }
}
