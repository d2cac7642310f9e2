//! The records of a stream in lists that can be changed, and written as a stream again.

use microphong::{
    Stream,
    stream::{
        self, MeshColours,
        record::{
            Colour, CornerColours, Cut, HAS_COLOURS, HAS_NEIGHBOURS, Header, Instance, Key, Label, Light, Material, Mesh, Neighbours,
            PALETTE, Track, Triangle, Vertex,
        },
        seal,
    },
};
use microphong_models::bytes::StreamBytes;
use zerocopy::IntoBytes;

/// For each mesh the colours of the corners of each of its triangles; `None` if it has none.
pub(crate) type Painted = Vec<Option<Vec<[Colour; 3]>>>;

/// All records of a stream.
#[derive(Clone, Debug)]
pub(crate) struct Records {
    /// The numbers of records in it are those of the lists when it is written.
    pub(crate) header: Header,
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) materials: Vec<Material>,
    pub(crate) lights: Vec<Light>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) tracks: Vec<Track>,
    pub(crate) keys: Vec<Key>,
    pub(crate) cuts: Vec<Cut>,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) neighbours: Vec<Neighbours>,
    pub(crate) corner_colours: Vec<CornerColours>,
    pub(crate) colours: Vec<Colour>,
    pub(crate) labels: Vec<Label>,
    pub(crate) names: Vec<u8>,
}

impl Records {
    /// The records of a stream.
    pub(crate) fn of(stream: &Stream<'_>) -> Self {
        Self {
            header: *stream.header,
            meshes: stream.meshes.to_vec(),
            materials: stream.materials.to_vec(),
            lights: stream.lights.to_vec(),
            instances: stream.instances.to_vec(),
            tracks: stream.tracks.to_vec(),
            keys: stream.keys.to_vec(),
            cuts: stream.cuts.to_vec(),
            vertices: stream.vertices.to_vec(),
            triangles: stream.triangles.to_vec(),
            neighbours: stream.neighbours.to_vec(),
            corner_colours: stream.corner_colours.to_vec(),
            colours: stream.colours.to_vec(),
            labels: stream.labels.to_vec(),
            names: stream.names.to_vec(),
        }
    }

    /// A stream of these records; `None` if it is not valid.
    pub(crate) fn written(&self) -> Option<StreamBytes> {
        let mut header = Header {
            meshes: self.meshes.len() as u16,
            materials: self.materials.len() as u16,
            lights: self.lights.len() as u16,
            instances: self.instances.len() as u16,
            tracks: self.tracks.len() as u16,
            keys: self.keys.len() as u32,
            cuts: self.cuts.len() as u32,
            vertices: self.vertices.len() as u32,
            triangles: self.triangles.len() as u32,
            corner_colours: self.corner_colours.len() as u32,
            colours: self.colours.len() as u16,
            labels: self.labels.len() as u8,
            ..self.header
        };
        header.length = stream::length(&header)? + (self.neighbours.as_bytes().len() + self.names.len()) as u32;
        let mut bytes = [
            header.as_bytes(),
            self.meshes.as_bytes(),
            self.materials.as_bytes(),
            self.lights.as_bytes(),
            self.instances.as_bytes(),
            self.tracks.as_bytes(),
            self.keys.as_bytes(),
            self.cuts.as_bytes(),
            self.vertices.as_bytes(),
            self.triangles.as_bytes(),
            self.neighbours.as_bytes(),
            self.corner_colours.as_bytes(),
            self.colours.as_bytes(),
            self.labels.as_bytes(),
            &self.names,
        ]
        .concat();
        seal(&mut bytes);
        let stream = StreamBytes::from(&bytes[..]);
        stream.parse().is_ok().then_some(stream)
    }

    /// Leaves out all triangles whose numbers are not `kept`, with their colours. Vertices stay. Neighbours and cuts are left out, because they are
    /// numbers of triangles.
    pub(crate) fn keep_triangles(&mut self, kept: impl Fn(usize) -> bool) {
        let mut first_triangle = 0;
        for mesh in &mut self.meshes {
            let all = mesh.first_triangle as usize..(mesh.first_triangle + mesh.triangles) as usize;
            let triangles = all.filter(|&k| kept(k)).count() as u32;
            *mesh = Mesh { first_triangle, triangles, flags: mesh.flags & !HAS_NEIGHBOURS, ..*mesh };
            first_triangle += triangles;
        }
        self.neighbours.clear();
        self.cuts.clear();
        self.triangles = those(&self.triangles, &kept);
        self.corner_colours = those(&self.corner_colours, &kept);
    }

    /// Leaves out the colours of all meshes.
    pub(crate) fn without_colours(mut self) -> Self {
        for mesh in &mut self.meshes {
            *mesh = Mesh { flags: mesh.flags & !HAS_COLOURS, palette: 0, ..*mesh };
        }
        self.corner_colours.clear();
        self.colours.clear();
        self
    }

    /// The colours of all corners, in place of palettes and numbers of colours.
    pub(crate) fn painted(stream: &Stream<'_>) -> Painted {
        let of = |mesh| {
            let MeshColours { palette, corners } = stream.colours_of(mesh)?;
            corners.iter().map(|corner| colours_at(corner, palette)).collect()
        };
        stream.meshes.iter().map(of).collect()
    }

    /// Gives all corners these colours, by palettes as small as can be. `None` if there are too many colours, or if some levels of a mesh have
    /// colours and others have none.
    pub(crate) fn paint(self, painted: &Painted) -> Option<Self> {
        let mut records = self.without_colours();
        let mut first = 0;
        while first < records.meshes.len() {
            let levels = records.meshes[first + 1..].iter().take_while(|mesh| mesh.error > 0).count();
            let of_mesh = first..first + 1 + levels;
            first = of_mesh.end;
            if painted[of_mesh.clone()].iter().all(Option::is_none) {
                continue;
            }
            records.colours.resize(records.colours.len().next_multiple_of(PALETTE), BLACK);
            let start = records.colours.len();
            for (mesh, corners) in records.meshes[of_mesh.clone()].iter_mut().zip(&painted[of_mesh]) {
                let corners = corners.as_ref()?;
                mesh.flags |= HAS_COLOURS;
                mesh.palette = u8::try_from(start / PALETTE).ok()?;
                records.corner_colours.resize(mesh.first_triangle as usize, NONE);
                for &corners in corners {
                    let mut numbers = [0; 3];
                    for (number, colour) in numbers.iter_mut().zip(corners) {
                        let known = records.colours[start..].iter().position(|&other| other == colour);
                        let new = records.colours.len() - start;
                        if known.is_none() {
                            records.colours.push(colour);
                        }
                        *number = u8::try_from(known.unwrap_or(new)).ok()?;
                    }
                    records.corner_colours.push(CornerColours::new(numbers, corners));
                }
            }
        }
        Some(records)
    }
}

/// What fills a palette up.
const BLACK: Colour = Colour { channels: [0; 3], unused: 0 };
/// The record of a triangle without colours.
const NONE: CornerColours = CornerColours { colours: [0; 3], range: 0 };

/// The colours of three corners; `None` if the palette lacks one.
fn colours_at(corner: &CornerColours, palette: &[Colour]) -> Option<[Colour; 3]> {
    let [a, b, c] = corner.colours.map(|number| palette.get(usize::from(number)).copied());
    Some([a?, b?, c?])
}

/// The items of a list whose numbers are `kept`.
fn those<T: Copy>(all: &[T], kept: impl Fn(usize) -> bool) -> Vec<T> {
    all.iter().enumerate().filter(|&(k, _)| kept(k)).map(|(_, &one)| one).collect()
}
