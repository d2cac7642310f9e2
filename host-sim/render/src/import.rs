//! Reads a mesh and its materials from files.

use crate::{
    foreign,
    look::Surface,
    mesh::{self, Mesh, Report, Weld},
    mtl,
    obj::{self, Obj},
    stl,
};
use anyhow::{Context, Result};
use std::{fs, path::Path};

/// A mesh from a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The mesh.
    pub mesh: Mesh,
    /// What welding did.
    pub report: Report,
    /// The materials of the file, by which the mesh counts; `None` where it does not say what a material is.
    pub materials: Vec<Option<mtl::Material>>,
    /// What a user should know of the file, in sentences.
    pub remarks: Vec<String>,
}

/// The materials of a mesh as a stream has them, under so much ambient light; `other` in place of what the file does not say.
#[must_use]
pub fn surfaces(materials: &[Option<mtl::Material>], other: &Surface, ambient_light: f64) -> Vec<Surface> {
    materials.iter().map(|material| material.as_ref().map_or(*other, |material| material.surface(ambient_light))).collect()
}

/// Reads and welds an OBJ file with the files of its materials beside it, or an STL file.
///
/// # Errors
/// Names the file and the line.
pub fn file(path: &Path, weld: Weld) -> Result<Imported> {
    let place = || path.display().to_string();
    let bytes = read(path)?;
    foreign::refuse(path, &bytes)?;
    let obj = if stl::is_stl(&bytes) {
        stl::parse(&bytes).map(|soup| Obj { soup, materials: vec![None], ..Obj::default() })
    } else {
        obj::parse(&String::from_utf8_lossy(&bytes))
    };
    let Obj { soup, materials: names, libraries, mut ignored } = obj.with_context(place)?;
    let (mesh, report) = mesh::weld(&soup, weld).with_context(place)?;
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
                    remarks.push(format!("{} cannot be read: put it beside the mesh for the materials in it", path.display()));
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
        remarks.push(format!("drawn in the colour of the command line, because no file says what they are: {}", unknown.join(", ")));
    }
    if !ignored.is_empty() {
        remarks.push(format!("left out: {}", ignored.into_iter().collect::<Vec<_>>().join(", ")));
    }
    Ok(Imported { mesh, report, materials, remarks })
}

pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}
