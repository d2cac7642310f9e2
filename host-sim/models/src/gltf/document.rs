//! The document of a glTF file, checked so that no number of another element leads nowhere.

use crate::fields::quoted;
use anyhow::{Result, anyhow, bail, ensure};
use gltf::{
    Document, Semantic,
    json::{
        self, Root, Value,
        deserialize::from_slice,
        validation::{Checked, Error, Validate},
    },
};

/// The first bytes of GLB.
const MAGIC: &[u8] = b"glTF";
/// Bytes of GLB before its first chunk.
const HEAD: usize = 12;
/// Faults of a document that an error names.
const NAMED: usize = 3;

/// Extensions that a file may require, because they are read, or change no shape.
const KNOWN: [&str; 10] = [
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "EXT_structural_metadata",
    "EXT_mesh_features",
    "FB_ngon_encoding",
];

/// Whether a file is glTF. No other format that is read is JSON.
pub(crate) fn is_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || text(bytes).starts_with(b"{")
}

/// JSON without what may stand before and behind it. Some programs fill up its chunk with zeros.
fn text(bytes: &[u8]) -> &[u8] {
    let is_padding = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
    let end = bytes.iter().rposition(|byte| !is_padding(byte)).map_or(0, |last| last + 1);
    bytes[..end].strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes[..end]).trim_ascii_start()
}

/// The document of a file, and the bytes of its binary chunk.
pub(super) fn open(bytes: &[u8]) -> Result<(Document, Option<&[u8]>)> {
    let (json, blob) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let mut root: Root = from_slice(text(json)).map_err(|error| unreadable(text(json), &error))?;
    // Attributes that only programs of one maker know.
    for primitive in root.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.attributes.retain(|semantic, _| matches!(semantic, Checked::Valid(_)));
    }
    ensure!(root.asset.version.starts_with("2."), "glTF {}; export it as glTF 2.0", quoted(&root.asset.version));
    if let Some(name) = root.extensions_required.iter().find(|name| !passes(name)) {
        bail!("glTF: it needs the extension {}, which is not read; export it without this extension", quoted(name));
    }
    check(&root)?;
    Ok((Document::from_json_without_validation(root), blob))
}

/// Whether a file may require an extension. Those of materials and textures change no shape.
fn passes(name: &str) -> bool {
    KNOWN.contains(&name) || ["_materials_", "_texture_", "_lights_", "_image_"].iter().any(|part| name.contains(part))
}

/// The text and the binary chunk of GLB. Chunks of other kinds are passed over.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    const CUT: &str = "GLB: the file is shorter than its head says; it was cut off";
    let number = |at: usize| bytes.get(at..).and_then(|rest| rest.first_chunk()).map(|&number| u32::from_le_bytes(number));
    let (Some(version), Some(length)) = (number(4), number(8)) else { bail!(CUT) };
    ensure!(version == 2, "GLB: glTF {version}.0; export it as glTF 2.0");
    let length = length as usize;
    ensure!((HEAD..=bytes.len()).contains(&length), CUT);
    let (mut json, mut blob, mut at) = (None, None, HEAD);
    while let (Some(size), Some(kind)) = (number(at), number(at + 4)) {
        let chunk = bytes.get(at + 8..).and_then(|rest| rest.get(..size as usize));
        let Some(chunk) = chunk else { bail!("GLB: a chunk reaches beyond the end of the file; it is damaged or was cut off") };
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if blob.is_none() => blob = Some(chunk),
            _ => {}
        }
        at += 8 + size as usize;
        if at >= length {
            break;
        }
    }
    match json {
        Some(json) => Ok((json, blob)),
        None => bail!("GLB: it has no chunk of JSON; it is damaged"),
    }
}

/// The error for a text that is no document.
fn unreadable(text: &[u8], error: &json::Error) -> anyhow::Error {
    let value: Option<Value> = from_slice(text).ok();
    // In glTF 1.0 elements have names and not numbers.
    let version = value.as_ref().and_then(|value| value.get("asset")?.get("version")?.as_str());
    if let Some(version) = version.filter(|version| version.starts_with("1.")) {
        return anyhow!("glTF {}; export it as glTF 2.0", quoted(version));
    }
    if value.as_ref().is_some_and(|value| value.get("asset").is_none()) {
        return anyhow!("text in JSON and no glTF: it has no `asset`; export the model as glTF 2.0");
    }
    let remedy = if error.is_eof() { "; it was cut off" } else { "" };
    anyhow!("glTF: {error}{remedy}")
}

/// Passes a document in which all that is read is there. Some of what a specification demands is not read, and may be missing.
fn check(root: &Root) -> Result<()> {
    // The library's check looks positions up before it has checked their number.
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|primitive| primitive.attributes.get(&Checked::Valid(Semantic::Positions)));
    if let Some(index) = positions.map(|index| index.value()).find(|&index| index >= root.accessors.len()) {
        bail!("glTF: positions of a mesh are accessor {index}, but there are {}; the file is damaged", root.accessors.len());
    }
    let mut faults = Vec::new();
    root.validate(root, json::Path::new, &mut |path, error| {
        let path = path();
        let path = path.as_str();
        let is_unread = ["extensionsRequired", "animations", "cameras"].iter().any(|part| path.starts_with(part));
        // A compressed mesh has its bytes elsewhere; the box of its positions is not needed.
        let may_miss = path.ends_with("].bufferView") && path.starts_with("accessors") || path.ends_with(".min") || path.ends_with(".max");
        let leads_nowhere = matches!(error, Error::IndexOutOfBounds);
        if !is_unread && (leads_nowhere || !may_miss) {
            faults.push(format!("{path}: {}", in_words(error)));
        }
    });
    if let Some((first, others)) = faults.split_first() {
        let named = [first].into_iter().chain(others.iter().take(NAMED - 1)).cloned().collect::<Vec<_>>().join("; ");
        let more = others.len().saturating_sub(NAMED - 1);
        bail!("glTF: {named}{}; the file is damaged", if more > 0 { format!("; and {more} more") } else { String::new() });
    }
    Ok(())
}

const fn in_words(error: Error) -> &'static str {
    match error {
        Error::IndexOutOfBounds => "there is no element of this number",
        Error::Invalid => "the value is not possible",
        Error::Missing => "the value is missing",
        Error::Oversize => "the number is too large",
        Error::Unsupported => "the extension is not read",
    }
}
