//! Files of formats that are not read: recognised, so that an error can say what they are and what helps.

use anyhow::{Result, bail};
use std::path::Path;

/// Names of other formats, by the endings of their files.
const ENDINGS: [(&str, &str); 6] =
    [("fbx", "FBX"), ("dae", "COLLADA"), ("3ds", "3DS"), ("3mf", "3MF"), ("off", "OFF"), ("blend", "Blender")];

/// Passes what may be a mesh of a format that is read.
///
/// # Errors
/// Names the file, its format, and what makes an OBJ or a stream of it.
pub(crate) fn refuse(path: &Path, bytes: &[u8]) -> Result<()> {
    let name = path.display();
    if [b"\xFF\xFE", b"\xFE\xFF"].iter().any(|mark| bytes.starts_with(*mark)) {
        bail!("{name}: text in UTF-16; save it as UTF-8 or ASCII");
    }
    if let Some(format) = by_content(bytes).or_else(|| by_ending(path)) {
        let obj = path.with_extension("obj");
        let obj = if obj == path { path.with_extension("new.obj") } else { obj };
        bail!(
            "{name}: a mesh in the format {format}; OBJ, glTF, STL or PLY is needed: export it as OBJ, for example with Blender, or run\n  assimp export {name} {}",
            obj.display()
        );
    }
    Ok(())
}

fn by_content(bytes: &[u8]) -> Option<&'static str> {
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
    let starts: [(&[u8], &str); 2] = [(b"Kaydara FBX", "FBX"), (b"BLENDER", "Blender")];
    starts.iter().find(|(start, _)| text.starts_with(start)).map(|&(_, format)| format)
}

fn by_ending(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?;
    ENDINGS.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known)).map(|&(_, format)| format)
}
