//! Files of formats that are not read: recognised, so that an error can say what they are and what helps.

use anyhow::{Result, bail, ensure};
use microphong::stream::record::MAGIC;
use std::path::Path;

/// What helps with a file of a format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Remedy {
    /// A modelling program or `assimp` makes an OBJ of it.
    Model,
    /// A modelling program makes an OBJ of it, and `assimp` does not.
    Scene,
    /// The file has surfaces and no triangles.
    Cad,
    /// Another file is in the file. The command unpacks it, with the name of the file in place of `IN` and of a mesh in place of `OUT`.
    Packed(&'static str),
    /// There is no more to say than this advice.
    Advice(&'static str),
}
use Remedy::{Advice, Cad, Model, Packed, Scene};

/// A format, and what helps.
type Format = (&'static str, Remedy);

/// Endings of files that are not known by their contents, or not always.
const ENDINGS: [(&[&str], Format); 17] = [
    (&["fbx"], ("FBX", Model)),
    (&["dae"], ("COLLADA", Model)),
    (&["3ds"], ("3DS", Model)),
    (&["off"], ("OFF", Model)),
    (&["blend"], ("Blender", Model)),
    (&["x3d"], ("X3D", Model)),
    (&["amf"], ("AMF", Model)),
    (&["lwo"], ("LightWave", Model)),
    (&["wrl", "vrml"], ("VRML", Scene)),
    (&["usd", "usda", "usdc", "usdz"], ("USD", Scene)),
    (&["max"], ("3ds Max", Scene)),
    (&["ma", "mb"], ("Maya", Scene)),
    (&["c4d"], ("Cinema 4D", Scene)),
    (&["step", "stp"], ("STEP", Cad)),
    (&["iges", "igs"], ("IGES", Cad)),
    (&["skp"], ("SketchUp", Cad)),
    (&["3dm", "sldprt", "sldasm", "ipt", "iam", "prt", "catpart", "f3d", "fcstd", "dwg", "dxf", "brep"], ("a CAD program", Cad)),
];

/// Beginnings of files, after white space and a byte order mark. Letters are compared in any capitals.
const BEGINNINGS: [(&[u8], Format); 28] = [
    (b"Kaydara FBX", ("FBX", Model)),
    (b"; FBX", ("FBX", Model)),
    (b"BLENDER", ("Blender", Model)),
    (b"ISO-10303-21", ("STEP", Cad)),
    (b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0U\0p", ("SketchUp", Cad)),
    (b"3D Geometry File Format", ("Rhino", Cad)),
    (b"AC10", ("DWG", Cad)),
    (b"#VRML", ("VRML", Scene)),
    (b"#usda", ("USD", Scene)),
    (b"PXR-USDC", ("USD", Scene)),
    (b"//Maya", ("Maya", Scene)),
    (b"DRACO", ("a mesh compressed by Draco, outside of a glTF file", Advice("decode it to OBJ or PLY with draco_decoder"))),
    (b"version https://git-lfs.github.com/", POINTER),
    (b"version https://hawser.github.com/", POINTER),
    (b"\x1F\x8B", ("gzip", Packed("gunzip -c IN > OUT"))),
    (b"BZh", ("bzip2", Packed("bunzip2 -c IN > OUT"))),
    (b"\xFD7zXZ\0", ("xz", Packed("xz -dc IN > OUT"))),
    (b"\x28\xB5\x2F\xFD", ("Zstandard", Packed("zstd -dc IN > OUT"))),
    (b"7z\xBC\xAF\x27\x1C", ("7-Zip", Packed("7z x IN"))),
    (b"Rar!\x1A\x07", ("RAR", Packed("unrar x IN"))),
    (b"PK\x03\x04", ("zip", Packed("unzip IN"))),
    (b"PK\x05\x06", ("zip", Packed("unzip IN"))),
    (b"%PDF", ("a document (PDF)", NO_MODEL)),
    (b"\x89PNG", ("a picture (PNG)", NO_MODEL)),
    (b"\xFF\xD8\xFF", ("a picture (JPEG)", NO_MODEL)),
    (b"GIF8", ("a picture (GIF)", NO_MODEL)),
    (b"\x7FELF", ("a program", NO_MODEL)),
    (b"newmtl ", (MATERIALS, Advice("name the .obj file"))),
];

const MATERIALS: &str = "the materials of an .obj file (MTL), and no mesh";
const NO_MODEL: Remedy = Advice("name the file of a model");
const POINTER: Format =
    ("a pointer of Git LFS, which stands for the file", Advice("run `git lfs pull` in its repository, which gets the file itself"));
const WEB_PAGE: Format = ("a web page (HTML)", Advice("download the model itself, not the page that shows it"));

/// Elements by which texts in XML are known.
const ELEMENTS: [(&str, Format); 6] = [
    ("<collada", ("COLLADA", Model)),
    ("<x3d", ("X3D", Model)),
    ("<amf", ("AMF", Model)),
    ("<!doctype html", WEB_PAGE),
    ("<html", WEB_PAGE),
    ("<svg", ("a picture (SVG)", NO_MODEL)),
];

/// Passes what may be a mesh of a format that is read, by its contents. It may have another ending than formats that are not read have.
///
/// # Errors
/// Names the file, what it is, and what makes a mesh of it.
pub(crate) fn refuse(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some((format, remedy)) = by_content(path, bytes) {
        bail!("{}", said(path, format, remedy));
    }
    if is_utf_16(bytes) {
        bail!("{}: text in UTF-16; save it as UTF-8 or ASCII", path.display());
    }
    if bytes.iter().all(|&byte| byte == 0) && !bytes.is_empty() {
        bail!("{}: all its {} bytes are zero; get the file again", path.display(), crate::number::grouped(bytes.len()));
    }
    Ok(())
}

/// Passes what is no stream.
///
/// # Errors
/// Names the file, and says that it is finished.
pub(crate) fn refuse_stream(path: &Path, bytes: &[u8]) -> Result<()> {
    ensure!(
        !bytes.starts_with(&MAGIC),
        "{}: a stream of microphong, which is converted already; give it the ending .tri, and every command takes it",
        path.display()
    );
    Ok(())
}

/// Passes names that formats which are not read do not have.
///
/// # Errors
/// As for [`refuse`].
pub(crate) fn refuse_ending(path: &Path) -> Result<()> {
    match by_ending(path) {
        Some((format, remedy)) => bail!("{}", said(path, format, remedy)),
        None => Ok(()),
    }
}

/// What a file is and what helps, for a file that is no mesh but one that a mesh names.
pub(crate) fn what_it_is(path: &Path, bytes: &[u8]) -> Option<String> {
    let other = by_content(path, bytes).filter(|(format, _)| *format != MATERIALS);
    other
        .map(|(format, remedy)| said(path, format, remedy))
        .or_else(|| is_utf_16(bytes).then(|| format!("{}: text in UTF-16; save it as UTF-8 or ASCII", path.display())))
}

fn said(path: &Path, format: &str, remedy: Remedy) -> String {
    let name = path.display();
    let other = |ending: &str| {
        let other = path.with_extension(ending);
        if other == path { path.with_extension(format!("new.{ending}")) } else { other }
    };
    let needed = "OBJ, glTF, STL, PLY or 3MF is needed";
    match remedy {
        Model => format!(
            "{name}: a mesh in the format {format}; {needed}: export it as OBJ, for example with Blender, or run\n  assimp export {name} {}",
            other("obj").display()
        ),
        Scene => format!("{name}: a scene in the format {format}; {needed}: export it as glTF or OBJ, for example with Blender"),
        Cad => {
            let format = if format.starts_with("a ") { "a format of a CAD program".to_owned() } else { format!("{format}, a CAD format") };
            format!("{name}: {format}, which has surfaces and no triangles; export it as STL, OBJ or glTF, for example with FreeCAD")
        }
        Packed(command) => {
            // The name without the ending of the compression, as `a.obj` of `a.obj.gz`.
            let inner = path.with_extension("");
            let inner = if inner.extension().is_some() { inner } else { other("obj") };
            let command = command.replace("IN", &name.to_string()).replace("OUT", &inner.display().to_string());
            format!("{name}: compressed by {format}; unpack it first:\n  {command}")
        }
        Advice(advice) => format!("{name}: {format}; {advice}"),
    }
}

fn by_content(path: &Path, bytes: &[u8]) -> Option<Format> {
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
    let begins =
        |start: &[u8]| [text, bytes].iter().any(|text| text.get(..start.len()).is_some_and(|text| text.eq_ignore_ascii_case(start)));
    if let Some(&(_, format)) = BEGINNINGS.iter().find(|(start, _)| begins(start)) {
        let is_packed = matches!(format.1, Packed(_));
        // Some formats are archives, and have the ending of the format.
        return Some(by_ending(path).filter(|_| is_packed).unwrap_or(format));
    }
    if text.starts_with(b"<") {
        let head = String::from_utf8_lossy(&text[..text.len().min(4096)]).to_lowercase();
        let known = ELEMENTS.iter().find(|(element, _)| head.contains(element)).map(|&(_, format)| format);
        return known.or(Some(("a text in XML", NO_MODEL)));
    }
    if let Some(format) = stored_link(text) {
        return Some(format);
    }
    if is_iges(bytes) {
        return Some(("IGES", Cad));
    }
    if is_3ds(bytes) {
        return Some(("3DS", Model));
    }
    let mut words = text.get(..text.len().min(64))?.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    match [words.next()?, words.next()?] {
        [b"OFF" | b"COFF" | b"NOFF" | b"STOFF", number] if number.iter().all(|b| b.is_ascii_digit() || *b == b'#') => Some(("OFF", Model)),
        [b"0", b"SECTION"] | [b"999", _] => Some(("DXF", Cad)),
        _ => None,
    }
}

/// The path of another file, as Git stores a link where links are not possible.
fn stored_link(text: &[u8]) -> Option<Format> {
    let path = str::from_utf8(text.get(..text.len().min(1024))?).ok()?.trim();
    let is_path = path.contains('/') && !path.contains(|c: char| c.is_whitespace() || "{}\"<>|*?".contains(c)) && text.len() <= 1024;
    let of_annex = ("a pointer of git-annex, which stands for the file", Advice("run `git annex get` in its repository"));
    let of_link = ("the path of another file, as Git stores a link", Advice("name that file"));
    is_path.then_some(if path.contains("annex/objects/") { of_annex } else { of_link })
}

fn by_ending(path: &Path) -> Option<Format> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    ENDINGS.iter().find(|(known, _)| known.contains(&ending.as_str())).map(|&(_, format)| format)
}

/// Lines of 80 characters, the first with the letter of the section at the end and a number behind it.
fn is_iges(bytes: &[u8]) -> bool {
    let line = bytes.split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or_default();
    line.len() == 80 && line.get(72) == Some(&b'S') && line[73..].trim_ascii().iter().all(u8::is_ascii_digit) && line[79].is_ascii_digit()
}

/// A main chunk that is as long as the file.
fn is_3ds(bytes: &[u8]) -> bool {
    let length = bytes.get(2..).and_then(|rest| rest.first_chunk()).map(|&length| u32::from_le_bytes(length));
    bytes.starts_with(b"MM") && length.is_some_and(|length| length as usize == bytes.len())
}

/// Text in which every second byte is zero, with or without a mark.
fn is_utf_16(bytes: &[u8]) -> bool {
    let is_marked = [b"\xFF\xFE", b"\xFE\xFF"].iter().any(|mark| bytes.starts_with(*mark));
    let pairs = bytes[..bytes.len().min(64)].as_chunks::<2>().0;
    let is_text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    let are_alike = |low: usize| pairs.iter().all(|pair| pair[1 - low] == 0 && is_text(pair[low]));
    is_marked || pairs.len() >= 8 && (are_alike(0) || are_alike(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn told(name: &str, bytes: &[u8]) -> String {
        let error = refuse(Path::new(name), bytes).and_then(|()| refuse_ending(Path::new(name))).unwrap_err();
        format!("{error:#}")
    }

    #[test]
    fn each_beginning_says_what_the_file_is() {
        for (start, (format, remedy)) in BEGINNINGS {
            for name in ["a", "a.obj", "a.stl", "a.glb"] {
                let said = told(name, &[start, b"\0 and more"].concat());
                assert!(said.starts_with(&format!("{name}: ")) && said.contains(format), "{said}");
                let advice = match remedy {
                    Model => "assimp export",
                    Scene => "Blender",
                    Cad => "FreeCAD",
                    Packed(command) => command.split(' ').next().unwrap_or_default(),
                    Advice(advice) => advice,
                };
                assert!(said.contains(advice), "{said}");
            }
        }
        for (element, (format, _)) in ELEMENTS {
            let said = told("a.obj", format!("\u{FEFF}\n<?xml version=\"1.0\"?>\n{} >", element.to_uppercase()).as_bytes());
            assert!(said.contains(format), "{said}");
        }
        for (endings, (format, _)) in ENDINGS {
            endings.iter().for_each(|ending| assert!(told(&format!("a.{}", ending.to_uppercase()), b"?").contains(format), "{ending}"));
        }
    }

    #[test]
    fn archives_and_remedies_have_names_that_fit() {
        assert!(told("a.obj.gz", b"\x1F\x8B").ends_with("compressed by gzip; unpack it first:\n  gunzip -c a.obj.gz > a.obj"));
        assert!(told("a.obj", b"\x1F\x8B").ends_with("  gunzip -c a.obj > a.new.obj"));
        assert!(told("a.zip", b"PK\x03\x04\0").ends_with("unzip a.zip"));
        assert!(told("a.blend", b"\x28\xB5\x2F\xFD").contains("in the format Blender"));
        assert!(told("a.usdz", b"PK\x03\x04\0").contains("USD"));
    }

    #[test]
    fn contents_without_a_beginning_are_known_as_well() {
        let iges = format!("{:72}S{:>7}\n", "a part", 1);
        assert!(told("a.obj", iges.as_bytes()).contains("IGES, a CAD format"));
        assert!(told("a.obj", b"MM\x08\0\0\0\0\0").contains("3DS"));
        assert!(told("a.obj", b"OFF\n8 6 0\n").contains("OFF"));
        assert!(told("a.obj", b"  0\r\nSECTION\r\n").contains("DXF, a CAD format"));
        assert!(told("a.obj", b"/annex/objects/MD5E-s9--0.obj\n").contains("git annex get"));
        assert!(told("a.obj", b"../other/a.obj").contains("the path of another file, as Git stores a link; name that file"));
        assert!(told("a.obj", &[0; 12]).contains("all its 12 bytes are zero"));
        let stream = [&MAGIC[..], b"\0"].concat();
        refuse(Path::new("a.bin"), &stream).unwrap();
        assert!(format!("{:#}", refuse_stream(Path::new("a.obj"), &stream).unwrap_err()).contains("a stream of microphong"));
        for text in ["v 0 0 0\nv 1 0 0\n", "solid a\nfacet normal"] {
            let wide: Vec<u8> = text.bytes().flat_map(|byte| [byte, 0]).collect();
            assert!(
                told("a.obj", &wide).contains("UTF-16") && told("a.obj", &[b"\0", &wide[..wide.len() - 1]].concat()).contains("UTF-16")
            );
        }
        for text in ["", "v 0 0 0", "# <html>\nv 0 0 0", "o OFF\n", "solid ISO-10303-21", "0 1", "MM"] {
            refuse(Path::new("a.obj"), text.as_bytes()).unwrap();
        }
    }
}
