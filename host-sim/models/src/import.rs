//! Reads a mesh and its materials from files.

use crate::{
    foreign, gltf,
    look::Surface,
    mesh::{self, Mesh, Report, Soup, Weld},
    mtl, names,
    obj::{self, Obj},
    ply::{self, Ply},
    stl,
};
use anyhow::{Context, Result};
use std::{collections::BTreeSet, fs, path::Path};

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
    /// Remarks on the file for the user, in sentences.
    pub remarks: Vec<String>,
}

/// Converts the materials of a mesh to those of a stream, under ambient light from 0 to 1. Values that the file does not define are taken from
/// `other`.
#[must_use]
pub fn surfaces(materials: &[Option<mtl::Material>], other: &Surface, ambient_light: f64) -> Vec<Surface> {
    materials.iter().map(|material| material.as_ref().map_or(*other, |material| material.surface(ambient_light))).collect()
}

/// The contents of a file of any format.
#[derive(Default)]
struct Contents {
    soup: Soup,
    objects: Vec<String>,
    materials: Vec<Option<mtl::Material>>,
    ignored: BTreeSet<&'static str>,
    remarks: Vec<String>,
}

/// Reads and welds an OBJ file with the files of its materials beside it, a glTF file with the buffers beside it, an STL or a PLY file.
///
/// # Errors
/// Names the file and the place in it.
pub fn file(path: &Path, weld: Weld) -> Result<Imported> {
    let place = || path.display().to_string();
    let Contents { soup, objects, materials, ignored, mut remarks } = contents(path, &read(path)?)?;
    let (mesh, report) = mesh::weld(&soup, weld).with_context(place)?;
    if !ignored.is_empty() {
        remarks.push(format!("left out: {}", ignored.into_iter().collect::<Vec<_>>().join(", ")));
    }
    let objects = names::distinct(objects, &mut remarks);
    Ok(Imported { mesh, report, objects, materials, remarks })
}

/// Chooses the reader by how the file begins, or where that says nothing, by the ending of its name.
fn contents(path: &Path, bytes: &[u8]) -> Result<Contents> {
    let place = || path.display().to_string();
    let ends = |ending| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    let plain = Contents { materials: vec![None], ..Contents::default() };
    if ply::is_ply(bytes) || ends("ply") {
        let Ply { soup, ignored } = ply::parse(bytes).with_context(place)?;
        return Ok(Contents { soup, ignored, ..plain });
    }
    if gltf::is_gltf(bytes) || ends("gltf") || ends("glb") {
        let gltf::Scene { soup, objects, materials, ignored } = gltf::parse(bytes, path).with_context(place)?;
        return Ok(Contents { soup, objects, materials, ignored, ..plain });
    }
    foreign::refuse(path, bytes)?;
    if stl::is_stl(bytes) {
        return Ok(Contents { soup: stl::parse(bytes).with_context(place)?, ..plain });
    }
    with_libraries(path, obj::parse(&String::from_utf8_lossy(bytes)).with_context(place)?)
}

/// An OBJ file with the materials of the files that it names.
fn with_libraries(path: &Path, Obj { soup, objects, materials: names, libraries, mut ignored }: Obj) -> Result<Contents> {
    let (mut known, mut remarks) = (Vec::new(), Vec::new());
    if names.iter().any(Option::is_some) {
        for library in libraries {
            // One name with blanks in it, or several names.
            let whole = path.with_file_name(&library);
            let files =
                if whole.is_file() { vec![whole] } else { library.split_whitespace().map(|name| path.with_file_name(name)).collect() };
            for path in files {
                // A mesh is of use without its materials.
                let Ok(bytes) = fs::read(&path) else {
                    remarks.push(format!("{} cannot be read; to have its materials, put it beside the mesh", path.display()));
                    continue;
                };
                let mtl = mtl::parse(&String::from_utf8_lossy(&bytes)).with_context(|| path.display().to_string())?;
                known.extend(mtl.materials);
                ignored.extend(mtl.ignored);
            }
        }
    }
    let materials: Vec<_> = names.iter().map(|name| known.iter().find(|material| Some(&material.name) == name.as_ref()).cloned()).collect();
    let unknown: Vec<_> =
        names.iter().zip(&materials).filter(|(_, known)| known.is_none()).filter_map(|(name, _)| name.as_deref()).collect();
    if !unknown.is_empty() {
        remarks.push(format!("materials that no file defines have the colour of the command line: {}", unknown.join(", ")));
    }
    Ok(Contents { soup, objects, materials, ignored, remarks })
}

pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}
