//! Reads a mesh and its materials from files.

pub use crate::contents::Colours;
use crate::{
    backs::{self, Sides},
    coat::TextureSize,
    contents::Contents,
    faults::{COMPUTED_NORMAL, TURNED},
    fields::quoted,
    files::{Files, Folder, Missing},
    foreign, gltf,
    look::Surface,
    mesh::{self, Mesh, Report, Submesh, Weld},
    mtl, names,
    number::grouped,
    obj::{self, Obj},
    paint::{self, Emission, Painted},
    ply::{self, Ply},
    stl::{self, Stl},
    text,
    texture::{Image, Images, Texture},
    threemf,
};
use anyhow::{Context, Result, bail};
use std::{collections::HashMap, path::Path, sync::Arc};

/// A mesh from a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The mesh.
    pub mesh: Mesh,
    /// A report on welding.
    pub report: Report,
    /// Names of the objects by which the mesh counts, all different; none if the file names no object.
    pub objects: Vec<String>,
    /// The materials of the file, by which the mesh counts; `None` where it does not say what a material is.
    pub materials: Vec<Option<mtl::Material>>,
    /// Wrong elements of the file that are left out or mended, in sentences.
    pub faults: Vec<String>,
    /// Remarks on the file for the user, in sentences; those on wrong elements are among them.
    pub remarks: Vec<String>,
    /// The colours and textures that triangles have.
    pub painted: Painted,
    /// Number of triangles that are backs of others.
    pub backs: usize,
}

/// Converts the materials of a mesh to those of a stream, under ambient light from 0 to 1. Values that the file does not define are taken from
/// `other`.
#[must_use]
pub fn surfaces(materials: &[Option<mtl::Material>], other: &Surface, ambient_light: f64) -> Vec<Surface> {
    materials.iter().map(|material| material.as_ref().map_or(*other, |material| material.surface(ambient_light))).collect()
}

/// What is passed of a file, beyond what is right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// Wrong elements are errors, even if the rest of the mesh can be drawn without them.
    pub strict: bool,
    /// A model may name files outside its folder.
    pub allow_outside: bool,
    /// What becomes of the colours of textures and vertices.
    pub colours: Colours,
    /// The largest width and height of textures.
    pub texture_size: TextureSize,
    /// Which triangles have backs.
    pub sides: Sides,
    /// Nothing is seen through surfaces, and textures have no holes.
    pub opaque: bool,
}

/// Reads and welds an OBJ file with the files of its materials beside it, a glTF file with the buffers beside it, an STL, a PLY or a 3MF file.
///
/// # Errors
/// Names the file and the place in it.
pub fn file(path: &Path, weld: Weld) -> Result<Imported> {
    file_by(path, weld, Rules::default())
}

/// Reads and welds a file as [`file()`] does, by these rules.
///
/// # Errors
/// Names the file and the place in it.
pub fn file_by(path: &Path, weld: Weld, rules: Rules) -> Result<Imported> {
    file_from(&Files::OnDisk, path, weld, rules)
}

/// Reads and welds a file as [`file_by()`] does, from these files. The files that it names are taken from them as well.
///
/// # Errors
/// Names the file and the place in it.
pub fn file_from(files: &Files, path: &Path, weld: Weld, rules: Rules) -> Result<Imported> {
    welded(path, &files.read(path)?, &Folder::of(files, path, rules.allow_outside), weld, rules)
}

/// Reads and welds a file that is in memory, as [`file_by()`] does. The files that it names are taken from `beside`, by their names, and from nowhere else.
///
/// # Errors
/// Names the file and the place in it.
pub fn bytes_by(path: &Path, bytes: &[u8], beside: &[(&str, &[u8])], weld: Weld, rules: Rules) -> Result<Imported> {
    let files = Files::in_memory(beside.iter().map(|&(name, bytes)| (name.to_owned(), bytes.to_vec())));
    welded(path, bytes, &Folder::of(&files, Path::new(""), false), weld, rules)
}

fn welded(path: &Path, bytes: &[u8], folder: &Folder, weld: Weld, rules: Rules) -> Result<Imported> {
    made_of(contents(path, bytes, folder, rules.colours)?, &path.display().to_string(), weld, rules)
}

/// Makes a mesh of the contents of a file, which has this name.
///
/// # Errors
/// Names the file, and what is wrong with it.
pub(crate) fn made_of(contents: Contents, name: &str, weld: Weld, rules: Rules) -> Result<Imported> {
    let Contents { soup, objects, mut materials, mut textures, emissions, mut ignored, mut faults, mut remarks } = contents;
    if rules.opaque {
        materials.iter_mut().flatten().for_each(|material| material.transparency = 0.0);
        textures = textures.into_iter().map(|texture| Some(texture?.cut(0.0))).collect();
    }
    let (mut mesh, sources, report) = mesh::weld_with_sources(&soup, weld).with_context(|| name.to_owned())?;
    // Without colours, all light is as white surfaces have it.
    let of_colours = if rules.colours == Colours::None { &[] } else { &sources[..] };
    let emitted = paint::emit(&mesh, of_colours, &soup, &mut materials, &textures, &emissions);
    let painted = match rules.colours {
        Colours::None => Painted::default(),
        Colours::Corners => paint::paint(&mut mesh, sources, &soup, &mut materials, &textures, None),
        Colours::Texture => paint::paint(&mut mesh, sources, &soup, &mut materials, &textures, Some(rules.texture_size)),
    };
    let has_two_sides = |submesh: Submesh| match rules.sides {
        Sides::OfFile => materials[submesh.material].as_ref().is_some_and(|material| material.two_sided),
        Sides::One => false,
        Sides::Two => true,
    };
    let backs = backs::add(&mut mesh, has_two_sides);
    remarks.extend(painted.sentences());
    remarks.extend(emitted.sentence());
    remarks.extend(hardly_seen(&materials));
    remarks.extend(backs::sentence(backs, rules.sides));
    ignored.extend(emitted.is_left_out.then_some("light that materials send out by a texture"));
    if !painted.has_any() {
        ignored.extend((!soup.colours.is_empty()).then_some("colours of vertices"));
        ignored.extend(textures.iter().any(Option::is_some).then_some("textures"));
        let say_where_light_is = emissions.iter().any(|emission| matches!(emission, Emission::By(_)));
        ignored.extend((!soup.places.is_empty() && !say_where_light_is).then_some("texture coordinates"));
    }
    faults.add_several(COMPUTED_NORMAL, report.computed_normals, || format!("face {}", report.first_computed));
    faults.add_several(TURNED, report.mended, || format!("face {}", report.first_mended));
    if report.missing_normals > 0 {
        let count = grouped(report.missing_normals);
        remarks.push(format!("normals of {count} corners are computed, because the file has none there; the others are those of the file"));
    }
    let faults: Vec<String> = faults.sentences().collect();
    if let Some(fault) = faults.first().filter(|_| rules.strict) {
        bail!("{name}: {fault}; --strict refuses it: repair the file, or convert it without --strict");
    }
    remarks.splice(0..0, faults.iter().cloned());
    if !ignored.is_empty() {
        remarks.push(format!("left out: {}", ignored.into_iter().collect::<Vec<_>>().join(", ")));
    }
    let objects = names::distinct(objects, &mut remarks);
    Ok(Imported { mesh, report, objects, materials, faults, remarks, painted, backs })
}

/// The transparency from which a material counts as hardly seen: a stream has sixteenths.
const HARDLY_SEEN: f64 = 31.0 / 32.0;

/// A sentence on materials that are drawn although the file makes them invisible.
fn hardly_seen(materials: &[Option<mtl::Material>]) -> Option<String> {
    let is_hardly_seen = |material: &&mtl::Material| material.transparency >= HARDLY_SEEN;
    let names: Vec<_> = materials.iter().flatten().filter(is_hardly_seen).map(|material| quoted(&material.name)).collect();
    let names = names.join(", ");
    (!names.is_empty()).then(|| {
        format!("the file makes these materials invisible, and they are drawn with an opacity of 1/16: {names}; --opaque draws them whole")
    })
}

/// Chooses the reader by how the file begins, or where that says nothing, by the ending of its name.
fn contents(path: &Path, bytes: &[u8], folder: &Folder, colours: Colours) -> Result<Contents> {
    let place = || path.display().to_string();
    let ends = |ending| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    let plain = Contents { materials: vec![None], ..Contents::default() };
    // Of archives, which are refused otherwise, only these are read.
    if threemf::is_3mf(bytes, ends("3mf")) {
        return threemf::parse(bytes, colours).with_context(place);
    }
    foreign::refuse(path, bytes)?;
    foreign::refuse_stream(path, bytes)?;
    if ply::is_ply(bytes) || ends("ply") {
        let Ply { soup, ignored, faults } = ply::parse(bytes).with_context(place)?;
        return Ok(Contents { soup, ignored, faults, ..plain });
    }
    if gltf::is_gltf(bytes) || ends("gltf") || ends("glb") {
        return gltf::parse(bytes, folder, colours).with_context(place);
    }
    if ends("3mf") {
        return threemf::parse(bytes, colours).with_context(place);
    }
    foreign::refuse_ending(path)?;
    if stl::is_stl(bytes, ends("stl")) {
        let Stl { soup, faults, ignored, remarks } = stl::parse(bytes).with_context(place)?;
        return Ok(Contents { soup, faults, ignored, remarks, ..plain });
    }
    let obj = obj::parse(&text::decoded(bytes)).with_context(place)?;
    if obj.soup.positions.is_empty() && obj.soup.faces.is_empty() {
        let what = if bytes.is_empty() { "the file is empty" } else { "nothing in the file is OBJ, glTF, STL, PLY or 3MF" };
        bail!("{}: the mesh has no faces, because {what}; export it as one of OBJ, glTF, STL, PLY and 3MF", place());
    }
    with_libraries(folder, obj, colours).with_context(place)
}

/// An OBJ file with the materials of the files that it names.
fn with_libraries(folder: &Folder, obj: Obj, colours: Colours) -> Result<Contents> {
    let Obj { soup, objects, materials: names, libraries, mut ignored, faults, mut remarks } = obj;
    let mut known = Vec::new();
    if names.iter().any(Option::is_some) {
        for library in libraries {
            for name in files_of(&library, folder) {
                // A mesh is of use without its materials.
                let (path, bytes) = match folder.read(&name) {
                    Ok(file) => file,
                    Err(error) => {
                        let missing = error.downcast_ref::<Missing>().map(|Missing(path)| path.display());
                        remarks.push(missing.map_or_else(
                            || format!("the materials are missing: {error:#}"),
                            |path| format!("{path} cannot be read; to have its materials, put it beside the mesh"),
                        ));
                        continue;
                    }
                };
                if let Some(other) = foreign::what_it_is(&path, &bytes) {
                    remarks.push(format!("the materials are missing: {other}"));
                    continue;
                }
                let mtl = mtl::parse(&text::decoded(&bytes)).with_context(|| path.display().to_string())?;
                known.extend(mtl.materials);
                ignored.extend(mtl.ignored);
            }
        }
    }
    let numbers = Names::of(&known);
    let material = |name: &Option<String>| known.get(numbers.find(name.as_ref()?)?).cloned();
    let materials: Vec<_> = names.iter().map(material).collect();
    let unknown: Vec<_> =
        names.iter().zip(&materials).filter(|(_, known)| known.is_none()).filter_map(|(name, _)| name.as_deref()).collect();
    if !unknown.is_empty() {
        remarks.push(format!("materials that no file defines have the colour of the command line: {}", unknown.join(", ")));
    }
    let images = &mut Images::default();
    let emission = |material: &Option<mtl::Material>| {
        let Some(name) = material.as_ref().and_then(|material| material.emission_texture.as_ref()) else { return Emission::Even };
        let texture = (colours != Colours::None).then(|| texture(name, images, folder, &mut remarks)).flatten();
        texture.map_or(Emission::Unread, Emission::By)
    };
    let emissions = materials.iter().map(emission).collect();
    let textures = match colours {
        Colours::None => {
            let has_texture = |material: &mtl::Material| material.texture.is_some() || material.mask.is_some();
            ignored.extend(materials.iter().flatten().any(has_texture).then_some("textures"));
            Vec::new()
        }
        Colours::Corners | Colours::Texture => {
            let of = |material: &Option<mtl::Material>| {
                let mtl::Material { texture: colour, mask, .. } = material.as_ref()?;
                let mut named = |name: &Option<String>| texture(name.as_ref()?, images, folder, &mut remarks);
                let (colour, mask) = (named(colour), named(mask));
                if mask.is_none() && colour.as_ref().is_some_and(|texture| texture.image.has_opacity()) {
                    ignored.insert("opacity of textures of colour that no map_d names");
                }
                let Some(mask) = mask else { return colour };
                let white = Arc::new(Image::of_colour([1.0; 3]));
                let image = colour.map_or(white, |texture| texture.image);
                Some(Texture { image: Arc::new(image.with_opacity(&mask.image).cut(0.5)), ..mask })
            };
            materials.iter().map(of).collect()
        }
    };
    Ok(Contents { soup, objects, materials, textures, emissions, ignored, faults, remarks })
}

/// A texture of this name, or nothing if it cannot be read, which is said.
fn texture(name: &str, images: &mut Images, folder: &Folder, remarks: &mut Vec<String>) -> Option<Texture> {
    // Rows of an image count from the top, and places from the bottom.
    let transform = [[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]];
    let left_out = |error| remarks.push(format!("the texture {} is left out: {error:#}", quoted(name)));
    let image = images.read(name, || folder.read(name).map(|(_, bytes)| bytes), left_out)?;
    Some(Texture { image, transform })
}

/// The names of the files of a `mtllib`: one name that may have blanks in it, or several names. Some programs write quotes around them.
fn files_of(library: &str, folder: &Folder) -> Vec<String> {
    let bare = |name: &str| name.trim_matches('"').to_owned();
    let is_one = |name: &String| folder.find(name).is_ok();
    if is_one(&bare(library)) || library.starts_with('"') && library.matches('"').count() == 2 {
        return vec![bare(library)];
    }
    let several: Vec<_> = library.split_whitespace().map(bare).collect();
    // None of the words is a file: then it is one name, of a file that is missing.
    if several.iter().any(is_one) { several } else { vec![bare(library)] }
}

/// The number of each material by its name, by its name up to a comment, and by its name in small letters. The first material of a name counts.
struct Names {
    exact: HashMap<String, usize>,
    short: HashMap<String, usize>,
    small: HashMap<String, usize>,
}

/// A name up to what may be a comment.
fn short(name: &str) -> &str {
    name.split(" #").next().unwrap_or_default().trim_end()
}

impl Names {
    fn of(materials: &[mtl::Material]) -> Self {
        let by =
            |key: fn(&str) -> String| materials.iter().enumerate().rev().map(|(number, material)| (key(&material.name), number)).collect();
        Self { exact: by(str::to_owned), short: by(|name| short(name).to_owned()), small: by(str::to_lowercase) }
    }

    /// The material of this name, or of a name that differs by a comment, or else by capitals.
    fn find(&self, name: &str) -> Option<usize> {
        let Self { exact, short: by_short, small } = self;
        let by_comment = || exact.get(short(name)).into_iter().chain(by_short.get(name)).min();
        exact.get(name).or_else(by_comment).or_else(|| small.get(&name.to_lowercase())).copied()
    }
}
