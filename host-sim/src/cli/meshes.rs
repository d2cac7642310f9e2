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
    /// Number of colours at the corners of its triangles.
    colours: usize,
    /// Number of triangles that have colours and have only one.
    of_one_colour: usize,
    /// Width and height of its texture.
    texture: Option<[u32; 2]>,
    /// Whether the texture has holes.
    has_holes: bool,
    /// The part of the light from behind that it lets through, in sixteenths.
    transparency: u8,
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
            _ => {
                let texture = stream.texture_of(mesh);
                let corners = stream.colours_of(mesh).map_or(&[][..], |colours| colours.corners);
                let mut colours: Vec<u8> = corners.iter().flat_map(|corners| corners.colours).collect();
                colours.sort_unstable();
                colours.dedup();
                rows.push(Row {
                    index,
                    end: index + 1,
                    name: None,
                    material: mesh.material,
                    triangles: mesh.triangles,
                    colours: colours.len(),
                    of_one_colour: corners.iter().filter(|corners| corners.range == 0).count(),
                    has_holes: texture.is_some_and(|texture| texture.has_holes),
                    texture: texture.map(|texture| texture.size.map(|side| 1 << side)),
                    transparency: mesh.transparency(),
                });
            }
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

/// Lists at most `most` meshes, if there are several, or one has a name, colours, a texture, or is transparent. `materials` are names from the converted file.
pub(crate) fn text(rows: &[Row], materials: &[Option<&str>], most: usize) -> Result<()> {
    if matches!(rows, [Row { name: None, colours: 0, texture: None, transparency: 0, .. }]) {
        return Ok(());
    }
    for Row { index, end, name, material, triangles, colours, of_one_colour, texture, has_holes, transparency } in rows.iter().take(most) {
        let name = name.as_ref().map_or_else(String::new, |name| format!("{name:?}, "));
        let of = materials.get(usize::from(*material)).copied().flatten().map_or_else(String::new, |of| format!(" {of:?}"));
        let meshes = if end - index > 1 { format!("meshes {index} to {}", end - 1) } else { format!("mesh {index}") };
        let triangles = report::counted(*triangles, report::TRIANGLES);
        let colours = match colours {
            0 => texture.map_or_else(String::new, |[width, height]| {
                format!(" with a texture of {width}x{height}{}", if *has_holes { " that has holes" } else { "" })
            }),
            1 => ", all of one colour".to_owned(),
            several => format!(" with {several} colours, {} of them of one colour", report::grouped(*of_one_colour as u64)),
        };
        let seen = if *transparency == 0 { String::new() } else { format!(", lets through {transparency}/16 of what is behind it") };
        report::line(&format!("  {meshes}: {name}material {material}{of}, {triangles}{colours}{seen}"))?;
    }
    if rows.len() > most {
        report::line(&format!("  and {} more: `microphong inspect` lists all", report::counted(rows.len() - most, MESHES)))?;
    }
    Ok(())
}

/// Names of what is counted.
pub(crate) const MESHES: [&str; 2] = ["mesh", "meshes"];
