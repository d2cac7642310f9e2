//! Winding of faces: those that are wound against their neighbours are turned, and what cannot be mended is counted.
//!
//! Two faces at an edge agree if they run along it in opposite directions. From face to face over such edges, one face of a component decides for all
//! others. If the component is closed, its volume tells the outside. If it is open, the normals of the file do, or else the larger area stays as it is.
//! Edges of more than two faces join nothing.

use crate::{
    mesh::Soup,
    polygon::newell,
    vector::{V3, add, cross, dot, length, sub, unit},
};
use std::collections::HashMap;

/// What is known of the winding of faces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Winding {
    /// Whether each face is to be turned.
    pub(crate) turned: Vec<bool>,
    /// Number of faces that have sides.
    pub(crate) faces: usize,
    /// Edges of one face.
    pub(crate) open: usize,
    /// Edges over which two faces disagree, however they are turned, as on a band with one twist.
    pub(crate) opposed: usize,
    /// Edges of more than two faces.
    pub(crate) crowded: usize,
}

/// Faces at an edge, and whether each runs along it from its smaller place to its larger one.
type Sides = Vec<(usize, bool)>;

/// The corners of a face, each at another place than the one before.
fn outline(soup: &Soup, face: usize, places: &[usize]) -> Vec<usize> {
    let mut outline: Vec<usize> = soup.faces[face].corners.iter().map(|corner| places[corner.position]).collect();
    outline.dedup();
    while outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    outline
}

/// Finds out which faces of a soup are to be turned. Its corners are at these places, which are numbers of `positions`. Faces of different objects are
/// no neighbours.
pub(crate) fn winding(soup: &Soup, positions: &[V3], places: &[usize]) -> Winding {
    let outlines: Vec<_> = (0..soup.faces.len()).map(|face| outline(soup, face, places)).collect();
    let mut edges: HashMap<(usize, usize, usize), Sides> = HashMap::new();
    let of = |face: usize| {
        let (outline, object) = (&outlines[face], soup.faces[face].submesh.object);
        // What has no area has no sides.
        let count = if outline.len() < 3 { 0 } else { outline.len() };
        (0..count).map(move |k| {
            let (a, b) = (outline[k], outline[(k + 1) % count]);
            ((object, a.min(b), a.max(b)), a < b)
        })
    };
    for face in 0..outlines.len() {
        of(face).for_each(|(edge, forward)| edges.entry(edge).or_default().push((face, forward)));
    }
    let faces = outlines.iter().filter(|outline| outline.len() > 2).count();
    let mut winding = Winding { turned: vec![false; outlines.len()], faces, ..Winding::default() };
    for sides in edges.values() {
        match sides.len() {
            1 => winding.open += 1,
            2 => {}
            _ => winding.crowded += 1,
        }
    }
    let mut seen = vec![false; outlines.len()];
    let mut closed = Vec::new();
    for first in 0..outlines.len() {
        if seen[first] || outlines[first].len() < 3 {
            continue;
        }
        seen[first] = true;
        let (mut component, mut next) = (vec![first], 0);
        let (mut is_closed, mut is_mixed, mut opposed) = (true, false, 0);
        while let Some(&face) = component.get(next) {
            next += 1;
            for (edge, forward) in of(face) {
                let [one, other] = edges[&edge][..] else {
                    is_closed = false;
                    continue;
                };
                let (neighbour, other_forward) = if one == (face, forward) { other } else { one };
                let agrees = forward != other_forward;
                if seen[neighbour] {
                    opposed += usize::from((winding.turned[face] == winding.turned[neighbour]) != agrees);
                } else {
                    seen[neighbour] = true;
                    winding.turned[neighbour] = winding.turned[face] ^ !agrees;
                    is_mixed |= !agrees;
                    component.push(neighbour);
                }
            }
        }
        winding.opposed += opposed / 2;
        if is_closed && opposed == 0 {
            closed.push(component);
        } else if is_mixed {
            let sum = |weight: &dyn Fn(usize, V3) -> f64| {
                let weights = component.iter().map(|&face| {
                    let weight = weight(face, area_of(&outlines[face], positions));
                    if winding.turned[face] { -weight } else { weight }
                });
                weights.sum::<f64>()
            };
            let by_normals = sum(&|face, area| dot(area, normals_of(soup, face)));
            let by_area = sum(&|_, area| length(area));
            if by_normals < 0.0 || by_normals == 0.0 && by_area < 0.0 {
                component.iter().for_each(|&face| winding.turned[face] ^= true);
            }
        }
    }
    outward(&mut winding.turned, &closed, &outlines, positions);
    winding
}

/// Turns closed components whose volume is negative, but not the walls of a cavity in another one.
fn outward(turned: &mut [bool], closed: &[Vec<usize>], outlines: &[Vec<usize>], positions: &[V3]) {
    let volume = |component: &[usize], turned: &[bool]| {
        let volumes = component.iter().map(|&face| {
            let volume = fan(&outlines[face]).map(|[a, b, c]| dot(positions[a], cross(positions[b], positions[c]))).sum::<f64>();
            if turned[face] { -volume } else { volume }
        });
        volumes.sum::<f64>()
    };
    let boxes: Vec<[V3; 2]> = closed.iter().map(|component| box_of(component, outlines, positions)).collect();
    for (number, component) in closed.iter().enumerate() {
        if volume(component, turned) >= 0.0 {
            continue;
        }
        // A part of a component that stays as it is: it would be turned as a whole, and is the wall of a cavity if it lies in another component.
        let is_as_it_was = component.iter().all(|&face| !turned[face]);
        let point = positions[outlines[component[0]][0]];
        let is_in_box = |[low, high]: [V3; 2]| (0..3).all(|k| (low[k]..=high[k]).contains(&point[k]));
        let others = (0..closed.len()).filter(|&other| other != number && is_in_box(boxes[other]));
        let is_cavity = is_as_it_was && others.filter(|&other| contains(&closed[other], outlines, positions, point)).count() % 2 == 1;
        if !is_cavity {
            component.iter().for_each(|&face| turned[face] ^= true);
        }
    }
}

/// The least and the largest coordinates of a component.
fn box_of(component: &[usize], outlines: &[Vec<usize>], positions: &[V3]) -> [V3; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for place in component.iter().flat_map(|&face| &outlines[face]).map(|&place| positions[place]) {
        let [low, high] = bounds;
        bounds = [[0, 1, 2].map(|k| low[k].min(place[k])), [0, 1, 2].map(|k| high[k].max(place[k]))];
    }
    bounds
}

/// Whether a closed component contains a point: a ray from it meets an odd number of its triangles.
fn contains(component: &[usize], outlines: &[Vec<usize>], positions: &[V3], point: V3) -> bool {
    // Along no axis, and so along the edge of no box.
    const RAY: V3 = [0.453_7, 0.291_3, 0.842_1];
    let hits = component.iter().flat_map(|&face| fan(&outlines[face])).filter(|triangle| {
        let [a, b, c] = triangle.map(|corner| sub(positions[corner], point));
        let sides = [dot(RAY, cross(a, b)), dot(RAY, cross(b, c)), dot(RAY, cross(c, a))];
        let normal = cross(sub(b, a), sub(c, a));
        (sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)) && dot(a, normal) * dot(RAY, normal) > 0.0
    });
    hits.count() % 2 == 1
}

/// The triangles between the first corner and each side.
fn fan(outline: &[usize]) -> impl Iterator<Item = [usize; 3]> {
    outline.windows(2).skip(1).map(|side| [outline[0], side[0], side[1]])
}

/// The sum of the normals that the file gives for the corners of a face.
fn normals_of(soup: &Soup, face: usize) -> V3 {
    let normals = soup.faces[face].corners.iter().filter_map(|corner| unit(soup.normals[corner.normal?]));
    normals.fold([0.0; 3], add)
}

fn area_of(outline: &[usize], positions: &[V3]) -> V3 {
    newell(&outline.iter().map(|&place| positions[place]).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obj;
    use proptest::prelude::*;

    /// A box between two corners, with outward faces; `inward` names those that are turned.
    fn cuboid(low: f64, high: f64, first: usize, inward: &[usize]) -> String {
        let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| if bit == 0 { low } else { high }.to_string()).join(" ");
        let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
        let mut text: String = (0..8).map(|k| format!("v {}\n", corner(k))).collect();
        for (number, mut face) in faces.into_iter().enumerate() {
            if inward.contains(&number) {
                face.reverse();
            }
            text += &format!("f{}\n", face.map(|corner| format!(" {}", corner + first)).concat());
        }
        text
    }

    fn of(text: &str) -> Winding {
        let soup = obj::parse(text).unwrap().soup;
        let places: Vec<_> = (0..soup.positions.len()).collect();
        winding(&soup, &soup.positions, &places)
    }

    fn turned(text: &str) -> Vec<usize> {
        of(text).turned.iter().enumerate().filter(|(_, turned)| **turned).map(|(face, _)| face).collect()
    }

    #[test]
    fn the_outside_of_each_closed_component_is_in_front() {
        let all: Vec<_> = (0..6).collect();
        assert!(turned(&cuboid(-1.0, 1.0, 0, &[])).is_empty());
        assert_eq!(turned(&cuboid(-1.0, 1.0, 0, &all)), all);
        assert_eq!(turned(&cuboid(-1.0, 1.0, 0, &[0, 3])), [0, 3]);
        assert_eq!(turned(&cuboid(-1.0, 1.0, 0, &[0, 1, 2, 4, 5])), [0, 1, 2, 4, 5]);
        // A second box beside the first one is turned alone.
        let beside = cuboid(-1.0, 1.0, 0, &[2]) + &cuboid(3.0, 4.0, 8, &all);
        assert_eq!(turned(&beside), [2, 6, 7, 8, 9, 10, 11]);
        // The walls of a cavity face inward, and so do those of a box in the cavity outward.
        let hollow = cuboid(-3.0, 3.0, 0, &[]) + &cuboid(-2.0, 2.0, 8, &all) + &cuboid(-1.0, 1.0, 16, &[]);
        assert!(turned(&hollow).is_empty());
        assert_eq!(turned(&hollow.replacen("f 1 3 4 2\n", "f 2 4 3 1\n", 1)), [0]);
    }

    #[test]
    fn edges_are_counted() {
        let counts = |text: &str| {
            let Winding { open, opposed, crowded, .. } = of(text);
            [open, opposed, crowded]
        };
        let closed = cuboid(-1.0, 1.0, 0, &[1]);
        assert_eq!(counts(&closed), [0; 3]);
        let lid = closed.trim_end().rsplit_once('\n').unwrap().0;
        assert_eq!(counts(lid), [4, 0, 0]);
        // A fin stands on an edge of a box.
        assert_eq!(counts(&format!("{closed}v 5 5 5\nf 1 2 9\n")), [2, 0, 1]);
        // Of another object it does not.
        assert_eq!(counts(&format!("o a\n{closed}v 5 5 5\no b\nf 1 2 9\n")), [3, 0, 0]);
        // A band of Möbius, of three quadrangles.
        let band = "v 1 0 0\nv 1 0 1\nv -1 1 0\nv -1 1 1\nv -1 -1 0\nv -1 -1 1\nf 1 3 4 2\nf 3 5 6 4\nf 5 2 1 6\n";
        assert_eq!(counts(band), [6, 1, 0]);
        // Nothing has a side that has no area.
        assert_eq!(counts("v 0 0 0\nv 1 0 0\nf 1 2 1\nf 1 1 1\n"), [0; 3]);
    }

    #[test]
    fn in_open_components_the_larger_area_stays() {
        let strip = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 9 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 9 1 0\n";
        assert_eq!(turned(&format!("{strip}f 1 2 6 5\nf 2 6 7 3\nf 3 4 8 7\n")), [1]);
        assert_eq!(turned(&format!("{strip}f 1 2 6 5\nf 2 3 7 6\nf 3 7 8 4\n")), [0, 1]);
        // Normals of the file count more than areas.
        let normals = format!("vn 0 0 -1\n{strip}f 1//1 2//1 6//1 5//1\nf 2//1 6//1 7//1 3//1\nf 3//1 4//1 8//1 7//1\n");
        assert_eq!(turned(&normals), [0, 2]);
        // One that is wound alike stays, whichever side is in front.
        assert!(turned(&format!("{strip}f 5 6 2 1\nf 6 7 3 2\n")).is_empty());
    }

    proptest! {
        /// However the faces of a closed surface are wound, they come to face outward.
        #[test]
        fn any_winding_of_a_closed_surface_is_mended(inward in prop::collection::btree_set(0usize..6, 0..7)) {
            let inward: Vec<_> = inward.into_iter().collect();
            prop_assert_eq!(turned(&cuboid(-1.0, 2.0, 0, &inward)), inward);
        }
    }
}
