//! The meshes of a stream, as `convert` and `inspect` list them.

use super::report;
use anyhow::Result;
use microphong::{Stream, StreamError};
use serde::Serialize;

/// A mesh with its coarser levels.
#[derive(Serialize)]
pub(crate) struct Row {
    /// Index of the mesh.
    index: usize,
    /// Index of the next mesh, after coarser levels.
    end: usize,
    /// Name of the mesh's object.
    name: Option<String>,
    material: u16,
    triangles: u32,
}

/// All meshes of a stream.
///
/// # Errors
/// When a name is not valid.
pub(crate) fn rows(stream: &Stream<'_>) -> Result<Vec<Row>, StreamError> {
    let mut rows: Vec<Row> = Vec::new();
    for (index, mesh) in stream.meshes.iter().enumerate() {
        match rows.last_mut() {
            Some(row) if mesh.error > 0 => row.end += 1,
            _ => rows.push(Row { index, end: index + 1, name: None, material: mesh.material, triangles: mesh.triangles }),
        }
    }
    let mut unnamed = rows.iter_mut().peekable();
    for entry in stream.names() {
        let (name, meshes) = entry?;
        while let Some(row) = unnamed.next_if(|row| row.index < usize::from(meshes.end)) {
            row.name = Some(name.to_owned());
        }
    }
    Ok(rows)
}

/// Lists at most `most` meshes, if there are several objects or materials. `materials` are names from the converted file.
pub(crate) fn text(rows: &[Row], materials: &[Option<&str>], most: usize) -> Result<()> {
    if matches!(rows, [Row { name: None, .. }]) {
        return Ok(());
    }
    for Row { index, end, name, material, triangles } in rows.iter().take(most) {
        let name = name.as_ref().map_or_else(String::new, |name| format!("{name:?}, "));
        let of = materials.get(usize::from(*material)).copied().flatten().map_or_else(String::new, |of| format!(" {of:?}"));
        let meshes = if end - index > 1 { format!("meshes {index} to {}", end - 1) } else { format!("mesh {index}") };
        report::line(&format!("  {meshes}: {name}material {material}{of}, {}", report::counted(*triangles, report::TRIANGLES)))?;
    }
    if rows.len() > most {
        report::line(&format!("  and {} more: `microphong inspect` lists all", report::counted(rows.len() - most, MESHES)))?;
    }
    Ok(())
}

/// Names of what is counted.
pub(crate) const MESHES: [&str; 2] = ["mesh", "meshes"];
