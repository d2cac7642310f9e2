//! Random transparent meshes and holes in textures.

use crate::{random::Random, records::Records};
use microphong::stream::record::{Mesh, TRANSPARENCY_SHIFT};
use microphong_models::bytes::StreamBytes;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{self, Hard, Wishes};

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
}
