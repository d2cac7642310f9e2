//! Where nodes and skins put the vertices of a mesh, in the pose in which a file is stored.

use super::accessor::{Bytes, Kind};
use crate::transform::Transform;
use anyhow::{Result, ensure};
use gltf::{Document, Node};

/// What a node does to what is in it.
fn of(node: &Node<'_>) -> Transform {
    Transform::of_columns(&node.transform().matrix().map(|column| column.map(f64::from)))
}

/// Where each node of a document stands in its scene, by the transforms of its parents. In a circle of nodes, which no scene has, they end somewhere.
pub(super) fn of_nodes(document: &Document) -> Vec<Transform> {
    let count = document.nodes().len();
    let mut parents = vec![None; count];
    for node in document.nodes() {
        node.children().for_each(|child| parents[child.index()] = Some(node.index()));
    }
    let own: Vec<_> = document.nodes().map(|node| of(&node)).collect();
    let mut places: Vec<Option<Transform>> = vec![None; count];
    for node in 0..count {
        // Upwards to a node whose place is known, then down again.
        let (mut way, mut at) = (Vec::new(), Some(node));
        while let Some(index) = at.filter(|&index| places[index].is_none() && way.len() <= count) {
            way.push(index);
            at = parents[index];
        }
        let mut place = at.and_then(|index| places[index]).unwrap_or(Transform::NONE);
        for index in way.into_iter().rev() {
            place = place.then(&own[index]);
            places[index] = Some(place);
        }
    }
    places.into_iter().flatten().collect()
}

/// The joints of each vertex, and their weights.
pub(super) struct Weights {
    pub(super) joints: Vec<[f64; 4]>,
    pub(super) weights: Vec<[f64; 4]>,
}

/// What the joints of a skin do to a vertex.
pub(super) struct Skin(Vec<Transform>);

impl Skin {
    /// The joints of a skin, among nodes that stand at these places.
    pub(super) fn read(skin: &gltf::Skin<'_>, bytes: &Bytes, places: &[Transform]) -> Result<Self> {
        let joints: Vec<_> = skin.joints().map(|joint| places.get(joint.index()).copied().unwrap_or(Transform::NONE)).collect();
        let Some(accessor) = skin.inverse_bind_matrices() else { return Ok(Self(joints)) };
        let inverse = bytes.numbers::<16>(&accessor, Kind::Coordinates)?;
        ensure!(inverse.len() >= joints.len(), "it has {} joints and {} matrices", joints.len(), inverse.len());
        let columns = |matrix: &[f64; 16]| [0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| matrix[4 * column + row]));
        Ok(Self(joints.iter().zip(&inverse).map(|(joint, inverse)| joint.then(&Transform::of_columns(&columns(inverse)))).collect()))
    }

    /// The transform of each vertex: the mean of those of its joints. The node of the mesh has no part in it.
    pub(super) fn transforms(&self, count: usize, sets: impl Fn(u32) -> Result<Option<Weights>>) -> Result<Vec<Transform>> {
        let mut sums = vec![(Transform::NOTHING, 0.0); count];
        for set in 0.. {
            let Some(Weights { joints, weights }) = sets(set)? else { break };
            ensure!(joints.len() == count && weights.len() == count, "it has not as many joints and weights as positions");
            for (vertex, (joints, weights)) in joints.iter().zip(&weights).enumerate() {
                for (&joint, &weight) in joints.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                    let transform = self.0.get(joint as usize);
                    ensure!(transform.is_some(), "vertex {vertex}: joint {joint} is out of range; the skin has {}", self.0.len());
                    let (sum, all) = &mut sums[vertex];
                    *sum = sum.plus(transform.unwrap_or(&Transform::NONE), weight);
                    *all += weight;
                }
            }
        }
        // A vertex without joints stays where it is.
        let mean = |(sum, all): (Transform, f64)| if all > 0.0 { Transform::NOTHING.plus(&sum, 1.0 / all) } else { Transform::NONE };
        Ok(sums.into_iter().map(mean).collect())
    }
}
