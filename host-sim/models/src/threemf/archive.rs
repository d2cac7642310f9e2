//! The parts of a 3MF file, which is an archive of zip (Open Packaging Conventions).
//!
//! An archive may come from anybody. Parts are found by their names in the archive alone, and are unpacked to memory, never to a folder. Their bytes
//! are limited, because a small archive can unpack to any size.

use super::xml::{Attribute, attributes};
use crate::{fields::quoted, files::LARGEST_FILE, number::grouped, text};
use anyhow::{Context, Result, bail, ensure};
use flate2::bufread::DeflateDecoder;
use quick_xml::{Reader, events::Event};
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};
use std::{collections::HashMap, io::Read};

/// Beginnings of archives, of which the second has nothing in it.
const BEGINNINGS: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];
/// The usual name of the main model.
const USUAL: &str = "3D/3dmodel.model";
/// The part that names the main model.
const RELATIONS: &str = "_rels/.rels";
/// How the type of the relation to the main model ends.
const TO_MODEL: &str = "/3dmodel";
/// Most bytes of relations, of which a file has a few lines.
const LARGEST_RELATIONS: u64 = 1 << 20;

/// A part as it is packed.
struct Packed {
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    is_encrypted: bool,
}

/// An archive, and how much may still be unpacked.
pub(super) struct Archive<'a> {
    archive: ZipSliceArchive<&'a [u8]>,
    /// The parts, by names as [`key`] makes them.
    parts: HashMap<String, Packed>,
    room: u64,
}

/// Whether a file is an archive.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    BEGINNINGS.iter().any(|beginning| bytes.starts_with(beginning))
}

/// Whether a part of an archive is a model. Of an archive that was cut off, only the beginning is searched.
pub(super) fn has_model(bytes: &[u8]) -> bool {
    match Archive::open(bytes) {
        Ok(archive) => archive.parts.keys().any(|name| name.ends_with(".model")),
        Err(_) => bytes[..bytes.len().min(1 << 16)].windows(USUAL.len()).any(|part| part.eq_ignore_ascii_case(USUAL.as_bytes())),
    }
}

/// A name by which parts are compared: without a slash at its beginning, and in small letters, as the conventions compare names.
pub(super) fn key(name: &str) -> String {
    name.trim().replace('\\', "/").trim_start_matches('/').to_ascii_lowercase()
}

impl<'a> Archive<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        ensure!(is_archive(bytes), "the file is no zip archive, as 3MF is; give it the ending of its format, or export it again");
        let damaged = "the archive is damaged or cut off; get the file again";
        let archive = ZipArchive::from_slice(bytes).ok().context(damaged)?;
        let mut parts = HashMap::new();
        for entry in archive.entries() {
            let entry = entry.ok().context(damaged)?;
            let packed =
                Packed { place: entry.wayfinder(), method: entry.compression_method(), is_encrypted: entry.flags().is_encrypted() };
            parts.insert(key(&String::from_utf8_lossy(entry.file_path().as_bytes())), packed);
        }
        Ok(Self { archive, parts, room: LARGEST_FILE })
    }

    /// The archive, of which only so many bytes are unpacked.
    #[cfg(test)]
    pub(super) fn with_room(self, room: u64) -> Self {
        Self { room, ..self }
    }

    /// Unpacks a part.
    ///
    /// # Errors
    /// When there is no such part, or it cannot be unpacked, or is too large.
    pub(super) fn read(&mut self, name: &str) -> Result<Vec<u8>> {
        let bytes = self.limited(name, self.room)?;
        self.room -= bytes.len() as u64;
        Ok(bytes)
    }

    fn limited(&self, name: &str, most: u64) -> Result<Vec<u8>> {
        let shown = quoted(name);
        let Some(Packed { place, method, is_encrypted }) = self.parts.get(&key(name)) else {
            bail!("the part {shown} is missing in the archive; export the model again")
        };
        ensure!(!is_encrypted, "the part {shown} is encrypted; save the model without a password");
        let damaged = || format!("the part {shown} is damaged; get the file again");
        let too_large = || {
            let most = grouped(LARGEST_FILE);
            format!("the part {shown} makes the model larger than {most} bytes when it is unpacked; simplify it in another program")
        };
        ensure!(place.uncompressed_size_hint() <= most, too_large());
        let entry = self.archive.get_entry(*place).ok().with_context(damaged)?;
        // One byte more than is allowed tells that there is more.
        let unpacked = |reader: &mut dyn Read| {
            let mut bytes = Vec::new();
            reader.take(most.saturating_add(1)).read_to_end(&mut bytes).ok().map(|_| bytes)
        };
        let bytes = match *method {
            CompressionMethod::STORE => unpacked(&mut entry.verifying_reader(entry.data())),
            CompressionMethod::DEFLATE => unpacked(&mut entry.verifying_reader(DeflateDecoder::new(entry.data()))),
            other => bail!(
                "the part {shown} is compressed by {}; 3MF has parts that are compressed by Deflate or not at all: export the model again",
                other.name().map_or_else(|| format!("method {}", other.as_u16()), str::to_owned)
            ),
        };
        let bytes = bytes.with_context(damaged)?;
        ensure!(bytes.len() as u64 <= most, too_large());
        Ok(bytes)
    }

    /// The name of the main model: by the relation to it, or else the usual name.
    pub(super) fn main_model(&self) -> Result<String> {
        let related = self.limited(RELATIONS, LARGEST_RELATIONS).ok().and_then(|bytes| target(&text::decoded(&bytes)));
        let name = related.filter(|name| self.parts.contains_key(&key(name))).unwrap_or_else(|| USUAL.to_owned());
        ensure!(
            self.parts.contains_key(&key(&name)),
            "the archive has no model, which is a part such as {USUAL}; if another model is in it, unpack it, or else export it again"
        );
        Ok(name.trim_start_matches('/').to_owned())
    }
}

/// The target of the relation to the main model. Nothing is told of what is wrong here, because the model may have its usual name.
fn target(relations: &str) -> Option<String> {
    let mut reader = Reader::from_str(relations);
    loop {
        let (Event::Start(tag) | Event::Empty(tag)) = (match reader.read_event().ok()? {
            Event::Eof => return None,
            event => event,
        }) else {
            continue;
        };
        let [kind, target] = attributes(&tag, ["Type", "Target"]).ok()?;
        if kind.is_some_and(|kind| kind.text().ends_with(TO_MODEL)) {
            return target.map(|target: Attribute<'_>| target.text().into_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rawzip::ZipArchiveWriter;
    use std::io::Write;

    /// An archive of two parts of blanks.
    fn of_blanks(count: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut archive = ZipArchiveWriter::new(&mut bytes);
        for name in ["a.model", "b.model"] {
            let (mut entry, config) = archive.new_file(name).compression_method(CompressionMethod::DEFLATE).start().unwrap();
            let mut writer = config.wrap(flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::fast()));
            writer.write_all(&vec![b' '; count]).unwrap();
            let (encoder, descriptor) = writer.finish().unwrap();
            encoder.finish().unwrap();
            entry.finish(descriptor).unwrap();
        }
        archive.finish().unwrap();
        bytes
    }

    /// All parts together are limited, also where the directory of the archive says that they are smaller.
    #[test]
    fn no_more_is_unpacked_than_is_allowed() {
        let mut bytes = of_blanks(100_000);
        assert!(bytes.len() < 2_000);
        let read = |bytes: &[u8], room| {
            let mut archive = Archive::open(bytes).unwrap().with_room(room);
            ["a.model", "/B.model"].map(|name| archive.read(name).map(|part| part.len()).map_err(|error| error.to_string()))
        };
        assert_eq!(read(&bytes, 200_000), [Ok(100_000), Ok(100_000)]);
        let [one, other] = read(&bytes, 199_999);
        assert_eq!(one, Ok(100_000));
        assert!(other.unwrap_err().starts_with("the part /B.model makes the model larger than"));
        let sizes: Vec<_> = bytes.windows(4).enumerate().filter(|(_, word)| *word == b"PK\x01\x02").map(|(at, _)| at + 24).collect();
        sizes.into_iter().for_each(|at| bytes[at..at + 4].copy_from_slice(&7u32.to_le_bytes()));
        assert!(read(&bytes, 200_000)[0].as_ref().unwrap_err().ends_with("is damaged; get the file again"));
        assert!(read(&bytes, 50_000)[0].is_err());
    }
}
