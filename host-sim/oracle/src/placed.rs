//! Objects of a scene in one frame, where lights and viewer are seen from the space of each, and corners are not rounded to parts of a pixel.

use super::{
    frame::{Frame, Projected, facets, gain, real, rounded},
    scene::{Light, Place, direction},
};
use anyhow::Result;
use embedded_graphics_core::{geometry::Size, pixelcolor::Gray8};
use microphong::{
    Pose, Renderer, Shader, Stream,
    format::{Focal, ROTATION, UNIT},
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    stream::record::{self, Camera, EYE_SPACE, PERSPECTIVE, POINT, SKY, VIEWER_LOCAL},
};
use microphong_models::{
    levels,
    vector::{V3, add, cross, scale, sub},
};
use microphong_render::render;

/// Another space than that of an object.
pub(super) struct Space {
    /// Its axes, in object space.
    pub(super) axes: [V3; 3],
    /// The origin of object space in it.
    origin: V3,
    /// The length of a unit of object space in it.
    unit: f64,
}

impl Space {
    /// Object space itself.
    pub(super) const SAME: Self = Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3], unit: 1.0 };

    /// The space of the eye: its axes lead to the right, up, and away from the viewer.
    pub(super) fn eye(model_view: &ModelView) -> Self {
        Self {
            axes: model_view.rotation.map(|row| real(row, ROTATION)),
            origin: real(model_view.translation, UNIT),
            unit: f64::from(model_view.scale) / 65_536.0,
        }
    }

    /// The world in which an object has this pose.
    fn world(pose: &Pose) -> Self {
        let [w, x, y, z] = pose.quaternion().map(f64::from);
        // The object is turned by v + 2 q × (q × v + w v), and an axis of the world by the opposite.
        let back = |v: V3| {
            let axis = [-x, -y, -z];
            add(v, scale(cross(axis, add(cross(axis, v), scale(v, w))), 2.0))
        };
        Self { axes: Self::SAME.axes.map(back), origin: pose.position().map(f64::from), unit: pose.scale().into() }
    }

    /// A direction of this space, in object space.
    fn direction(&self, v: V3) -> V3 {
        let [x, y, z] = self.axes;
        add(add(scale(x, v[0]), scale(y, v[1])), scale(z, v[2]))
    }

    /// A point of this space, in object space.
    fn point(&self, v: V3) -> V3 {
        scale(self.direction(sub(v, self.origin)), 1.0 / self.unit)
    }
}

/// The lights of a scene and its camera, for one object.
pub(super) struct Lights<'a> {
    pub(super) camera: &'a Camera,
    pub(super) lights: &'a [record::Light],
    pub(super) eye: Space,
    pub(super) world: Space,
}

impl Lights<'_> {
    /// A light in object space.
    pub(super) fn light(&self, light: &record::Light) -> Light {
        let space = if light.space == EYE_SPACE { &self.eye } else { &self.world };
        let vector = real(light.vector, UNIT);
        let place = if light.kind == POINT { Place::Near(space.point(vector)) } else { Place::Far(direction(space.direction(vector))) };
        let axis = space.direction(real(light.axis, UNIT));
        Light {
            is_sky: light.kind == SKY,
            range: (light.range > 0).then(|| f64::from(light.range()) / self.world.unit),
            cone: (light.axis != [0; 3]).then(|| (direction(axis), real(light.cone, UNIT))),
            ..Light::even(place, gain(light.colour()))
        }
    }

    /// Position from which highlights are seen, in object space.
    pub(super) fn viewer(&self) -> Place {
        let is_near = self.camera.viewer == VIEWER_LOCAL && self.camera.projection == PERSPECTIVE;
        if is_near { Place::Near(self.eye.point([0.0; 3])) } else { Place::Far(direction(self.eye.direction([0.0, 0.0, -1.0]))) }
    }
}

/// The place in pixels, and the inverse depth, of a point of eye space; `None` in front of the near plane.
fn projected(camera: &Camera, size: (u32, u32), eye: [i32; 3]) -> Projected {
    let ([x, y, z], [near, far]) = (real(eye, UNIT), real([camera.near, camera.far], UNIT));
    let focal = f64::from(size.0.min(size.1)) / 2.0 * f64::from(Focal::from_bits(camera.focal));
    let is_perspective = camera.projection == PERSPECTIVE;
    let (focal, inv_depth) = if is_perspective { (focal / z, near / z) } else { (focal, (far - z) / (far - near)) };
    let centre = [size.0, size.1].map(|side| f64::from(side) / 2.0);
    (z >= near).then_some(([centre[0] + x * focal, centre[1] - y * focal], inv_depth))
}

impl Frame {
    /// Frame `number` of a stream on a picture of `size` pixels, as one frame for each visible object, the nearest first, each in the space of its object.
    ///
    /// Corners lie where exact projection has them, also far outside the picture. Triangles that cross the near plane are left out. If there is one
    /// object, its meshes have the levels of detail that the renderer draws. Of several, all meshes are full: coarser levels lie within half a pixel.
    ///
    /// # Errors
    /// When `size` is out of range.
    pub fn objects(stream: Stream<'_>, size: (u32, u32), number: u32, perspective_correct: bool) -> Result<Vec<Self>> {
        Self::objects_by(stream, size, number, perspective_correct, &|camera, _, eye| projected(camera, size, eye))
    }

    /// The frames of [`Self::objects`], whose corners lie where the renderer has them. Triangles that leave the guard band are left out.
    ///
    /// # Errors
    /// When `size` is out of range.
    pub fn objects_as_drawn(stream: Stream<'_>, size: (u32, u32), number: u32, perspective_correct: bool) -> Result<Vec<Self>> {
        Self::objects_by(stream, size, number, perspective_correct, &|_, lens, eye| rounded(lens, eye))
    }

    fn objects_by(
        stream: Stream<'_>,
        size: (u32, u32),
        number: u32,
        perspective_correct: bool,
        project: &dyn Fn(&Camera, &Lens, [i32; 3]) -> Projected,
    ) -> Result<Vec<Self>> {
        let picture = Size::new(size.0, size.1);
        let layout = render::layout(&stream, picture, 1);
        let mut memory = vec![0; layout.words::<Gray8>()];
        let mut renderer = Renderer::<Gray8>::with_shader(stream, picture, &layout, &mut memory, Shader::FLAT)?;
        let scene = renderer.scene();
        scene.play(number);
        let camera = scene.camera();
        let (lens, eye) = (Lens::new(camera, picture), ModelView::new(camera, number));
        let mut objects: Vec<_> =
            scene.objects().iter().filter(|object| object.is_visible()).map(|object| (eye.of(&object.pose()), object)).collect();
        objects.sort_by_key(|(model_view, _)| model_view.translation[2]);
        let frame = |(model_view, object): &(ModelView, &microphong::Object)| {
            let range = object.meshes();
            let full = stream.meshes[usize::from(range.start)..usize::from(range.end)].iter().filter(|mesh| mesh.error == 0);
            let meshes: Vec<_> = if stream.instances.is_empty() { levels::drawn(&stream, picture).collect() } else { full.collect() };
            let mut facets = facets(stream, meshes.into_iter(), &View::new(&lens, model_view), &|eye| project(camera, &lens, eye));
            if let Some(material) = object.material() {
                facets.iter_mut().for_each(|facet| facet.material = material.into());
            }
            let world = Space::world(&object.pose());
            let lights = Lights { camera, lights: scene.lights(), eye: Space::eye(model_view), world };
            let frame = Self::lit_by(stream, size, &lights, facets);
            if perspective_correct { frame.corrected(stream) } else { frame }
        };
        Ok(objects.iter().map(frame).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong::format::Length;
    use microphong_models::{scene, vector::dot};

    /// The frame of one object is the one with rounded corners, but for the rounding.
    #[test]
    fn one_object_is_the_frame() {
        for name in ["teapot", "sphere-40", "sphere-690", "bunny", "torus"] {
            let stream = scene::load(name).unwrap().stream;
            let stream = stream.parse().unwrap();
            let (rounded, exact) = (Frame::new(stream, (160, 120), 3), Frame::objects(stream, (160, 120), 3, false).unwrap());
            let [exact] = &exact[..] else { panic!("{name} is one object") };
            assert_eq!((&rounded.lights, rounded.viewer, &rounded.materials), (&exact.lights, exact.viewer, &exact.materials), "{name}");
            let mut both = 0;
            for facet in &rounded.facets {
                // Rounding may turn over a thin facet.
                let Some(other) = exact.facets.iter().find(|other| other.id == facet.id) else { continue };
                both += 1;
                for k in 0..3 {
                    let off = (0..2).map(|c| (facet.screen[k][c] - other.screen[k][c]).abs()).fold(0.0, f64::max);
                    assert!(off < 0.04 && (facet.inv_depth[k] - other.inv_depth[k]).abs() < 1e-5, "{name}: {facet:?} {other:?}");
                }
            }
            assert!(both > rounded.facets.len() * 9 / 10 && exact.facets.len().abs_diff(both) < both / 10, "{name}: {both}");
        }
    }

    /// A quarter of a turn about y moves the x axis to -z. A point of the world goes back the same way, and is seen from the object in its units.
    #[test]
    fn spaces_turn_back() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let quaternion = [half, 0.0, half, 0.0].map(microphong::format::Rotation::from_num);
        let pose = Pose::from_quaternion(quaternion).unwrap().at([1, 2, 3].map(Length::from_num)).unwrap();
        let space = Space::world(&pose.scaled(microphong::format::Scale::from_num(2)).unwrap());
        let is_near = |found: V3, expected: V3| dot(sub(found, expected), sub(found, expected)) < 1e-12;
        assert!(is_near(space.direction([0.0, 0.0, -1.0]), [1.0, 0.0, 0.0]), "{:?}", space.direction([0.0, 0.0, -1.0]));
        assert!(is_near(space.point([1.0, 2.0, 1.0]), [1.0, 0.0, 0.0]), "{:?}", space.point([1.0, 2.0, 1.0]));
    }
}
