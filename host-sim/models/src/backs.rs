//! Backs of open surfaces, such as leaves and cloth, which are seen from both sides.
//!
//! A renderer draws only the fronts of triangles. Where the back is to be seen as well, a second triangle of the opposite winding has it, with normals of
//! its own. So both sides are lit by the same methods within the same bounds, and meshes without backs cost nothing more. The back of a closed part cannot
//! be seen from outside, and is left out.

use crate::{
    mesh::{Coloured, Mesh, Submesh},
    number::grouped,
    vector::scale,
};
use std::collections::HashMap;

/// Which triangles have backs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// Triangles of materials that the file calls double-sided.
    #[default]
    OfFile,
    /// No triangle.
    One,
    /// All triangles.
    Two,
}

/// Gives a back to the triangles of open parts of a mesh, if their submesh has two sides. Returns how many backs there are.
pub(crate) fn add(mesh: &mut Mesh, has_two_sides: impl Fn(Submesh) -> bool) -> usize {
    let count = mesh.triangles.len();
    if !(0..count).any(|triangle| has_two_sides(mesh.submesh(triangle))) {
        return 0;
    }
    let is_open = open(mesh);
    let seen: Vec<_> = (0..count).filter(|&triangle| is_open[triangle] && has_two_sides(mesh.submesh(triangle))).collect();
    if !seen.is_empty() {
        mesh.submeshes = (0..count).map(|triangle| mesh.submesh(triangle)).collect();
    }
    let mut vertices = HashMap::new();
    for &front in &seen {
        let [a, b, c] = mesh.triangles[front].map(|vertex| {
            *vertices.entry(vertex).or_insert_with(|| {
                mesh.positions.push(mesh.positions[vertex]);
                mesh.normals.push(scale(mesh.normals[vertex], -1.0));
                mesh.positions.len() - 1
            })
        });
        mesh.triangles.push([a, c, b]);
        mesh.submeshes.push(Submesh { is_back: true, ..mesh.submeshes[front] });
        if !mesh.colours.is_empty() {
            let turned = |Coloured { coat, corners: [a, b, c] }| Coloured { coat, corners: [a, c, b] };
            mesh.colours.push(mesh.colours[front].map(turned));
        }
    }
    seen.len()
}

/// For each triangle, whether it belongs to an open part: triangles that are connected by edges of two triangles, at least one of which has an edge of
/// its own. Objects are not connected.
fn open(mesh: &Mesh) -> Vec<bool> {
    let places = mesh.places();
    let sides = |triangle: usize| {
        let ([a, b, c], object) = (mesh.triangles[triangle].map(|vertex| places[vertex]), mesh.submesh(triangle).object);
        [(a, b), (b, c), (c, a)].map(|(from, to)| (object, from.min(to), from.max(to)))
    };
    let mut at: HashMap<_, Vec<usize>> = HashMap::new();
    for triangle in 0..mesh.triangles.len() {
        sides(triangle).into_iter().for_each(|side| at.entry(side).or_default().push(triangle));
    }
    let mut is_open = vec![false; mesh.triangles.len()];
    let mut reached: Vec<usize> = at.values().filter(|triangles| triangles.len() == 1).map(|triangles| triangles[0]).collect();
    while let Some(triangle) = reached.pop() {
        if std::mem::replace(&mut is_open[triangle], true) {
            continue;
        }
        let pairs = sides(triangle).map(|side| &at[&side]);
        reached.extend(pairs.into_iter().filter(|triangles| triangles.len() == 2).flatten());
    }
    is_open
}

/// A sentence on backs for the user; `None` if there are none.
pub(crate) fn sentence(backs: usize, sides: Sides) -> Option<String> {
    let have = match backs {
        0 => return None,
        1 => "1 triangle of an open surface has a back, which takes as much flash as the front".to_owned(),
        several => format!("{} triangles of open surfaces have backs, which take as much flash as the fronts", grouped(several)),
    };
    let remedy = if sides == Sides::OfFile { "; the file calls the material double-sided, and --one-sided leaves backs out" } else { "" };
    Some(have + remedy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mesh::Weld, obj, shapes};

    fn with_backs(mut mesh: Mesh, has_two_sides: impl Fn(Submesh) -> bool) -> (usize, Mesh) {
        (add(&mut mesh, has_two_sides), mesh)
    }

    fn mesh(text: &str) -> Mesh {
        crate::mesh::weld(&obj::parse(text).unwrap().soup, Weld::default()).unwrap().0
    }

    /// Two triangles that share an edge.
    const LEAF: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

    #[test]
    fn a_back_is_the_front_turned_round() {
        let front = mesh(LEAF);
        let (count, both) = with_backs(front.clone(), |_| true);
        assert_eq!((count, both.triangles.len(), both.positions.len()), (2, 4, 8));
        for k in 0..2 {
            let at = |triangle: usize| both.triangles[triangle].map(|vertex| (both.positions[vertex], both.normals[vertex]));
            let ([a, b, c], [d, e, f]) = (at(k), at(k + 2));
            for ((position, normal), (behind, opposite)) in [(a, d), (b, f), (c, e)] {
                assert_eq!((position, scale(normal, -1.0)), (behind, opposite));
            }
            assert_eq!([both.submesh(k), both.submesh(k + 2)].map(|submesh| submesh.is_back), [false, true]);
        }
        assert_eq!(with_backs(front.clone(), |_| false), (0, front));
    }

    #[test]
    fn only_open_parts_have_backs() {
        let closed = shapes::cuboid();
        assert_eq!(with_backs(closed.clone(), |_| true), (0, closed.clone()));
        // Without a triangle the box is open, and its inside is seen.
        let lid = Mesh { triangles: closed.triangles[1..].to_vec(), ..closed };
        assert_eq!(with_backs(lid.clone(), |_| true).0, lid.triangles.len());
        // A surface that has both sides in the file has no third one.
        assert_eq!(with_backs(mesh(&format!("{LEAF}f 4 3 2 1\n")), |_| true).0, 0);
        // A leaf at an edge of a closed body is open, and the body is not.
        let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
        assert_eq!(with_backs(mesh(&format!("{tetrahedron}f 3 2 5\n")), |_| true).0, 1);
    }

    #[test]
    fn only_materials_with_two_sides_have_backs() {
        let text = format!("{LEAF}v 0 0 5\nv 1 0 5\nv 1 1 5\nusemtl b\nf 5 6 7\n");
        let (count, both) = with_backs(mesh(&text), |submesh| submesh.material == 1);
        assert_eq!((count, both.submesh(3)), (1, Submesh { object: 0, material: 1, is_back: true }));
    }
}
