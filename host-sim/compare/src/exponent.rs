//! Scenes with tighter or wider highlights.

use anyhow::{Context, Result, anyhow};
use microphong::stream::{
    record::{Header, Material, Mesh},
    seal,
};
use std::mem::offset_of;
use zerocopy::FromBytes;

/// The stream with this exponent in all its materials.
///
/// # Errors
/// When `stream` is shorter than its header says.
pub fn with_exponent(stream: &[u8], exponent: u16) -> Result<Vec<u8>> {
    let (header, _) = Header::read_from_prefix(stream).map_err(|_| anyhow!("the stream is shorter than its header"))?;
    let short = || format!("the stream has {} bytes, fewer than its header says", stream.len());
    let mut bytes = stream.get(..header.length as usize).with_context(short)?.to_vec();
    let first = size_of::<Header>() + usize::from(header.meshes) * size_of::<Mesh>();
    for material in 0..usize::from(header.materials) {
        let at = first + material * size_of::<Material>() + offset_of!(Material, exponent);
        bytes.get_mut(at..at + 2).with_context(short)?.copy_from_slice(&exponent.to_le_bytes());
    }
    seal(&mut bytes);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong_models::{bytes::StreamBytes, scene};

    #[test]
    fn only_exponents_change() {
        let scene = scene::load("torus").expect("a built-in scene");
        let bytes = StreamBytes::from(with_exponent(scene.stream.as_bytes(), 77).expect("a whole stream").as_slice());
        let (old, new) = (scene.stream.parse().expect("a stream"), bytes.parse().expect("a stream"));
        assert!(new.materials.iter().all(|material| material.exponent == 77));
        let restored: Vec<_> = new.materials.iter().map(|m| Material { exponent: old.materials[0].exponent, ..*m }).collect();
        assert_eq!(restored, old.materials);
        assert_eq!((new.vertices, new.triangles, new.lights), (old.vertices, old.triangles, old.lights));
        assert!(with_exponent(&scene.stream.as_bytes()[..200], 77).is_err());
    }
}
