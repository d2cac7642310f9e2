//! Material, lights and camera; with the quantised mesh they make a stream.

use crate::{
    bytes::StreamBytes,
    coat::{Coat, Paint, Texels, texture_corners},
    mesh::Rgb,
    number::{above, nearest},
    quantise::Part,
    records,
    vector::{V3, length, scale, unit},
    view::{Projection, View},
};
use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::{
    format::{ErrorBudget, Gain, GeometricError, Radius, Reach, UNIT, Unit},
    geometry::detail::stream_tolerance,
    scene::Background,
    stream,
    stream::{
        MAX_GAIN, MAX_NAME,
        record::{
            CLOSED_CONVEX, Camera, Colour, CornerColours, DIRECTIONAL, EYE_SPACE, HAS_COLOURS, HAS_TEXTURE, Header, Instance, Key, Label,
            Light, MAGIC, Material, Mesh, OBJECT_SPACE, ORTHOGRAPHIC, OWN_MATERIALS, PALETTE, PERSPECTIVE, POINT, SKY, TRANSPARENCY_SHIFT,
            Texture, TextureCorners, Track, VERSION,
        },
    },
};
use microphong_render::shader::Shader;
use std::{collections::HashMap, ops::RangeInclusive, sync::Arc};
use zerocopy::{FromZeros, IntoBytes};

/// Reflectances of a surface for each channel, where 1 reflects all light.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Colour that is reflected of the ambient light.
    pub ambient: V3,
    /// Evenly.
    pub diffuse: V3,
    /// Reflectance in the highlight.
    pub specular: V3,
    /// Exponent of the highlight. A larger exponent makes a smaller highlight.
    pub exponent: u16,
    /// The share of the light from behind that it lets through, from 0 to 1. A stream has sixteenths, and at most 15 of them.
    pub transparency: f64,
}

impl Surface {
    /// A metal, whose ambient, diffuse and specular reflectances have one colour. Every channel is then a multiple of one intensity.
    #[must_use]
    pub fn metal(colour: V3, [ambient, diffuse, specular]: [f64; 3], exponent: u16) -> Self {
        Self {
            ambient: scale(colour, ambient),
            diffuse: scale(colour, diffuse),
            specular: scale(colour, specular),
            exponent,
            transparency: 0.0,
        }
    }

    /// A coloured body under a clear varnish: the highlight is white.
    #[must_use]
    pub fn plastic(colour: V3, [ambient, diffuse, specular]: [f64; 3], exponent: u16) -> Self {
        Self { specular: [specular; 3], ..Self::metal(colour, [ambient, diffuse, 0.0], exponent) }
    }
}

/// A light.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// The kind of light, which tells what the vector is.
    pub kind: LampKind,
    /// A direction towards the light, or its position. Unless the light is fixed, the vector counts in eye space.
    pub vector: V3,
    /// Red, green, blue; 1 is full.
    pub colour: V3,
    /// Whether the light stays where it is in the world, whatever the camera does.
    pub is_fixed: bool,
    /// The distance at which a near light ends.
    pub range: Option<f64>,
    /// The cone of a near light.
    pub cone: Option<Cone>,
}

/// The kinds of lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LampKind {
    /// Infinitely far.
    Distant,
    /// At a position.
    Near,
    /// From a half of the sky about a direction.
    Sky,
}

/// Possible ranges of near lights, in units of the world.
pub const LIGHT_RANGE: RangeInclusive<f64> = 0.0625..=31.9;

/// The cone of a near light.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Where it shines: a direction in the space of the light's position.
    pub axis: V3,
    /// The angle from the axis up to which light is full, in degrees.
    pub full: f64,
    /// The angle from the axis from which on there is no light, in degrees: greater than `full`, at most 180.
    pub edge: f64,
}

impl Lamp {
    const fn new(kind: LampKind, vector: V3, colour: V3, is_fixed: bool) -> Self {
        Self { kind, vector, colour, is_fixed, range: None, cone: None }
    }

    /// An infinitely far light that goes where the camera goes: direction towards it in eye space, and colour.
    #[must_use]
    pub const fn distant(towards: V3, colour: V3) -> Self {
        Self::new(LampKind::Distant, towards, colour, false)
    }

    /// A near light that goes where the camera goes: position in eye space, and colour.
    #[must_use]
    pub const fn near(position: V3, colour: V3) -> Self {
        Self::new(LampKind::Near, position, colour, false)
    }

    /// An infinitely far light, whatever the camera does: direction towards it in the world, and colour.
    #[must_use]
    pub const fn fixed(towards: V3, colour: V3) -> Self {
        Self::new(LampKind::Distant, towards, colour, true)
    }

    /// A near light, whatever the camera does: position in the world, and colour.
    #[must_use]
    pub const fn fixed_near(position: V3, colour: V3) -> Self {
        Self::new(LampKind::Near, position, colour, true)
    }
}

/// An object of a scene: some parts of its meshes.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// Number of its first mesh.
    pub first_mesh: u16,
    /// Number of meshes.
    pub meshes: u16,
}

/// A movement.
#[derive(Clone, Debug)]
pub struct Way {
    /// What moves, see [`Track::kind`].
    pub kind: u16,
    /// Number of the object or light.
    pub index: u16,
    /// Keys, in the order of frames.
    pub keys: Vec<Key>,
}

/// The objects of a scene, and how they, lights and camera move. Without members the scene is one object.
#[derive(Clone, Debug, Default)]
pub struct Cast {
    /// Objects.
    pub members: Vec<Member>,
    /// All movements.
    pub ways: Vec<Way>,
}

/// Everything of a scene but its mesh.
#[derive(Clone, Debug)]
pub struct Look {
    /// Names of objects, as parts of meshes count them; empty for a stream without names.
    pub objects: Vec<String>,
    /// Materials, as parts of meshes count them.
    pub surfaces: Vec<Surface>,
    /// Lights.
    pub lamps: Vec<Lamp>,
    /// Ambient light.
    pub ambient: V3,
    /// The background.
    pub background: Background,
    /// Highlights see the eye where it is, not infinitely far.
    pub local_viewer: bool,
    /// The error budget of the method; `None` if the display decides.
    pub budget: Option<ErrorBudget>,
    /// Method unless another one is asked for.
    pub shader: Shader,
    /// Camera.
    pub view: View,
    /// Frames of the animation.
    pub frames: u16,
    /// Objects, and what moves.
    pub cast: Cast,
    /// Texts over the picture.
    pub labels: Vec<Label>,
}

/// A dark neutral: bright and dark objects both stand out.
pub const BACKGROUND: [u8; 3] = [26, 28, 32];
/// Key light from the upper left, eye space.
pub const KEY: V3 = [-0.45, 0.6, -0.66];

impl Look {
    /// A scene of one material under one white key light.
    #[must_use]
    pub fn new(surface: Surface, view: View) -> Self {
        Self {
            objects: Vec::new(),
            surfaces: vec![surface],
            lamps: vec![Lamp::distant(KEY, [1.0; 3])],
            ambient: [1.0; 3],
            background: BACKGROUND.into(),
            local_viewer: false,
            budget: None,
            shader: Shader::AUTO,
            view,
            frames: view.period.max(1),
            cast: Cast::default(),
            labels: Vec::new(),
        }
    }

    /// Largest distance of a coarser level from a mesh of these parts for which a picture of `size` pixels may show the level.
    #[must_use]
    pub fn tolerance(&self, parts: &[Part], size: (u32, u32)) -> GeometricError {
        stream_tolerance(&self.seen(parts), Size::new(size.0, size.1))
    }

    /// The tolerance of each of these pictures.
    #[must_use]
    pub fn tolerances(&self, parts: &[Part], sizes: &[(u32, u32)]) -> Vec<GeometricError> {
        sizes.iter().map(|&size| self.tolerance(parts, size)).collect()
    }

    /// A header of which camera and radius are right.
    fn seen(&self, parts: &[Part]) -> Header {
        let camera = if self.local_viewer { camera(&self.view).with_local_viewer() } else { camera(&self.view) };
        Header { camera, radius: radius(parts).to_bits(), ..Header::new_zeroed() }
    }

    /// The transparency of a part in sixteenths. What is hardly seen is seen a little.
    fn transparency(&self, part: &Part) -> u8 {
        let share = self.surfaces.get(usize::from(part.material)).map_or(0.0, |surface| surface.transparency);
        (16.0 * share).round().clamp(0.0, 15.0) as u8
    }

    /// Packs mesh and look into a stream and checks the result.
    ///
    /// # Errors
    /// When the mesh does not fit a stream, or a value lies outside its range.
    pub fn stream(&self, parts: &[Part]) -> Result<StreamBytes> {
        let vertices: usize = parts.iter().map(|p| p.vertices.len()).sum();
        let levels = || parts.iter().flat_map(Part::levels);
        let triangles: usize = levels().map(|(triangles, ..)| triangles.len()).sum();
        let [background, background_bottom] = match self.background {
            Background::Colour(colour) => [colour; 2],
            Background::Gradient { top, bottom } => [top, bottom],
        };
        let mut header = Header {
            magic: MAGIC,
            version: VERSION,
            shader: self.shader.facts().id,
            meshes: u16::try_from(levels().count()).context("too many meshes for one stream; merge objects or materials")?,
            materials: u16::try_from(self.surfaces.len()).context("too many materials for one stream; merge some")?,
            lights: self.lamps.len() as u16,
            frames: self.frames.max(1),
            vertices: u32::try_from(vertices).context("too many vertices for one stream; simplify the mesh")?,
            triangles: u32::try_from(triangles).context("too many triangles for one stream; simplify the mesh")?,
            instances: u16::try_from(self.cast.members.len()).context("too many objects for one scene")?,
            tracks: u16::try_from(self.cast.ways.len()).context("too many objects for one scene")?,
            keys: self.cast.ways.iter().map(|way| way.keys.len() as u32).sum(),
            background,
            background_bottom,
            labels: u8::try_from(self.labels.len()).context("too many labels for one scene; there may be 255")?,
            budget: self.budget.map_or(0, ErrorBudget::to_bits),
            ambient: self.ambient.map(gain).map(Gain::to_bits),
            ..self.seen(parts)
        };
        let mut coats = Coats::default();
        let numbers = parts.iter().map(|part| part.coat.as_ref().map_or(Ok((0, 0)), |coat| coats.add(coat))).collect::<Result<Vec<_>>>()?;
        let Coats { colours, textures, mut texels, .. } = coats;
        texels.resize(texels.len().next_multiple_of(4), 0);
        let (corner_colours, texture_corners) = (corner_colours(parts), places(parts)?);
        (header.colours, header.corner_colours) = (colours.len() as u16, corner_colours.len() as u32);
        (header.textures, header.texture_corners, header.texels) =
            (textures.len() as u16, texture_corners.len() as u32, texels.len() as u32);
        let names = self.names(parts)?;
        let length = stream::length(&header).and_then(|length| length.checked_add(names.len() as u32));
        header.length = length.context("the stream would be larger than 4 GiB; simplify the mesh")?;
        let mut bytes = header.as_bytes().to_vec();
        let (mut first_vertex, mut first_triangle) = (0, 0);
        for (part, &(coat, palette)) in parts.iter().zip(&numbers) {
            let vertices = u16::try_from(part.vertices.len()).context("too many vertices for one mesh; simplify the mesh")?;
            for (triangles, error, closed_convex) in part.levels() {
                let mesh = Mesh {
                    first_vertex,
                    first_triangle,
                    triangles: triangles.len() as u32,
                    vertices,
                    material: part.material,
                    error: error.to_bits(),
                    flags: if closed_convex { CLOSED_CONVEX } else { 0 } | coat | self.transparency(part) << TRANSPARENCY_SHIFT,
                    palette,
                };
                first_triangle += mesh.triangles;
                bytes.extend_from_slice(mesh.as_bytes());
            }
            first_vertex += u32::from(vertices);
        }
        self.surfaces.iter().for_each(|surface| bytes.extend_from_slice(surface.record().as_bytes()));
        self.lamps.iter().for_each(|lamp| bytes.extend_from_slice(lamp.record().as_bytes()));
        for &Member { first_mesh, meshes } in &self.cast.members {
            bytes.extend_from_slice(Instance { first_mesh, meshes, material: OWN_MATERIALS, reserved: 0 }.as_bytes());
        }
        let mut first_key = 0;
        for Way { kind, index, keys } in &self.cast.ways {
            let track = Track { kind: *kind, index: *index, first_key, keys: keys.len() as u32 };
            first_key += track.keys;
            bytes.extend_from_slice(track.as_bytes());
        }
        self.cast.ways.iter().for_each(|way| bytes.extend_from_slice(way.keys.as_bytes()));
        parts.iter().for_each(|part| bytes.extend_from_slice(part.vertices.as_bytes()));
        levels().for_each(|(triangles, ..)| bytes.extend_from_slice(triangles.as_bytes()));
        bytes.extend_from_slice(corner_colours.as_bytes());
        bytes.extend_from_slice(colours.as_bytes());
        bytes.extend_from_slice(textures.as_bytes());
        bytes.extend_from_slice(texture_corners.as_bytes());
        bytes.extend_from_slice(&texels);
        bytes.extend_from_slice(self.labels.as_bytes());
        bytes.extend_from_slice(&names);
        stream::seal(&mut bytes);
        let bytes = StreamBytes::from(bytes.as_slice());
        bytes.parse().context("the stream would not be valid")?;
        Ok(bytes)
    }

    /// Converts the names of meshes to those of a stream. The name of an object stands at its first mesh.
    fn names(&self, parts: &[Part]) -> Result<Vec<u8>> {
        let (mut bytes, mut named) = (Vec::new(), None);
        if self.objects.is_empty() {
            return Ok(bytes);
        }
        for (part, _) in parts.iter().flat_map(|part| part.levels().map(move |level| (part, level))) {
            let continues = named.replace(part.object) == Some(part.object);
            let name = if continues { "" } else { self.objects[part.object].as_str() };
            bytes.push(u8::try_from(name.len()).with_context(|| format!("the name of an object has more than {MAX_NAME} bytes"))?);
            bytes.extend_from_slice(name.as_bytes());
        }
        Ok(bytes)
    }
}

/// The palettes and textures of a stream. Equal ones are written once.
#[derive(Default)]
struct Coats {
    colours: Vec<Colour>,
    textures: Vec<Texture>,
    texels: Vec<u8>,
    /// The number of each palette, in units of [`PALETTE`] colours, and which of its colours is a hole.
    palettes: HashMap<(Vec<Rgb>, Option<u8>), u8>,
    /// The number of each texture.
    known: HashMap<Arc<Texels>, u8>,
}

impl Coats {
    /// Adds a palette or texture. Returns the flag of meshes with it, and its number.
    fn add(&mut self, coat: &Coat) -> Result<(u8, u8)> {
        match coat {
            Coat::Palette(palette) => Ok((HAS_COLOURS, self.palette(palette, None)?)),
            Coat::Texture(texels) => Ok((HAS_TEXTURE, self.texture(texels)?)),
        }
    }

    fn palette(&mut self, palette: &[Rgb], hole: Option<u8>) -> Result<u8> {
        let key = (palette.to_vec(), hole);
        if let Some(&known) = self.palettes.get(&key) {
            return Ok(known);
        }
        let next = self.colours.len().div_ceil(PALETTE);
        let number = u8::try_from(next)
            .context("too many colours for one stream; give some meshes one colour, or leave colours out by --colours none")?;
        self.colours.resize(next * PALETTE, BLACK);
        let record = |(index, &channels): (u8, &Rgb)| Colour { hole: u8::from(hole == Some(index)), ..Colour::new(channels) };
        self.colours.extend((0..=u8::MAX).zip(palette).map(record));
        self.palettes.insert(key, number);
        Ok(number)
    }

    fn texture(&mut self, texels: &Arc<Texels>) -> Result<u8> {
        if let Some(&known) = self.known.get(texels) {
            return Ok(known);
        }
        let palette = self.palette(&texels.palette, texels.hole)?;
        let number = u8::try_from(self.textures.len())
            .context("too many textures for one stream; join some in one image, or leave textures out by --colours corners")?;
        self.textures.push(Texture { size: texels.size, palette, has_holes: u8::from(texels.hole.is_some()) });
        self.texels.extend_from_slice(&texels.indices);
        self.known.insert(Arc::clone(texels), number);
        Ok(number)
    }
}

/// What fills a palette up.
const BLACK: Colour = Colour::new([0; 3]);

/// The colours at the corners of all triangles, up to the last one that has some.
fn corner_colours(parts: &[Part]) -> Vec<CornerColours> {
    let has_corners = |part: &Part| matches!(part.coat, Some(Coat::Palette(_)));
    let last = parts.iter().rposition(has_corners);
    let mut corners = Vec::new();
    for part in parts.iter().take(last.map_or(0, |last| last + 1)) {
        let colour = |index: u8| Colour::new(part.palette()[usize::from(index)]);
        let record = |paints: [Paint; 3]| match paints {
            [Paint::Colour(a), Paint::Colour(b), Paint::Colour(c)] => CornerColours::new([a, b, c], [a, b, c].map(colour)),
            _ => NO_COLOURS,
        };
        if has_corners(part) {
            corners.extend(part.colours().map(record));
        } else {
            corners.extend(part.levels().flat_map(|(triangles, ..)| triangles).map(|_| NO_COLOURS));
        }
    }
    corners
}

/// The record of a triangle without colours at its corners.
const NO_COLOURS: CornerColours = CornerColours { colours: [0; 3], range: 0 };

/// The places of all triangles that have a texture.
fn places(parts: &[Part]) -> Result<Vec<TextureCorners>> {
    let record = |paints: [Paint; 3]| match paints {
        [Paint::Place(a), Paint::Place(b), Paint::Place(c)] => {
            Some(texture_corners([a, b, c]).context("a texture repeats itself 16 times or more over a triangle; use --colours corners"))
        }
        _ => None,
    };
    parts.iter().flat_map(Part::colours).filter_map(record).collect()
}

/// Radius of the ball about the origin that holds all vertices, rounded up.
fn radius(parts: &[Part]) -> Radius {
    let vertices = parts.iter().flat_map(|part| &part.vertices);
    let farthest = vertices.map(|vertex| length(records::position(vertex).map(f64::from))).fold(0.0, f64::max);
    above(farthest)
}

fn gain(x: f64) -> Gain {
    nearest::<Gain>(x).min(Gain::from_bits(MAX_GAIN))
}

impl Surface {
    /// The record of the surface in a stream.
    #[must_use]
    pub fn record(&self) -> Material {
        let Self { ambient, diffuse, specular, exponent, .. } = *self;
        Material::new(ambient.map(gain), diffuse.map(gain), specular.map(gain), exponent)
    }
}

/// The smallest difference of the cosines of a cone: 1/1,024.
const LEAST_SOFTNESS: i16 = 16;

impl Lamp {
    /// The record of the light in a stream.
    #[must_use]
    pub fn record(&self) -> Light {
        light(self)
    }
}

fn light(lamp: &Lamp) -> Light {
    let kind = match lamp.kind {
        LampKind::Distant => DIRECTIONAL,
        LampKind::Near => POINT,
        LampKind::Sky => SKY,
    };
    let vector = if kind == POINT { lamp.vector } else { unit(lamp.vector).unwrap_or(KEY) };
    let space = if lamp.is_fixed { OBJECT_SPACE } else { EYE_SPACE };
    let mut light = Light::new(kind, space, vector.map(nearest), lamp.colour.map(gain));
    light.range = lamp.range.map_or(0, |range| nearest::<Reach>(range).to_bits());
    if let Some(cone) = lamp.cone {
        let [edge, full] = [cone.edge, cone.full].map(|angle| nearest::<Unit>(libm::cos(angle.to_radians())).to_bits());
        light.axis = unit(cone.axis).unwrap_or(KEY).map(|c| nearest::<Unit>(c).to_bits());
        let edge = edge.min((1 << UNIT) - LEAST_SOFTNESS);
        light.cone = [edge, full.max(edge + LEAST_SOFTNESS)];
    }
    light
}

fn camera(view: &View) -> Camera {
    let projection = if view.projection == Projection::Perspective { PERSPECTIVE } else { ORTHOGRAPHIC };
    let rotation = view.rotation.map(|row| row.map(nearest));
    let depths = [view.near, view.far].map(nearest);
    records::camera(projection, rotation, view.translation.map(nearest), nearest(view.focal), depths)
        .orbiting(view.axis.map(nearest), view.period)
}
