//! The scene: objects, lights, a camera. A program can change it between frames.
//!
//! ```
//! use embedded_graphics_core::pixelcolor::Rgb565;
//! use microphong::{Pose, Renderer, SceneError, fixed::types::I18F14};
//!
//! /// Two objects, of meshes 0 and 1 of the stream: the second stands to the right of the first. Once, before the first frame.
//! fn arrange(renderer: &mut Renderer<'_, Rgb565>) -> Result<(), SceneError> {
//!     let scene = renderer.scene();
//!     let [zero, half, two, five] = ["0", "0.5", "2", "5"].map(|text| text.parse().unwrap_or(I18F14::ZERO));
//!     scene.clear();
//!     scene.add(0..1, Pose::IDENTITY)?;
//!     scene.add(1..2, Pose::IDENTITY.at([two, zero, zero])?)?;
//!     scene.look_at([zero, half, five], [zero; 3], [zero, I18F14::ONE, zero])
//! }
//!
//! /// The first object lies as a sensor says; [`Renderer::draw`] draws it so.
//! fn follow(renderer: &mut Renderer<'_, Rgb565>, quaternion: [f32; 4]) -> Result<(), SceneError> {
//!     renderer.scene().set_pose(0, Pose::from_f32(quaternion, [0.0; 3], 1.0)?)
//! }
//! ```

mod angle;
mod background;
mod bounding_volume;
mod error;
mod light;
mod light_terms;
mod object;
pub(crate) mod orbit;
mod outlines;
mod pose;

pub use crate::stream::record::MAX_POSITION;
pub use angle::SIN_COS_ERROR;
pub use background::Background;
pub(crate) use bounding_volume::BoundingVolume;
pub use error::SceneError;
pub(crate) use error::{NO_EDGE_MEMORY, NO_NEIGHBOURS};
pub(crate) use light_terms::{Colour, LightTerms, largest};
pub use object::Object;
pub use orbit::{ORBIT_ERROR, ROTATION_ERROR};
pub use outlines::Outlines;
pub use pose::{MAX_SCALE, MIN_SCALE, Pose, QUATERNION_ERROR, STEP_ERROR};

use crate::{
    features::{ANIMATION, ANTIALIAS, COLOURS, Feature, NEAR_LIGHTS, OBJECTS, VERTEX_COLOURS},
    format::{Gain, Length, MAX_LIGHTS, ROTATION},
    math::vector::dot,
    pixel::Channels,
    stream::{
        Stream, is_gain,
        record::{Camera, LIGHT_TRACK, Light, Material, Mesh, OBJECT_TRACK, OWN_MATERIALS, PERSPECTIVE, POINT, Track},
    },
};
use core::ops::Range;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Limits of the shading method in use. A change of the scene beyond them is refused.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Whether near lights and a local viewer are possible.
    pub(crate) near_lights: bool,
    /// Whether a perspective camera is possible, with light interpolated as it is now.
    pub(crate) perspective: bool,
    pub(crate) least_exponent: u16,
}

/// A material of a scene, and whether its tables have to be computed again.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct SceneMaterial {
    pub(crate) material: Material,
    pub(crate) is_stale: u16,
}

/// A scene: objects, materials, lights, a camera and a background. [`Renderer::scene`](crate::Renderer::scene) gives access to it.
///
/// A scene begins with the contents of the stream (mesh file). If the stream lists no objects, there is one object that consists of all
/// meshes. A change is checked at once, and the next [`Renderer::draw`](crate::Renderer::draw) shows it.
///
/// The world is right-handed: x to the right, y up, z to the viewer. Objects lie within 16 units of the origin along each axis, at scales
/// of 1/16 to 8. The depth buffer has 16 bits, which hold `near / z`: if the farthest object is 30 times as far as the near plane, surfaces
/// are told apart from 1/1000 of that range on.
#[derive(Debug)]
pub struct Scene<'a> {
    pub(crate) stream: Stream<'a>,
    pub(crate) camera: Camera,
    /// The frame of the orbit in which the camera is.
    pub(crate) place: u32,
    /// The frame that tracks were last followed to.
    played: Option<u32>,
    lights: heapless::Vec<Light, MAX_LIGHTS>,
    pub(crate) ambient: [u16; 3],
    background: Background,
    outlines: Option<Outlines>,
    /// Whether there is memory for edges, which are smoothed or drawn as lines.
    has_edge_memory: bool,
    materials: &'a mut [SceneMaterial],
    /// Room for objects, of which `count` are used.
    objects: &'a mut [Object],
    count: usize,
    /// Limits of the method in use. The scene is within them.
    pub(crate) limits: Limits,
    /// Properties of the pixel format.
    pub(crate) channels: Channels,
    /// Whether something other than the place of single objects has changed since the latest frame. Objects know themselves whether they have moved.
    pub(crate) repainted: bool,
    /// Whether all objects are seen otherwise than in the latest frame.
    pub(crate) view_changed: bool,
    /// Whether there are other objects than in the latest frame.
    pub(crate) rearranged: bool,
}

impl<'a> Scene<'a> {
    /// The scene of a stream; there is room for one object and all materials.
    pub(crate) fn new(
        stream: Stream<'a>,
        materials: &'a mut [SceneMaterial],
        objects: &'a mut [Object],
        has_edge_memory: bool,
        limits: Limits,
        channels: Channels,
    ) -> Self {
        // There may be room for more, which nobody has written to.
        let materials = materials.get_mut(..stream.materials.len()).unwrap_or_default();
        for (slot, &material) in materials.iter_mut().zip(stream.materials) {
            *slot = SceneMaterial { material, is_stale: 1 };
        }
        let mut scene = Self {
            stream,
            camera: stream.header.camera,
            place: 0,
            played: None,
            // A checked stream has no more lights than there is room for.
            lights: heapless::Vec::from_slice(stream.lights).unwrap_or_default(),
            ambient: stream.header.ambient,
            background: Background::between(stream.header.background, stream.header.background_bottom),
            // A renderer is refused where a program without the feature would have to draw lines.
            outlines: if ANTIALIAS { Outlines::of(stream.header) } else { None },
            has_edge_memory,
            materials,
            objects,
            count: 0,
            limits,
            channels,
            repainted: true,
            view_changed: true,
            rearranged: true,
        };
        // A renderer is refused where the stream has more objects than there is room for.
        for instance in stream.instances {
            let meshes = instance.first_mesh..instance.first_mesh.saturating_add(instance.meshes);
            if let Ok(index) = scene.add(meshes, Pose::IDENTITY) {
                let _ = scene.set_object_material(index, (instance.material != OWN_MATERIALS).then_some(instance.material));
            }
        }
        if stream.instances.is_empty() {
            let _ = scene.add(0..stream.meshes.len() as u16, Pose::IDENTITY);
        }
        scene.play(0);
        scene
    }

    /// Moves the camera, the objects and the lights to where the animation in the stream (mesh file) has them in frame `number`. A number
    /// beyond the last frame starts over. Nothing is drawn; [`Renderer::frame`](crate::Renderer::frame) does both.
    pub fn play(&mut self, number: u32) {
        let place = self.place_of(number);
        if place != self.place {
            self.place = place;
            self.set_view_changed();
        }
        let frame = self.frame_of(number);
        if ANIMATION && self.played != frame {
            // What has one key is put there once; a program may move it from there.
            let fewest = if self.played.is_some() { 2 } else { 1 };
            self.played = frame;
            let stream = self.stream;
            for track in stream.tracks.iter().filter(|track| track.keys >= fewest) {
                self.follow(track, frame.unwrap_or(0));
            }
        }
    }

    /// Moves what `track` moves.
    fn follow(&mut self, track: &Track, frame: u32) {
        let keys = self.stream.keys_of(track).unwrap_or_default();
        let next = keys.partition_point(|key| key.frame <= frame);
        let Some(key) = keys.get(next.saturating_sub(1)) else { return };
        let (mut pose, index) = (Pose::of_key(key), usize::from(track.index));
        let is_hidden = key.scale == 0;
        if let Some(after) = keys.get(next).filter(|after| next > 0 && !is_hidden && after.scale != 0) {
            // A stream has no more frames than 16 bits can count.
            let share = (frame.wrapping_sub(key.frame) << 16).checked_div(after.frame.wrapping_sub(key.frame)).unwrap_or(0);
            pose = pose.towards(&Pose::of_key(after), share.into());
        }
        // A checked stream has what its tracks move.
        match track.kind {
            OBJECT_TRACK => {
                if let Ok(object) = self.object(index) {
                    let pose = if is_hidden { object.pose } else { pose };
                    object.place(pose, is_hidden);
                }
            }
            LIGHT_TRACK => {
                let vector = pose.position().map(Length::to_bits);
                if let Some(light) = self.lights.get_mut(index).filter(|light| light.vector != vector) {
                    light.vector = vector;
                    self.set_view_changed();
                }
            }
            _ => {
                let _ = self.set_camera_pose(&pose);
            }
        }
    }

    /// The number of frame `number` within its orbit.
    fn place_of(&self, number: u32) -> u32 {
        number.checked_rem(self.camera.period.into()).unwrap_or(0)
    }

    /// The number of frame `number` within the animation; `None` if the stream has no tracks.
    fn frame_of(&self, number: u32) -> Option<u32> {
        if self.stream.tracks.is_empty() { None } else { number.checked_rem(self.stream.header.frames.into()) }
    }

    /// Whether frame `number` of the ready-made animation is what was drawn last.
    pub(crate) fn is_latest(&self, number: u32) -> bool {
        self.is_unchanged() && self.place == self.place_of(number) && self.played == self.frame_of(number)
    }

    /// Returns `true` if the scene has not changed since the frame that was drawn last.
    #[must_use]
    pub fn is_unchanged(&self) -> bool {
        !self.repainted && self.objects().iter().all(|object| object.has_moved == 0)
    }

    /// Marks the scene as drawn.
    pub(crate) fn set_drawn(&mut self) {
        (self.repainted, self.view_changed, self.rearranged) = (false, false, false);
        self.objects.iter_mut().for_each(|object| object.has_moved = 0);
    }

    /// Marks the whole picture as changed, because of a setting or of the camera.
    pub(crate) fn set_view_changed(&mut self) {
        (self.view_changed, self.repainted) = (true, true);
    }

    /// Returns the objects in the order of their indices. Where surfaces of two objects lie at exactly equal depth, the object whose origin
    /// is nearer to the camera is visible; if these are equal, too, the earlier one.
    #[must_use]
    pub fn objects(&self) -> &[Object] {
        self.objects.get(..if OBJECTS { self.count } else { self.count.min(1) }).unwrap_or_default()
    }

    /// Removes all objects. Call this before [`Self::add`] if the program builds its own scene, because a new scene has objects already:
    /// the objects of the stream (mesh file), or one that consists of all meshes.
    pub fn clear(&mut self) {
        self.count = 0;
        self.rearrange();
    }

    /// Adds an object and returns its index. `meshes` are the indices of its meshes in the stream (mesh file), as [`Stream::mesh`] returns
    /// them for a name. Several objects can share meshes. The object is visible, and each mesh has its own material.
    ///
    /// # Errors
    /// Returns [`SceneError::Meshes`] if the stream does not have these meshes, and [`SceneError::Objects`] if the layout has no room for
    /// another object ([`Layout::objects`](crate::Layout::objects)).
    ///
    /// Returns [`SceneError::Feature`] if the change needs a cargo feature of this crate that is turned off.
    pub fn add(&mut self, meshes: Range<u16>, pose: Pose) -> Result<usize, SceneError> {
        require(Feature::Objects, self.count > 0)?;
        let object = Object::new(&self.stream, meshes).ok_or(SceneError::Meshes)?;
        let room = self.objects.len();
        let slot = self.objects.get_mut(self.count).ok_or(SceneError::Objects { room })?;
        *slot = object;
        slot.pose = pose;
        self.count += 1;
        self.rearrange();
        Ok(self.count - 1)
    }

    /// The number of vertices of all objects.
    pub(crate) fn vertices(&self) -> u32 {
        self.objects().iter().fold(0, |sum, object| sum + object.vertices)
    }

    /// Material `index`.
    pub(crate) fn material(&self, index: usize) -> Option<&Material> {
        self.materials.get(index).map(|slot| &slot.material)
    }

    fn rearrange(&mut self) {
        self.rearranged = true;
        self.exchange_materials();
        self.set_view_changed();
    }

    /// Meshes with colours at their corners may have other materials, whose tables depend on it.
    fn exchange_materials(&mut self) {
        if self.has_colours() {
            self.set_stale();
        }
    }

    /// Whether a mesh has colours at its corners, or a texture.
    fn has_colours(&self) -> bool {
        VERTEX_COLOURS && !(self.stream.corner_colours.is_empty() && self.stream.header.textures == 0)
    }

    /// Whether a mesh with colours at its corners, or with a texture, has the material with this index.
    pub(crate) fn is_coloured(&self, material: usize) -> bool {
        let meshes = |object: &Object| self.stream.meshes.get(usize::from(object.meshes().start)..usize::from(object.meshes().end));
        let is_coloured = |object: &Object, mesh: &Mesh| mesh.is_coloured() && object.material_of(mesh) == material;
        self.has_colours()
            && self.objects().iter().any(|object| meshes(object).unwrap_or_default().iter().any(|mesh| is_coloured(object, mesh)))
    }

    /// Object `index`.
    fn object(&mut self, index: usize) -> Result<&mut Object, SceneError> {
        self.objects.get_mut(..self.count).and_then(|objects| objects.get_mut(index)).ok_or(SceneError::Object { index })
    }

    /// Sets the rotation, position and scale of the object with the index `index`.
    ///
    /// # Errors
    /// Returns [`SceneError::Object`] if there is no object with this index.
    pub fn set_pose(&mut self, index: usize, pose: Pose) -> Result<(), SceneError> {
        let object = self.object(index)?;
        object.place(pose, object.hidden != 0);
        Ok(())
    }

    /// Shows the object with the index `index` if `visible` is `true`, and hides it otherwise.
    ///
    /// # Errors
    /// Returns [`SceneError::Object`] if there is no object with this index.
    pub fn set_visible(&mut self, index: usize, visible: bool) -> Result<(), SceneError> {
        let object = self.object(index)?;
        object.place(object.pose, !visible);
        Ok(())
    }

    /// Sets the material of the object with the index `index`. `material` is the index of the material that all its meshes get, or `None`
    /// so that each mesh has its own material.
    ///
    /// # Errors
    /// Returns [`SceneError::Object`] or [`SceneError::Material`] if there is no object or material with this index.
    pub fn set_object_material(&mut self, index: usize, material: Option<u16>) -> Result<(), SceneError> {
        let material = material.unwrap_or(OWN_MATERIALS);
        if material != OWN_MATERIALS && usize::from(material) >= self.materials.len() {
            return Err(SceneError::Material { index: material.into() });
        }
        self.object(index)?.material = material;
        self.exchange_materials();
        self.repainted = true;
        Ok(())
    }

    /// Returns the materials in the order of their indices. They come from the stream (mesh file) until [`Self::set_material`] changes one.
    pub fn materials(&self) -> impl ExactSizeIterator<Item = &Material> {
        self.materials.iter().map(|slot| &slot.material)
    }

    /// Replaces the material with the index `index`. The next frame takes longer, because it computes the colour tables of this material
    /// again.
    ///
    /// # Errors
    /// Returns [`SceneError::Material`] if there is no material with this index, [`SceneError::Range`] if a value is out of range, and
    /// [`SceneError::Exponent`] if the exponent is too small for the shading method.
    ///
    /// Returns [`SceneError::Feature`] if the change needs a cargo feature of this crate that is turned off.
    pub fn set_material(&mut self, index: usize, material: Material) -> Result<(), SceneError> {
        in_range(material.fault())?;
        self.check_colours(self.ambient, &self.lights, [&material])?;
        let least = self.limits.least_exponent;
        if material.exponent < least {
            return Err(SceneError::Exponent { least });
        }
        *self.materials.get_mut(index).ok_or(SceneError::Material { index })? = SceneMaterial { material, is_stale: 1 };
        self.repainted = true;
        Ok(())
    }

    /// The materials whose tables are to be computed, with their indices.
    pub(crate) fn stale_materials(&self) -> impl Iterator<Item = (usize, Material)> {
        self.materials.iter().enumerate().filter(|(_, slot)| slot.is_stale != 0).map(|(index, slot)| (index, slot.material))
    }

    /// Marks the tables of all materials as computed.
    pub(crate) fn set_fresh(&mut self) {
        self.materials.iter_mut().for_each(|slot| slot.is_stale = 0);
    }

    /// Marks the tables of all materials as stale, so that the next frame computes them again.
    pub(crate) fn set_stale(&mut self) {
        self.materials.iter_mut().for_each(|slot| slot.is_stale = 1);
        self.repainted = true;
    }

    /// Returns the lights, each of which shines on all objects.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// Replaces all lights, of which there may be up to 8. If their number or their colours change, or if a light gets or loses a range or a
    /// cone, or becomes one of another kind, the next frame takes longer, because it computes the colour tables of all materials again.
    ///
    /// # Errors
    /// Returns [`SceneError::Range`] if there are more than [`MAX_LIGHTS`] or a value is out of range, and [`SceneError::Light`] if the
    /// shading method does not support a point light.
    ///
    /// Returns [`SceneError::Feature`] if the change needs a cargo feature of this crate that is turned off.
    pub fn set_lights(&mut self, lights: &[Light]) -> Result<(), SceneError> {
        lights.iter().try_for_each(|light| in_range(light.fault()))?;
        require(Feature::Lights, lights.len() > 1)?;
        require(Feature::NearLights, lights.iter().any(|light| light.kind == POINT))?;
        require(Feature::LightShapes, lights.iter().any(Light::has_shape))?;
        self.check_colours(self.ambient, lights, self.materials())?;
        if !self.limits.near_lights && lights.iter().any(|light| light.kind == POINT) {
            return Err(SceneError::Light);
        }
        let lights = heapless::Vec::from_slice(lights).map_err(|_| SceneError::Range { name: "number of lights" })?;
        // What the tables of materials depend on.
        let tabled = |light: &Light| (light.colour, light.kind, light.has_shape(), light.axis != [0; 3]);
        if !lights.iter().map(tabled).eq(self.lights.iter().map(tabled)) {
            self.set_stale();
        }
        self.lights = lights;
        self.set_view_changed();
        Ok(())
    }

    /// Sets the ambient light, which reaches every surface equally: red, green and blue, each 0 to 2, where 1 is full intensity. It is
    /// multiplied by a material's ambient colour. The next frame computes the colour tables of all materials again.
    ///
    /// # Errors
    /// Returns [`SceneError::Range`] if a value is more than 2.
    ///
    /// Returns [`SceneError::Feature`] if the change needs a cargo feature of this crate that is turned off.
    pub fn set_ambient(&mut self, ambient: [Gain; 3]) -> Result<(), SceneError> {
        let ambient = ambient.map(Gain::to_bits);
        in_range((!is_gain(ambient)).then_some("ambient light"))?;
        self.check_colours(ambient, &self.lights, self.materials())?;
        self.ambient = ambient;
        self.set_stale();
        Ok(())
    }

    /// Returns the background, which is visible where no triangle is drawn.
    #[must_use]
    pub fn background(&self) -> Background {
        self.background
    }

    /// Sets the background: one colour as `[red, green, blue]`, each 0 to 255, or a [`Background::Gradient`].
    pub fn set_background(&mut self, background: impl Into<Background>) {
        self.background = background.into();
        self.repainted = true;
    }

    /// Returns the lines along outlines, or `None` if there are none.
    #[must_use]
    pub fn outlines(&self) -> Option<Outlines> {
        self.outlines
    }

    /// Draws antialiased lines along outlines, or none. An outline is where a surface ends (silhouette), where its shading jumps (crease), or where
    /// two surfaces cut each other. The stream (mesh file) says which lines the scene has at first. In formats of one bit, of the two pixels that
    /// share a line the one that it covers more gets its colour. Lines take the place of [antialiasing](crate::Renderer::set_antialias).
    ///
    /// # Errors
    /// The scene keeps the lines that it has.
    ///
    /// - Returns [`SceneError::Feature`] if this crate is built without the feature `antialias`.
    /// - Returns [`SceneError::AntialiasMemory`] if the memory has no room for them ([`Layout::antialias`](crate::Layout::antialias)).
    /// - Returns [`SceneError::Neighbours`] if the stream (mesh file) was written without `--antialias` and `--outlines`.
    pub fn set_outlines(&mut self, outlines: Option<Outlines>) -> Result<(), SceneError> {
        if outlines.is_some() {
            self.check_edges()?;
        }
        if self.outlines != outlines {
            self.outlines = outlines;
            self.set_view_changed();
        }
        Ok(())
    }

    /// Checks that edges can be found, to be smoothed or to be drawn as lines.
    pub(crate) fn check_edges(&self) -> Result<(), SceneError> {
        require(Feature::Antialias, true)?;
        if !self.has_edge_memory {
            return Err(SceneError::AntialiasMemory);
        }
        if self.stream.neighbours.is_empty() && !self.stream.triangles.is_empty() {
            return Err(SceneError::Neighbours);
        }
        Ok(())
    }

    /// Returns the camera. If it orbits, its rotation is the one in frame 0 of the orbit.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Replaces the camera, its projection and its orbit included. To move the camera only, use [`Self::look_at`].
    ///
    /// # Errors
    /// Returns [`SceneError::Range`] if a value is out of range, [`SceneError::Light`] if the shading method does not support a local
    /// viewer, and [`SceneError::Perspective`] if perspective-correct interpolation of light is on and the method does not support it for a
    /// perspective camera.
    ///
    /// Returns [`SceneError::Feature`] if the change needs a cargo feature of this crate that is turned off.
    pub fn set_camera(&mut self, camera: Camera) -> Result<(), SceneError> {
        in_range(camera.fault())?;
        require(Feature::NearLights, camera.has_local_viewer())?;
        if !self.limits.near_lights && camera.has_local_viewer() {
            return Err(SceneError::Light);
        }
        if !self.limits.perspective && camera.projection == PERSPECTIVE {
            return Err(SceneError::Perspective);
        }
        if self.camera != camera {
            if NEAR_LIGHTS && self.camera.has_local_viewer() != camera.has_local_viewer() {
                self.set_stale();
            }
            self.camera = camera;
            self.place = self.place_of(self.place);
            self.set_view_changed();
        }
        Ok(())
    }

    /// Moves the camera to the position `eye` and turns it so that it looks at `target`, with the direction `up` upwards in the picture.
    /// All are in world units, and positions lie within 16 units of the origin along each axis. An orbit of the camera ends, and the focal
    /// length stays.
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if `eye` equals `target`, or `up` is zero or parallel to the viewing direction. Returns
    /// [`SceneError::Position`] or [`SceneError::Range`] if the camera is too far from the origin.
    pub fn look_at(&mut self, eye: [Length; 3], target: [Length; 3], up: [Length; 3]) -> Result<(), SceneError> {
        self.set_camera_pose(&Pose::looking_at(eye, target, up)?)
    }

    /// Moves the camera to the position and rotation of `pose`. The camera looks along the positive z axis of the pose, and the y axis
    /// points upwards in the picture; the scale is ignored. An orbit of the camera ends, and the focal length stays.
    ///
    /// # Errors
    /// Returns [`SceneError::Range`] if the camera is farther than 16 units from the origin of the world along one of the camera's own
    /// axes.
    pub fn set_camera_pose(&mut self, pose: &Pose) -> Result<(), SceneError> {
        let one = 1 << ROTATION;
        let [x, y, z] = pose.matrix().map(|row| row.map(|c| c.clamp(-one, one)));
        // Eye space is left-handed: x of the pose is to the left.
        let rotation = [[-x[0], -y[0], -z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]];
        let eye = pose.position().map(Length::to_bits);
        let translation = rotation.map(|row| -((dot(row, eye) + (1 << (ROTATION - 1))) >> ROTATION) as i32);
        self.set_camera(Camera { rotation, translation, period: 0, ..self.camera })
    }

    /// Checks that these materials have one channel, unless the program has the feature for more.
    fn check_colours<'m>(
        &self,
        ambient: [u16; 3],
        lights: &[Light],
        materials: impl IntoIterator<Item = &'m Material>,
    ) -> Result<(), SceneError> {
        let needs = |material| !LightTerms::new(&self.channels, ambient, material, lights).are_one_channel;
        require(Feature::Colours, !COLOURS && materials.into_iter().any(needs))
    }
}

/// Checks that the program has a `feature` if a change `needs` it.
fn require(feature: Feature, needs: bool) -> Result<(), SceneError> {
    if needs && !feature.is_on() { Err(SceneError::Feature { name: feature.name() }) } else { Ok(()) }
}

fn in_range(fault: Option<&'static str>) -> Result<(), SceneError> {
    fault.map_or(Ok(()), |name| Err(SceneError::Range { name }))
}
