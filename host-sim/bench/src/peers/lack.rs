//! Features that other renderers lack.

use super::reflected;
use microphong::{
    Stream,
    stream::record::{Light, PERSPECTIVE},
};
use serde::{Serialize, Serializer};
use std::fmt;

/// Something that a renderer leaves out of a scene, or draws otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// The renderer's depth needs rays that meet in the eye: it sees parallel rays from afar.
    ParallelRays,
    /// The renderer has one directional light only.
    OtherLights,
    /// The renderer's ambient light is a tenth of the directional light that it shows.
    Ambient,
    /// The renderer has no highlights.
    Highlights,
    /// The renderer's highlights are white.
    ColouredHighlights,
}

impl Lack {
    /// Whether a scene shows the difference.
    #[must_use]
    pub fn concerns(self, stream: &Stream<'_>) -> bool {
        let highlights =
            |light: &Light| stream.materials.iter().map(|material| reflected(material.specular, light.colour)).collect::<Vec<_>>();
        match self {
            Self::ParallelRays => stream.header.camera.projection != PERSPECTIVE,
            Self::OtherLights => stream.lights.len() > 1,
            Self::Ambient => true,
            Self::Highlights => stream.lights.iter().flat_map(highlights).any(|highlight| highlight != [0; 3]),
            Self::ColouredHighlights => {
                stream.lights.first().is_some_and(|light| highlights(light).iter().any(|[r, g, b]| r != g || g != b))
            }
        }
    }
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ParallelRays => "parallel rays",
            Self::OtherLights => "lights but the first",
            Self::Ambient => "the given ambient light",
            Self::Highlights => "highlights",
            Self::ColouredHighlights => "coloured highlights",
        })
    }
}

impl Serialize for Lack {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
