//! Bytes that nobody meant: streams with bytes flipped, cut off, sealed again.

use crate::{
    Family, Verdict,
    case::Case,
    fuzz,
    random::Random,
    scenes::{self, Wishes},
};
use microphong::stream::{record::Header, seal};
use microphong_models::bytes::StreamBytes;
use zerocopy::FromBytes;

/// Damaged streams of random scenes.
pub struct Hostile;

/// Bytes in which a stream usually has its header, materials and lights.
const FRONT: usize = 256;

/// A random scene, its stream with bytes flipped, cut off, sealed again: each of them or not. `None` if there is no such scene.
#[must_use]
pub fn damaged(random: &mut Random) -> Option<Case> {
    let case = scenes::case(random, Wishes { closed: false, unclipped: false, triangles: 60, hard: scenes::Hard::default() })?;
    let mut bytes = case.stream.as_bytes().to_vec();
    if random.once_in(2) {
        name_meshes(random, &mut bytes);
    }
    for _ in 0..random.pick(0..6) {
        // Half of them where one byte changes the whole picture: most bytes are vertices.
        let within = if random.once_in(2) { bytes.len().min(FRONT) } else { bytes.len() };
        let at = random.pick(0..within as i32) as usize;
        bytes[at] = match random.pick(0..3) {
            0 => bytes[at] ^ (1 << random.pick(0..8)),
            1 => random.among(&[0, 1, 0x7F, 0x80, 0xFF]),
            _ => random.bits() as u8,
        };
    }
    if random.once_in(8) {
        bytes.truncate(random.pick(0..bytes.len() as i32 + 1) as usize);
    }
    if !random.once_in(8) {
        seal(&mut bytes);
    }
    Some(Case { stream: StreamBytes::from(&bytes[..]), ..case })
}

/// Appends names to a stream. Some are invalid, as are names of coarser levels.
fn name_meshes(random: &mut Random, bytes: &mut Vec<u8>) {
    let Ok((header, _)) = Header::read_from_prefix(bytes) else { return };
    for _ in 0..header.meshes {
        let name = random.among(&["", "needle", "Zeiger ä", "\u{1F9ED}"]);
        bytes.push(name.len() as u8);
        bytes.extend_from_slice(name.as_bytes());
    }
    let length = bytes.len() as u32;
    if let Ok((header, _)) = Header::mut_from_prefix(bytes) {
        header.length = length;
    }
}

/// Asks for names, and draws.
fn use_it(case: &Case) {
    case.stream.parse().iter().for_each(fuzz::ask);
    drop(case.draw());
}

impl Family for Hostile {
    fn name(&self) -> &'static str {
        "hostile"
    }

    fn about(&self) -> &'static str {
        "a damaged stream gives an error, or is read and drawn without a panic or an overflow"
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = damaged(random) else { return Verdict::skipped() };
        // Kept before it is drawn: a panic must not lose it.
        let failure = crate::guarded(|| use_it(&case)).err();
        Verdict { failure, case: Some(case), ..Verdict::default() }
    }

    fn fails(&self, case: &Case) -> bool {
        crate::guarded(|| use_it(case)).is_err()
    }
}
