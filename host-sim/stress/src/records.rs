//! The records of a stream in lists that can be changed, and written as a stream again.

use microphong::{
    Stream,
    stream::{
        self, MeshColours,
        record::{
            Colour, CornerColours, Cut, HAS_COLOURS, HAS_NEIGHBOURS, HAS_TEXTURE, Header, Instance, Key, Label, Light, Material, Mesh,
            Neighbours, PALETTE, Texture, TextureCorners, Track, Triangle, Vertex,
        },
        seal,
    },
};
use microphong_models::bytes::StreamBytes;
use zerocopy::IntoBytes;

/// For each mesh the colours of the corners of each of its triangles; `None` if it has none.
pub type Painted = Vec<Option<Vec<[Colour; 3]>>>;

/// All records of a stream.
#[derive(Clone, Debug)]
pub struct Records {
    /// The numbers of records in it are those of the lists when it is written.
    pub header: Header,
    /// The meshes, each followed by its coarser levels.
    pub meshes: Vec<Mesh>,
    /// The materials.
    pub materials: Vec<Material>,
    /// The lights.
    pub lights: Vec<Light>,
    /// The objects; none if all meshes are one.
    pub instances: Vec<Instance>,
    /// The movements.
    pub tracks: Vec<Track>,
    /// The keys of all movements.
    pub keys: Vec<Key>,
    /// Triangles that cut each other.
    pub cuts: Vec<Cut>,
    /// The vertices of all meshes.
    pub vertices: Vec<Vertex>,
    /// The triangles of all meshes and levels.
    pub triangles: Vec<Triangle>,
    /// The neighbours of all triangles; none if the stream has none.
    pub neighbours: Vec<Neighbours>,
    /// The colours at corners of the first triangles.
    pub corner_colours: Vec<CornerColours>,
    /// The palettes of all meshes and textures.
    pub colours: Vec<Colour>,
    /// The textures.
    pub textures: Vec<Texture>,
    /// Where the triangles of meshes with textures lie in these.
    pub texture_corners: Vec<TextureCorners>,
    /// The texels of all textures.
    pub texels: Vec<u8>,
    /// The texts over the picture.
    pub labels: Vec<Label>,
    /// The names of meshes, as bytes.
    pub names: Vec<u8>,
}

impl Records {
    /// The records of a stream.
    #[must_use]
    pub fn of(stream: &Stream<'_>) -> Self {
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
            textures: stream.textures().list.to_vec(),
            texture_corners: stream.textures().corners.to_vec(),
            texels: stream.textures().texels.to_vec(),
            labels: stream.labels.to_vec(),
            names: stream.names.to_vec(),
        }
    }

    /// A stream of these records; `None` if it is not valid.
    #[must_use]
    pub fn written(&self) -> Option<StreamBytes> {
        let stream = StreamBytes::from(&self.bytes(|_| ())[..]);
        stream.parse().is_ok().then_some(stream)
    }

    /// The bytes of a stream of these records, whose numbers and length are right, but for what `lie` makes of its header.
    #[must_use]
    pub fn bytes(&self, lie: impl FnOnce(&mut Header)) -> Vec<u8> {
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
            textures: self.textures.len() as u16,
            texture_corners: self.texture_corners.len() as u32,
            texels: self.texels.len() as u32,
            labels: self.labels.len() as u8,
            ..self.header
        };
        let others = (self.neighbours.as_bytes().len() + self.names.len()) as u32;
        header.length = stream::length(&header).map_or(u32::MAX, |length| length.saturating_add(others));
        lie(&mut header);
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
            self.textures.as_bytes(),
            self.texture_corners.as_bytes(),
            &self.texels,
            self.labels.as_bytes(),
            &self.names,
        ]
        .concat();
        seal(&mut bytes);
        bytes
    }

    /// Leaves out all triangles whose numbers are not `kept`, with their colours and their places in textures. Vertices stay. Neighbours and cuts are left out, because they are
    /// numbers of triangles.
    pub fn keep_triangles(&mut self, kept: impl Fn(usize) -> bool) {
        let (mut first_triangle, mut textured) = (0, Vec::new());
        for mesh in &mut self.meshes {
            let all = mesh.first_triangle as usize..(mesh.first_triangle + mesh.triangles) as usize;
            if mesh.flags & HAS_TEXTURE != 0 {
                textured.extend(all.clone().map(&kept));
            }
            let triangles = all.filter(|&k| kept(k)).count() as u32;
            *mesh = Mesh { first_triangle, triangles, flags: mesh.flags & !HAS_NEIGHBOURS, ..*mesh };
            first_triangle += triangles;
        }
        self.neighbours.clear();
        self.cuts.clear();
        self.triangles = those(&self.triangles, &kept);
        self.corner_colours = those(&self.corner_colours, &kept);
        self.texture_corners = those(&self.texture_corners, |k| textured[k]);
    }

    /// Leaves out the colours and textures of all meshes.
    #[must_use]
    pub fn without_colours(mut self) -> Self {
        for mesh in &mut self.meshes {
            *mesh = Mesh { flags: mesh.flags & !(HAS_COLOURS | HAS_TEXTURE), palette: 0, ..*mesh };
        }
        self.corner_colours.clear();
        self.colours.clear();
        self.textures.clear();
        self.texture_corners.clear();
        self.texels.clear();
        self
    }

    /// The colours of all corners, in place of palettes and numbers of colours.
    #[must_use]
    pub fn painted(stream: &Stream<'_>) -> Painted {
        let of = |mesh| {
            let MeshColours { palette, corners } = stream.colours_of(mesh)?;
            corners.iter().map(|corner| colours_at(corner, palette)).collect()
        };
        stream.meshes.iter().map(of).collect()
    }

    /// Gives all corners these colours, by palettes as small as can be. `None` if there are too many colours, or if some levels of a mesh have
    /// colours and others have none.
    #[must_use]
    pub fn paint(self, painted: &Painted) -> Option<Self> {
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
const BLACK: Colour = Colour::new([0; 3]);
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
