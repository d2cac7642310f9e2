//! The triangles of one frame that face the viewer, where they lie on the screen, and what shines on them.

use super::{
    Levels,
    placed::{Lights, Space},
    scanline::lerp,
    scene::{Light, Material, Place, direction},
    texture::Texture,
};
use embedded_graphics_core::geometry::Size;
use microphong::{
    Stream,
    format::{DEPTH, Gain, NORMAL_LENGTH, SUBPIXEL, UNIT},
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    stream::{MeshColours, record},
};
use microphong_models::{
    levels,
    vector::{V3, add, apply, cross, dot, length, scale, sub},
};

/// Largest number of lights that [`Frame::mixtures`] returns. Five times the largest number of outcomes of a method are fewer.
pub const MOST_MIXTURES: usize = 1 << 11;

/// All data on which a picture of one frame depends, in object space.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Front faces that are not empty, in the stream's order.
    pub facets: Vec<Facet>,
    /// All lights.
    pub lights: Vec<Light>,
    /// Position from which highlights are seen.
    pub viewer: Place,
    /// The axes of the eye: to the right, up, and towards the viewer.
    pub axes: [V3; 3],
    /// Materials in the stream's order.
    pub materials: Vec<Material>,
    /// Colours of the first and of the last row where nothing is drawn, in 1/255. All other rows lie evenly between them.
    pub background: [Levels; 2],
    /// Whether pixels are grey: all light is its luma, and so are the colours of surfaces.
    pub is_gray: bool,
}

/// A triangle.
#[derive(Clone, Debug)]
pub struct Facet {
    /// Corners in pixels, clockwise on a screen whose y runs down.
    pub screen: [[f64; 2]; 3],
    /// Inverse depth of the corners: 1 at the near plane, 0 far away, linear on the screen.
    pub inv_depth: [f64; 3],
    /// Weight of each corner's share of the screen in space: 1, or its inverse depth if perspective is corrected.
    pub shares: [f64; 3],
    /// Numbers of the corners' vertices in the whole scene. Neighbours share them.
    pub vertices: [usize; 3],
    /// Normals of the corners as stored. Their length is 1 but for rounding.
    pub normals: [V3; 3],
    /// Corners in object space.
    pub positions: [V3; 3],
    /// Colours of the corners: the part of the ambient and of the diffuse light that is reflected, besides what the material does. `None` if no
    /// mesh of this material has colours; if others have, this one is white.
    pub albedos: Option<[V3; 3]>,
    /// The texture, if the mesh has one.
    pub texture: Option<Texture>,
    /// Whether the facet has the colour of one texel of its texture.
    pub is_painted: bool,
    /// Unit normal of the plane.
    pub plane: V3,
    /// No interpolated normal is shorter.
    pub min_normal_length: f64,
    /// The part of the light from behind that the facet lets through.
    pub transparency: f64,
    /// Index of the material.
    pub material: usize,
    /// Index of the triangle in the stream.
    pub id: u32,
}

/// A point of a triangle: what its light depends on, besides cosines.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint {
    /// In object space.
    pub(super) position: V3,
    /// Red, green and blue; 1 reflects all that the material does.
    pub(super) albedo: V3,
}

/// Converts fixed-point numbers of a stream.
pub(super) fn real<T: Into<f64>, const N: usize>(v: [T; N], bits: u32) -> [f64; N] {
    v.map(|c| c.into() / f64::from(bits).exp2())
}

/// Reflectance or light.
pub(super) fn gain(colour: [Gain; 3]) -> V3 {
    colour.map(f64::from)
}

impl Frame {
    /// Frame `number` of a stream on a picture of `size` pixels.
    ///
    /// Meshes have the levels of detail that the renderer draws: shading is judged, not simplification.
    /// Triangles that cross the near plane or leave the guard band are left out: clipping makes new corners.
    #[must_use]
    pub fn new(stream: Stream<'_>, size: (u32, u32), number: u32) -> Self {
        let camera = &stream.header.camera;
        let model_view = ModelView::new(camera, number);
        let lens = Lens::new(camera, Size::new(size.0, size.1));
        let levels = levels::drawn(&stream, Size::new(size.0, size.1));
        let facets = facets(stream, levels, &View::new(&lens, &model_view), &|eye| rounded(&lens, eye));
        let lights = Lights { camera, lights: stream.lights, eye: Space::eye(&model_view), world: Space::SAME };
        Self::lit_by(stream, size, &lights, facets)
    }

    /// The facets of one object under lights.
    pub(super) fn lit_by(stream: Stream<'_>, size: (u32, u32), lights: &Lights<'_>, facets: Vec<Facet>) -> Self {
        let around = gain(stream.header.ambient());
        let materials = stream.materials.iter().map(|material| {
            let ambient = gain(material.ambient());
            Material {
                ambient: [0, 1, 2].map(|k| ambient[k] * around[k]),
                diffuse: gain(material.diffuse()),
                specular: gain(material.specular()),
                exponent: material.exponent.into(),
            }
        });
        let [right, up, away] = lights.eye.axes;
        Self {
            size,
            facets,
            lights: lights.lights.iter().map(|light| lights.light(light)).collect(),
            viewer: lights.viewer(),
            axes: [direction(right), direction(up), direction(scale(away, -1.0))],
            materials: materials.collect(),
            background: [stream.header.background, stream.header.background_bottom].map(|colour| colour.map(f64::from)),
            is_gray: false,
        }
    }

    /// This frame in greys. The grey of a background is a whole number.
    #[must_use]
    pub fn in_greys(self) -> Self {
        let gray = Self { is_gray: true, ..self };
        Self { background: gray.background.map(|colour| gray.shown(colour).map(f64::floor)), ..gray }
    }

    /// The colour of a row where nothing is drawn.
    #[must_use]
    pub fn background(&self, row: u32) -> Levels {
        let [top, bottom] = self.background;
        lerp(top, bottom, f64::from(row) / f64::from(self.size.1.max(2) - 1))
    }

    /// The light of a pixel of `row` in which these facets are seen, in the order of drawing, each with its own light.
    #[must_use]
    pub fn mixed(&self, row: u32, seen: impl IntoIterator<Item = (u32, Levels)>) -> Levels {
        self.mixtures(row, seen.into_iter().map(|(facet, light)| (facet, vec![light])))[0]
    }

    /// The lights that such a pixel may have if each facet has one of several lights: first the mixture of the first light of each. There are at most
    /// [`MOST_MIXTURES`].
    #[must_use]
    pub fn mixtures(&self, row: u32, seen: impl IntoIterator<Item = (u32, Vec<Levels>)>) -> Vec<Levels> {
        seen.into_iter().fold(vec![self.background(row)], |behind, (facet, lights)| {
            let facet = &self.facets[facet as usize];
            let over = |light: &Levels| behind.iter().map(|&behind| facet.over(*light, behind)).collect::<Vec<_>>();
            lights.iter().flat_map(over).take(MOST_MIXTURES).collect()
        })
    }

    /// A frame as [`Self::new`] makes it, in which methods take the point of the triangle that is seen. [`Self::new`] takes the point that divides
    /// the triangle of the screen in the same way. With parallel rays both points are equal.
    #[must_use]
    pub fn perspective_correct(stream: Stream<'_>, size: (u32, u32), number: u32) -> Self {
        Self::new(stream, size, number).corrected(stream)
    }

    /// This frame of a stream in perspective.
    pub(super) fn corrected(mut self, stream: Stream<'_>) -> Self {
        if stream.is_perspective() {
            self.facets.iter_mut().for_each(|facet| facet.shares = facet.inv_depth);
        }
        self
    }

    /// Whether lights and viewer are all infinitely far: N·L and N·H then depend on the normal alone.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.lights.iter().map(|light| light.place).chain([self.viewer]).all(|place| matches!(place, Place::Far(_)))
    }
}

/// The corners of a record in the order of a facet. Streams list corners counter-clockwise.
const CLOCKWISE: [usize; 3] = [0, 2, 1];

/// Colours of the corners of a triangle; `None` if it has none.
fn albedos(stream: Stream<'_>, mesh: &record::Mesh, id: u32) -> Option<[V3; 3]> {
    let Some(MeshColours { palette, corners }) = stream.colours_of(mesh) else {
        // A material has three channels for all of its meshes, or for none.
        let shares = |other: &record::Mesh| {
            other.material == mesh.material && (stream.colours_of(other).is_some() || stream.texture_of(other).is_some())
        };
        return stream.meshes.iter().any(shares).then_some([[1.0; 3]; 3]);
    };
    let colours = corners.get((id - mesh.first_triangle) as usize)?.colours;
    let mut albedos = [[0.0; 3]; 3];
    for (albedo, corner) in albedos.iter_mut().zip(CLOCKWISE) {
        *albedo = palette.get(usize::from(colours[corner]))?.channels.map(|channel| f64::from(channel) / 255.0);
    }
    Some(albedos)
}

/// The place in pixels, and the inverse depth, of a point; `None` if its triangles have to be clipped.
pub(super) type Projected = Option<([f64; 2], f64)>;

/// The projection of a point in the integers of eye space.
pub(super) type Project<'p> = dyn Fn([i32; 3]) -> Projected + 'p;

/// The place and the inverse depth that the renderer has for a point; `None` outside the guard band.
pub(super) fn rounded(lens: &Lens, eye: [i32; 3]) -> Projected {
    let ([x, y, depth], inside) = lens.project(eye);
    inside.then(|| (real([x, y], SUBPIXEL), f64::from(depth) / f64::from(DEPTH).exp2()))
}

/// The triangles of meshes as facets on the screen.
pub(super) fn facets<'a>(
    stream: Stream<'a>,
    meshes: impl Iterator<Item = &'a record::Mesh>,
    view: &View,
    project: &Project<'_>,
) -> Vec<Facet> {
    let of = |mesh: &'a record::Mesh| {
        let triangles = stream.triangles_of(mesh).unwrap_or_default();
        (mesh.first_triangle..).zip(triangles).filter_map(move |(id, triangle)| facet(stream, mesh, triangle, id, view, project))
    };
    meshes.flat_map(of).collect()
}

/// A record as a facet on the screen; `None` if it shows its back, is empty there, or has to be clipped.
fn facet(
    stream: Stream<'_>,
    mesh: &record::Mesh,
    triangle: &record::Triangle,
    id: u32,
    view: &View,
    project: &Project<'_>,
) -> Option<Facet> {
    let vertices = CLOCKWISE.map(|corner| mesh.first_vertex as usize + usize::from(triangle.corners[corner]));
    let mut corners = [record::Vertex::ZERO; 3];
    let (mut screen, mut inv_depth) = ([[0.0; 2]; 3], [0.0; 3]);
    for k in 0..3 {
        corners[k] = *stream.vertices.get(vertices[k])?;
        (screen[k], inv_depth[k]) = project(view.to_eye(corners[k].position))?;
    }
    let [p, q, r] = screen;
    if (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) <= 0.0 {
        return None;
    }
    Some(Facet {
        screen,
        inv_depth,
        shares: [1.0; 3],
        vertices,
        normals: corners.map(|v| real(v.normal, UNIT)),
        positions: corners.map(|v| real(v.position, UNIT)),
        albedos: albedos(stream, mesh, id),
        texture: Texture::of(stream, mesh, id, CLOCKWISE, inv_depth),
        is_painted: false,
        plane: real(triangle.normal, UNIT),
        min_normal_length: f64::from(triangle.min_normal_length) / f64::from(NORMAL_LENGTH).exp2(),
        transparency: f64::from(mesh.transparency()) / 16.0,
        material: mesh.material.into(),
        id,
    })
}

impl Facet {
    /// Affine coordinates of the corners.
    pub(super) const CORNERS: [V3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// Affine coordinates of the centroid.
    pub(super) const CENTRE: V3 = [1.0 / 3.0; 3];

    /// A triangle that comes from no stream. `screen` runs clockwise (y down), and so do the other corners.
    #[must_use]
    pub fn new(screen: [[f64; 2]; 3], vertices: [usize; 3], normals: [V3; 3], positions: [V3; 3]) -> Self {
        let [a, b, c] = positions;
        Self {
            screen,
            inv_depth: [0.5; 3],
            shares: [1.0; 3],
            vertices,
            normals,
            positions,
            albedos: None,
            texture: None,
            is_painted: false,
            plane: direction(cross(sub(c, a), sub(b, a))),
            min_normal_length: shortest(&normals),
            transparency: 0.0,
            material: 0,
            id: 0,
        }
    }

    /// The light of a pixel that the facet covers with this light, in front of what was there before.
    #[must_use]
    pub fn over(&self, light: Levels, behind: Levels) -> Levels {
        lerp(light, behind, self.transparency)
    }

    /// Affine coordinates of the point that is seen at a point of the screen: the corners' shares, whose sum is one.
    #[must_use]
    pub fn weights(&self, p: [f64; 2]) -> V3 {
        self.seen(self.flat_weights(p))
    }

    /// Affine coordinates of the point that is seen at the point of the screen with the affine coordinates `flat`.
    pub(super) fn seen(&self, flat: V3) -> V3 {
        let parts = [0, 1, 2].map(|k| flat[k] * self.shares[k]);
        let whole: f64 = parts.iter().sum();
        parts.map(|part| part / whole)
    }

    /// Whether a quadratic on the screen has its nodes there: without perspective, or if normals bend so little that none is shorter than 1/2.
    pub(super) fn has_screen_nodes(&self) -> bool {
        self.shares == [1.0; 3] || self.min_normal_length >= 0.5
    }

    /// Affine coordinates of a point on the screen.
    #[must_use]
    pub fn flat_weights(&self, p: [f64; 2]) -> V3 {
        let [a, b, c] = self.screen;
        let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let whole = area(a, b, c);
        [area(p, b, c), area(p, c, a), area(p, a, b)].map(|part| part / whole)
    }

    /// The linearly interpolated normal, shorter than one between the corners.
    #[must_use]
    pub fn normal(&self, weights: V3) -> V3 {
        mixed(&self.normals, weights)
    }

    /// The point of the triangle in object space.
    #[must_use]
    pub fn position(&self, weights: V3) -> V3 {
        mixed(&self.positions, weights)
    }

    /// The colour of a point of the triangle, linear between the corners: white if they have none.
    #[must_use]
    pub fn albedo(&self, weights: V3) -> V3 {
        self.albedos.map_or([1.0; 3], |albedos| mixed(&albedos, weights))
    }

    /// The point of the triangle with these affine coordinates.
    pub(super) fn point(&self, weights: V3) -> SurfacePoint {
        SurfacePoint { position: self.position(weights), albedo: self.albedo(weights) }
    }

    /// The point of the triangle that a method takes at a point of the screen.
    pub(super) fn at(&self, p: [f64; 2]) -> SurfacePoint {
        self.point(self.weights(p))
    }

    /// The normal that a node of a polynomial has: a corner's as it stands, all others of unit length.
    pub(super) fn node(&self, weights: V3) -> V3 {
        let normal = self.normal(weights);
        if weights.contains(&1.0) { normal } else { direction(normal) }
    }

    /// No interpolated normal is shorter, and none is as short unless all three edges turn it as far.
    pub(super) fn shortest_normal(&self) -> f64 {
        shortest(&self.normals)
    }

    /// Length of the interpolated normal at the midpoint of the edge from corner `i` to `j`.
    pub(super) fn middle(&self, i: usize, j: usize) -> f64 {
        length(add(self.normals[i], self.normals[j])) / 2.0
    }
}

/// The length of the mean of three unit vectors each two of which enclose the widest angle of these.
fn shortest(normals: &[V3; 3]) -> f64 {
    let least = [0, 1, 2].map(|k| dot(normals[k], normals[(k + 1) % 3])).into_iter().fold(1.0, f64::min);
    ((1.0 + 2.0 * least) / 3.0).max(0.0).sqrt()
}

/// Sum of three vectors, weighted.
pub(super) fn mixed(v: &[V3; 3], weights: V3) -> V3 {
    apply(&[[v[0][0], v[1][0], v[2][0]], [v[0][1], v[1][1], v[2][1]], [v[0][2], v[1][2], v[2][2]]], weights)
}
