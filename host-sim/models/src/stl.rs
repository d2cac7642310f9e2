//! Reads STL, text and binary, by the library `stl_io`.

use crate::mesh::{Corner, Face, Smoothing, Soup, Submesh};
use anyhow::{Context, Result, bail};
use std::io::Cursor;

/// Bytes before the number of triangles.
const HEAD: usize = 80;

/// Whether a file is STL.
pub(crate) fn is_stl(bytes: &[u8]) -> bool {
    is_binary(bytes) || bytes.trim_ascii_start().starts_with(b"solid")
}

/// A head of 80 bytes, the number of triangles, and 50 bytes for each. Text never is: its number would be too large.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEAD..).and_then(|rest| rest.first_chunk()).map(|&count| u32::from_le_bytes(count));
    count.is_some_and(|count| bytes.len() as u64 == HEAD as u64 + 4 + 50 * u64::from(count))
}

/// Reads the triangles of a file. The normals in the file are left out, because they follow from the corners.
///
/// # Errors
/// The error names the triangle and its fault.
pub fn parse(bytes: &[u8]) -> Result<Soup> {
    let mut bytes = bytes.to_vec();
    if is_binary(&bytes) {
        // Some programs begin binary files as text begins.
        bytes[..HEAD].fill(0);
    }
    let mut file = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut file).context("STL without a head")?;
    let mut soup = Soup::default();
    for (number, triangle) in (1..).zip(triangles) {
        let triangle = triangle.with_context(|| format!("STL, triangle {number}"))?;
        let first = soup.positions.len();
        for vertex in triangle.vertices {
            let position = [0, 1, 2].map(|k| f64::from(vertex[k]));
            if position.iter().any(|c| !c.is_finite()) {
                bail!("STL, triangle {number}: coordinates must be finite");
            }
            soup.positions.push(position);
        }
        let corners = (first..first + 3).map(|position| Corner { position, normal: None }).collect();
        soup.faces.push(Face { corners, submesh: Submesh::default(), smoothing: Smoothing::ByAngle });
    }
    Ok(soup)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str =
        "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part\n";

    fn binary(head: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(HEAD, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_are_the_same() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        for bytes in [TEXT.as_bytes().to_vec(), binary(b"made by", &[triangle]), binary(b"solid is how some programs begin", &[triangle])] {
            assert!(is_stl(&bytes));
            let soup = parse(&bytes).unwrap();
            assert_eq!(soup.positions, triangle.map(|p| p.map(f64::from)));
            assert_eq!(soup.faces.len(), 1);
        }
        let error = parse(&binary(b"", &[triangle, [[f32::NAN; 3]; 3]])).unwrap_err();
        assert_eq!(format!("{error:#}"), "STL, triangle 2: coordinates must be finite");
        let cut = TEXT.replace("vertex 0 1 0\n", "");
        assert!(format!("{:#}", parse(cut.as_bytes()).unwrap_err()).contains("triangle 1"));
    }

    proptest! {
        #[test]
        fn any_bytes_may_come(bytes in prop::collection::vec(any::<u8>(), 0..400), words in "(solid|facet|normal|outer|loop|vertex|endloop|endfacet|[0-9e.-]{1,5}|[ \n]){0,60}") {
            // An error is as good as a mesh.
            let _ = parse(&bytes);
            let _ = parse(format!("solid {words}").as_bytes());
        }
    }
}
