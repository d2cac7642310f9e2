//! The cargo features that a mesh file needs.

use crate::{
    features::Feature,
    pixel::Channels,
    scene::LightTerms,
    stream::{
        Stream,
        record::{Light, Mesh, NO_OUTLINES},
    },
};

impl Feature {
    /// Whether `stream` needs the feature to be drawn in a pixel format with these `channels`.
    #[inline]
    #[must_use]
    pub fn is_needed_by(self, stream: &Stream<'_>, channels: &Channels) -> bool {
        let Stream { header, lights, .. } = stream;
        match self {
            Self::Animation => !stream.tracks.is_empty(),
            Self::Antialias => header.outlines != NO_OUTLINES,
            // Several lights are summed in three channels.
            Self::Colours if Self::Lights.is_needed_by(stream, channels) && !channels.is_gray => true,
            Self::Colours => {
                stream.materials.iter().any(|material| !LightTerms::new(channels, header.ambient, material, lights).are_one_channel)
            }
            Self::Lights => lights.len() > 1,
            Self::LightShapes => lights.iter().any(Light::has_shape),
            Self::NearLights => !stream.is_constant(),
            Self::Objects => stream.instances.len() > 1,
            Self::Text => !stream.labels.is_empty(),
            Self::Textures => header.textures > 0,
            Self::Transparency => stream.meshes.iter().any(Mesh::is_transparent) || stream.has_holes(),
            Self::VertexColours => !stream.corner_colours.is_empty(),
        }
    }

    /// The first feature that `stream` needs, and that a program which `has` the others lacks.
    #[inline]
    #[must_use]
    pub fn missing(stream: &Stream<'_>, channels: &Channels, has: impl Fn(Self) -> bool) -> Option<Self> {
        // Each feature is asked for by name, so that the compiler drops the check if the program has it.
        let lacks = |feature: Self| (!has(feature) && feature.is_needed_by(stream, channels)).then_some(feature);
        let [animation, antialias, colours, lights, light_shapes, near_lights, objects, text, textures, transparency, vertex_colours] =
            Self::ALL;
        let scene = lacks(animation).or_else(|| lacks(objects)).or_else(|| lacks(text)).or_else(|| lacks(antialias));
        let lights = || lacks(lights).or_else(|| lacks(near_lights)).or_else(|| lacks(light_shapes));
        scene
            .or_else(lights)
            .or_else(|| lacks(vertex_colours))
            .or_else(|| lacks(textures))
            .or_else(|| lacks(transparency))
            .or_else(|| lacks(colours))
    }
}
