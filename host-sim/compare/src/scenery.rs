//! All objects of a frame together, each under the lights of its own space.

use anyhow::{Result, ensure};
use microphong::Stream;
use microphong_oracle::{Facet, Frame};

/// The objects of a frame.
#[derive(Debug)]
pub(super) struct Scenery {
    /// All facets in the order of drawing: opaque ones, the nearest object first, and then transparent ones, the farthest object first.
    pub(super) whole: Frame,
    /// Lights, viewer and materials of each object, in its own space, without facets.
    lightings: Vec<Frame>,
    /// The object of each facet.
    owners: Vec<usize>,
}

impl Scenery {
    /// Frame `number` of a stream on a picture of `size` pixels.
    ///
    /// # Errors
    /// When `size` is out of range, the scene shows no object, or several objects have coarser levels of detail.
    pub(super) fn new(stream: Stream<'_>, size: (u32, u32), number: u32, perspective_correct: bool) -> Result<Self> {
        let mut lightings = if stream.instances.is_empty() {
            vec![if perspective_correct { Frame::perspective_correct(stream, size, number) } else { Frame::new(stream, size, number) }]
        } else {
            let is_full = stream.meshes.iter().all(|mesh| mesh.error == 0);
            ensure!(
                is_full,
                "several objects have coarser levels of detail, and the reference draws full meshes; convert them without levels"
            );
            Frame::objects_as_drawn(stream, size, number, perspective_correct)?
        };
        ensure!(!lightings.is_empty(), "no object is visible");
        let owned = lightings
            .iter_mut()
            .enumerate()
            .map(|(owner, frame)| std::mem::take(&mut frame.facets).into_iter().map(move |facet| (owner, facet)));
        let (opaque, mut clear): (Vec<_>, Vec<_>) = owned.flatten().partition(|(_, facet): &(usize, Facet)| facet.transparency == 0.0);
        // The sort is stable: facets of an object stay in their order.
        clear.sort_by_key(|&(owner, _)| std::cmp::Reverse(owner));
        let (owners, facets) = opaque.into_iter().chain(clear).unzip();
        Ok(Self { whole: Frame { facets, ..lightings[0].clone() }, lightings, owners })
    }

    /// The lights, viewer and materials that a facet is shaded with.
    pub(super) fn lighting(&self, facet: usize) -> &Frame {
        &self.lightings[self.owners[facet]]
    }
}
