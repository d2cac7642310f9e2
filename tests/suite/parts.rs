//! Streams in parts that tests change.

use microphong::{
    StreamError,
    stream::{
        self, Header, Mesh,
        record::{Colour, CornerColours, Instance, Key, Label, Light, Material, Track, Triangle, Vertex},
    },
};
use microphong_sim::bytes::StreamBytes;
use zerocopy::IntoBytes;

/// A stream in parts that can be changed.
pub(crate) struct Parts {
    pub(crate) header: Header,
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) materials: Vec<Material>,
    pub(crate) lights: Vec<Light>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) tracks: Vec<Track>,
    pub(crate) keys: Vec<Key>,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) corner_colours: Vec<CornerColours>,
    pub(crate) colours: Vec<Colour>,
    pub(crate) labels: Vec<Label>,
    pub(crate) names: Vec<u8>,
}

impl Parts {
    pub(crate) fn of(stream: &StreamBytes) -> Result<Self, StreamError> {
        let stream = stream.parse()?;
        Ok(Self {
            header: *stream.header,
            meshes: stream.meshes.to_vec(),
            materials: stream.materials.to_vec(),
            lights: stream.lights.to_vec(),
            instances: stream.instances.to_vec(),
            tracks: stream.tracks.to_vec(),
            keys: stream.keys.to_vec(),
            vertices: stream.vertices.to_vec(),
            triangles: stream.triangles.to_vec(),
            corner_colours: stream.corner_colours.to_vec(),
            colours: stream.colours.to_vec(),
            labels: stream.labels.to_vec(),
            names: stream.names.to_vec(),
        })
    }

    /// The stream, whose counts and length are right, but for what `lie` makes of its header.
    pub(crate) fn stream(mut self, lie: fn(&mut Header)) -> Vec<u8> {
        let header = &mut self.header;
        (header.meshes, header.materials, header.lights) =
            (self.meshes.len() as u16, self.materials.len() as u16, self.lights.len() as u16);
        (header.instances, header.tracks, header.keys) = (self.instances.len() as u16, self.tracks.len() as u16, self.keys.len() as u32);
        (header.vertices, header.triangles) = (self.vertices.len() as u32, self.triangles.len() as u32);
        (header.corner_colours, header.colours) = (self.corner_colours.len() as u32, self.colours.len() as u16);
        header.labels = self.labels.len() as u8;
        header.length = stream::length(header).map_or(u32::MAX, |length| length.saturating_add(self.names.len() as u32));
        lie(header);
        let mut bytes = self.header.as_bytes().to_vec();
        for records in [
            self.meshes.as_bytes(),
            self.materials.as_bytes(),
            self.lights.as_bytes(),
            self.instances.as_bytes(),
            self.tracks.as_bytes(),
            self.keys.as_bytes(),
            self.vertices.as_bytes(),
            self.triangles.as_bytes(),
            self.corner_colours.as_bytes(),
            self.colours.as_bytes(),
            self.labels.as_bytes(),
            &self.names,
        ] {
            bytes.extend_from_slice(records);
        }
        stream::seal(&mut bytes);
        bytes
    }
}
