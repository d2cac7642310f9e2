//! A change of a scene. It is made of random numbers, applied to a renderer, and recorded in the expected state of the scene.

use crate::{random::Random, scenes::colour};
use microphong::{
    Layout, Outlines, Pose, RenderError, Renderer, Scene, SceneError, Stream,
    format::{Angle, ErrorBudget, Gain, LARGEST_BUDGET, LEAST_BUDGET, Length, MAX_LIGHTS, Rotation, Scale, Unit},
    pixel::{Pixel, gamma},
    scene::{Background, MAX_POSITION, MAX_SCALE, MIN_SCALE},
    stream::{
        MAX_EXPONENT, MAX_FOCAL, MAX_GAIN, MAX_LENGTH, MIN_FOCAL, MIN_NEAR, MIN_RANGE,
        record::{Camera, DIRECTIONAL, EYE_SPACE, Light, Material, ORTHOGRAPHIC, PERSPECTIVE, POINT, SKY, VIEWER_LOCAL},
    },
};
use microphong_models::{number::nearest, vector::length};
use microphong_render::{render::Style, shader::Shader};
use std::ops::Range;

/// An object of a scene.
#[derive(Clone, Debug)]
pub struct Placed {
    meshes: Range<u16>,
    pose: Pose,
    visible: bool,
    material: Option<u16>,
}

/// The expected state of a scene, kept beside the renderer by separate code.
#[derive(Clone, Debug)]
pub struct State {
    /// Whether tracks of the stream move objects, lights and camera, in place of changes.
    scripted: bool,
    objects: Vec<Placed>,
    materials: Vec<Material>,
    lights: Vec<Light>,
    ambient: [Gain; 3],
    background: Background,
    camera: Camera,
    /// The pose to which the camera was moved; its lens stays.
    eye: Option<Pose>,
    /// The frame of the orbit or of the tracks.
    frame: u32,
    /// The style of drawing.
    pub style: Style,
    budget: Option<ErrorBudget>,
    levels_of_detail: bool,
}

impl State {
    /// The state at the beginning: that of a stream.
    #[must_use]
    pub fn new(stream: &Stream<'_>, style: Style) -> Self {
        let whole = Placed { meshes: 0..stream.meshes.len() as u16, pose: Pose::IDENTITY, visible: true, material: None };
        let instances = stream.instances.iter();
        let objects: Vec<_> = instances.map(|i| Placed { meshes: i.first_mesh..i.first_mesh + i.meshes, ..whole.clone() }).collect();
        Self {
            scripted: !stream.tracks.is_empty(),
            objects: if objects.is_empty() { vec![whole] } else { objects },
            materials: stream.materials.to_vec(),
            lights: stream.lights.to_vec(),
            ambient: stream.header.ambient(),
            background: stream.header.background.into(),
            camera: stream.header.camera,
            eye: None,
            frame: 0,
            style,
            budget: stream.header.budget(),
            levels_of_detail: true,
        }
    }

    /// Whether tracks of the stream move something.
    #[must_use]
    pub fn is_scripted(&self) -> bool {
        self.scripted
    }

    /// The number by which [`Renderer::frame`] draws this scene.
    #[must_use]
    pub fn frame(&self) -> u32 {
        self.frame
    }

    /// Room for all of it.
    #[must_use]
    pub fn room(&self, layout: Layout, stream: &Stream<'_>) -> Layout {
        let meshes = || self.objects.iter().flat_map(|object| &stream.meshes[usize::from(object.meshes.start)..object.meshes.end.into()]);
        layout
            .vertices(meshes().map(|mesh| usize::from(mesh.vertices)).sum())
            .triangles(meshes().map(|mesh| mesh.triangles as usize).sum())
            .materials(stream.materials.len())
            .objects(self.objects.len().max(stream.instances.len()).max(1))
            .antialias(self.style.has_edges())
    }

    /// Makes a renderer with the scene of its stream draw this state.
    ///
    /// # Errors
    /// The renderer's refusal.
    pub fn set<C: Pixel>(&self, renderer: &mut Renderer<'_, C>) -> Result<(), String> {
        self.set_scene(renderer.scene()).map_err(|error| error.to_string())?;
        self.set_style(renderer).map_err(|error| error.to_string())
    }

    fn set_scene(&self, scene: &mut Scene<'_>) -> Result<(), SceneError> {
        if !self.scripted {
            scene.clear();
            for object in &self.objects {
                let index = scene.add(object.meshes.clone(), object.pose)?;
                scene.set_visible(index, object.visible)?;
            }
            scene.set_lights(&self.lights)?;
            scene.set_camera(self.camera)?;
            self.eye.iter().try_for_each(|eye| scene.set_camera_pose(eye))?;
        }
        for (index, object) in self.objects.iter().enumerate() {
            scene.set_object_material(index, object.material)?;
        }
        for (index, &material) in self.materials.iter().enumerate() {
            scene.set_material(index, material)?;
        }
        scene.set_ambient(self.ambient)?;
        scene.set_background(self.background);
        scene.set_outlines(self.style.outlines)?;
        scene.play(self.frame);
        Ok(())
    }

    fn set_style<C: Pixel>(&self, renderer: &mut Renderer<'_, C>) -> Result<(), RenderError> {
        let Style { shader, perspective_correct, antialias, dither, srgb, skips, .. } = self.style;
        renderer.set_dither(dither);
        renderer.set_gamma(srgb.then_some(&gamma::SRGB));
        renderer.set_skips(skips);
        renderer.set_levels_of_detail(self.levels_of_detail);
        renderer.set_shader(shader.on())?;
        renderer.set_perspective_correct(perspective_correct)?;
        renderer.set_antialias(antialias)?;
        self.budget.map_or(Ok(()), |budget| renderer.set_budget(budget))
    }

    /// Whether the viewer may be as near as this camera says, and lights near.
    fn takes_near(&self) -> bool {
        self.style.shader.facts().near_lights
    }
}

/// A change that a program may ask for, valid or not.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each is a function of the scene or the renderer")]
pub enum Change {
    Pose(usize, Pose),
    Visible(usize, bool),
    ObjectMaterial(usize, Option<u16>),
    Material(usize, Material),
    Lights(Vec<Light>),
    Ambient([Gain; 3]),
    Background(Background),
    Outlines(Option<Outlines>),
    Camera(Camera),
    Eye(Pose),
    Clear,
    Add(Range<u16>, Pose),
    Play(u32),
    Shader(Shader),
    PerspectiveCorrect(bool),
    Antialias(bool),
    Dither(bool),
    Gamma(bool),
    Budget(ErrorBudget),
    LevelsOfDetail(bool),
}

impl Change {
    /// Objects of random meshes, at most `most`, instead of all others.
    ///
    /// # Errors
    /// Errors of [`pose`].
    pub fn arrangement(random: &mut Random, most: usize, stream: &Stream<'_>) -> Result<Vec<Self>, String> {
        let mut changes = vec![Self::Clear];
        for _ in 0..random.pick(1..most as i32 + 1) {
            let first = random.pick(0..stream.meshes.len() as i32);
            let meshes = random.pick(1..stream.meshes.len() as i32 - first + 1);
            changes.push(Self::Add(first as u16..(first + meshes) as u16, pose(random)?));
        }
        Ok(changes)
    }

    /// A random change of the scene `now`, of a `calm` one only of where its objects are; now and then one that must be refused.
    ///
    /// # Errors
    /// When a pose is taken that is out of range, or one refused that is not.
    pub fn new(random: &mut Random, calm: bool, now: &State, stream: &Stream<'_>) -> Result<Self, String> {
        let past = i32::from(random.once_in(16));
        let object = random.pick(0..now.objects.len() as i32 + past) as usize;
        let material = random.pick(0..now.materials.len() as i32 + past);
        let kinds = match (now.scripted, calm) {
            (true, true) => 24..33,
            (true, false) => 12..33,
            (false, true) => 0..8,
            (false, false) => 0..33,
        };
        Ok(match random.pick(kinds) {
            0..6 => Self::Pose(object, pose(random)?),
            6 => Self::Pose(object, now.objects.get(object).map_or(Pose::IDENTITY, |object| object.pose.turned(&object.pose))),
            7 => Self::Visible(object, random.once_in(2)),
            8 => Self::Lights(lights(random, now)),
            9 => Self::Camera(camera(random, now)),
            10 => Self::Eye(eye(random)?),
            11 => {
                if random.once_in(3) {
                    Self::Clear
                } else {
                    let first = random.pick(0..stream.meshes.len() as i32 + past);
                    let meshes = random.pick(1 - past..3 + past);
                    Self::Add(first as u16..(first + meshes) as u16, pose(random)?)
                }
            }
            12 | 13 => Self::ObjectMaterial(object, (!random.once_in(3)).then_some(material as u16)),
            14 => Self::Material(material as usize, shared(random)),
            15 => Self::Ambient([(); 3].map(|()| gain(random))),
            16 => {
                let mut colour = || [(); 3].map(|()| random.bits() as u8);
                let (top, bottom) = (colour(), colour());
                Self::Background(if random.once_in(2) { top.into() } else { Background::Gradient { top, bottom } })
            }
            17 => Self::Shader(random.among(&Shader::ALL)),
            18 => Self::PerspectiveCorrect(random.once_in(2)),
            19 => match random.pick(0..4) {
                0 => Self::Outlines(None),
                1 => Self::Outlines(Some(Outlines::new([random.bits() as u8, 128, 255]).alone(random.once_in(2)))),
                on => Self::Antialias(on == 2),
            },
            20 => Self::Dither(random.once_in(2)),
            21 => Self::Budget(ErrorBudget::from_bits(random.bits() as u8 >> random.pick(0..7))),
            22 => Self::LevelsOfDetail(random.once_in(2)),
            23 => Self::Gamma(random.once_in(2)),
            _ if now.scripted || random.once_in(4) => Self::Play(match random.pick(0..4) {
                0 => random.bits() as u32,
                1 => now.frame,
                _ => now.frame.wrapping_add(random.pick(-1..8) as u32),
            }),
            _ => Self::Visible(object, !random.once_in(4)),
        })
    }

    /// Asks a renderer for it.
    ///
    /// # Errors
    /// When the renderer refuses it.
    pub fn tell<C: Pixel>(&self, renderer: &mut Renderer<'_, C>) -> Result<(), String> {
        let of_style = |error: RenderError| error.to_string();
        match self {
            Self::Shader(shader) => return renderer.set_shader(shader.on()).map_err(of_style),
            Self::PerspectiveCorrect(on) => return renderer.set_perspective_correct(*on).map_err(of_style),
            Self::Antialias(on) => return renderer.set_antialias(*on).map_err(of_style),
            Self::Budget(budget) => return renderer.set_budget(*budget).map_err(of_style),
            Self::Dither(on) => renderer.set_dither(*on),
            Self::Gamma(on) => renderer.set_gamma(on.then_some(&gamma::SRGB)),
            Self::LevelsOfDetail(on) => renderer.set_levels_of_detail(*on),
            _ => {}
        }
        let scene = renderer.scene();
        let told = match self {
            Self::Pose(object, pose) => scene.set_pose(*object, *pose),
            Self::Visible(object, visible) => scene.set_visible(*object, *visible),
            Self::ObjectMaterial(object, material) => scene.set_object_material(*object, *material),
            Self::Material(index, material) => scene.set_material(*index, *material),
            Self::Lights(lights) => scene.set_lights(lights),
            Self::Ambient(ambient) => scene.set_ambient(*ambient),
            Self::Outlines(outlines) => scene.set_outlines(*outlines),
            Self::Camera(camera) => scene.set_camera(*camera),
            Self::Eye(pose) => scene.set_camera_pose(pose),
            Self::Add(meshes, pose) => scene.add(meshes.clone(), *pose).map(|_| ()),
            Self::Background(background) => {
                scene.set_background(*background);
                Ok(())
            }
            Self::Clear => {
                scene.clear();
                Ok(())
            }
            Self::Play(number) => {
                scene.play(*number);
                Ok(())
            }
            _ => Ok(()),
        };
        told.map_err(|error| error.to_string())
    }

    /// Whether a renderer of this layout has to take it; `None` where that is for the shading method to say.
    #[must_use]
    pub fn is_right(&self, now: &State, stream: &Stream<'_>, layout: &Layout) -> Option<bool> {
        let is_gain = |colour: [u16; 3]| colour.iter().all(|&c| c <= MAX_GAIN);
        let starts = |mesh: u16| stream.meshes.get(usize::from(mesh)).is_none_or(|mesh| mesh.error == 0);
        Some(match self {
            Self::Pose(object, _) | Self::Visible(object, _) => *object < now.objects.len(),
            Self::ObjectMaterial(object, material) => {
                *object < now.objects.len() && material.is_none_or(|material| usize::from(material) < now.materials.len())
            }
            Self::Material(index, Material { ambient, diffuse, specular, exponent }) => {
                *index < now.materials.len()
                    && (now.style.shader.facts().highlight.least_exponent()..=MAX_EXPONENT).contains(exponent)
                    && [*ambient, *diffuse, *specular].into_iter().all(is_gain)
            }
            Self::Lights(lights) => {
                let directional = |light: &Light| {
                    let length = length(light.vector.map(|c| f64::from(Length::from_bits(c))));
                    light.kind != POINT && light.kind <= SKY && (length * length - 1.0).abs() <= 1.0 / 256.0
                };
                let is_shaped_rightly = |light: &Light| {
                    let [edge, full] = light.cone;
                    let length = length(light.axis.map(|c| f64::from(Unit::from_bits(c))));
                    let is_cone = (length * length - 1.0).abs() <= 1.0 / 256.0 && (-16_384..full).contains(&edge) && full <= 16_384;
                    let in_range = light.range == 0 || light.range >= MIN_RANGE;
                    let is_even = light.axis == [0; 3] && light.cone == [0; 2];
                    in_range && (is_even || is_cone) && (light.kind == POINT || light.range == 0 && is_even)
                };
                let is_right = |light: &Light| {
                    light.space <= EYE_SPACE
                        && is_gain(light.colour)
                        && light.vector.iter().all(|c| c.abs() <= MAX_LENGTH)
                        && is_shaped_rightly(light)
                        && (directional(light) || light.kind == POINT && now.takes_near())
                };
                lights.len() <= MAX_LIGHTS && lights.iter().all(is_right)
            }
            Self::Ambient(ambient) => is_gain(ambient.map(Gain::to_bits)),
            Self::Camera(camera) => {
                (MIN_FOCAL..=MAX_FOCAL).contains(&camera.focal)
                    && (MIN_NEAR..MAX_LENGTH).contains(&camera.near)
                    && camera.translation.iter().all(|c| c.abs() <= MAX_LENGTH)
                    && (camera.projection == PERSPECTIVE || camera.near < camera.far && camera.far <= 2 * MAX_LENGTH)
                    && camera.projection <= ORTHOGRAPHIC
                    && (camera.viewer != VIEWER_LOCAL || camera.projection != PERSPECTIVE || now.takes_near())
                    && (camera.projection != PERSPECTIVE || !now.style.perspective_correct || now.style.shader.facts().perspective)
            }
            // Along the axes of the camera it may be farther away than along those of the world.
            Self::Eye(pose) => {
                let away = length(pose.position().map(f64::from));
                return (away < 15.9).then_some(true).or_else(|| (away > 27.8).then_some(false));
            }
            Self::Add(meshes, _) => {
                now.objects.len() < layout.objects
                    && !meshes.is_empty()
                    && usize::from(meshes.end) <= stream.meshes.len()
                    && starts(meshes.start)
                    && starts(meshes.end)
            }
            Self::Antialias(on) => !on || layout.antialias,
            Self::Outlines(outlines) => outlines.is_none() || layout.antialias,
            Self::Budget(budget) => (LEAST_BUDGET..=LARGEST_BUDGET).contains(budget),
            Self::Shader(_) | Self::PerspectiveCorrect(true) => return None,
            Self::Background(_)
            | Self::Clear
            | Self::Play(_)
            | Self::PerspectiveCorrect(false)
            | Self::Dither(_)
            | Self::Gamma(_)
            | Self::LevelsOfDetail(_) => true,
        })
    }

    /// Records the change in the state.
    pub fn keep(self, state: &mut State) {
        match self {
            Self::Pose(object, pose) => state.objects[object].pose = pose,
            Self::Visible(object, visible) => state.objects[object].visible = visible,
            Self::ObjectMaterial(object, material) => state.objects[object].material = material,
            Self::Material(index, material) => state.materials[index] = material,
            Self::Lights(lights) => state.lights = lights,
            Self::Ambient(ambient) => state.ambient = ambient,
            Self::Background(background) => state.background = background,
            Self::Outlines(outlines) => state.style.outlines = outlines,
            Self::Camera(camera) => {
                (state.camera, state.eye) = (camera, None);
                state.frame = state.frame.checked_rem(camera.period.into()).unwrap_or(0);
            }
            Self::Eye(pose) => (state.eye, state.frame) = (Some(pose), 0),
            Self::Clear => state.objects.clear(),
            Self::Add(meshes, pose) => state.objects.push(Placed { meshes, pose, visible: true, material: None }),
            Self::Play(number) if state.scripted => state.frame = number,
            Self::Play(number) => {
                let period = if state.eye.is_some() { 0 } else { state.camera.period };
                state.frame = number.checked_rem(period.into()).unwrap_or(0);
            }
            Self::Shader(shader) => state.style.shader = shader,
            Self::PerspectiveCorrect(on) => state.style.perspective_correct = on,
            Self::Antialias(on) => state.style.antialias = on,
            Self::Dither(on) => state.style.dither = on,
            Self::Gamma(on) => state.style.srgb = on,
            Self::Budget(budget) => state.budget = Some(budget),
            Self::LevelsOfDetail(on) => state.levels_of_detail = on,
        }
    }
}

/// A pose. Most are partly seen by a camera near the origin, and some are at the limits. Values out of range have to be refused.
///
/// # Errors
/// When a value out of range is accepted, or a valid one refused.
pub fn pose(random: &mut Random) -> Result<Pose, String> {
    let judged = |what: &str, right: bool, pose: Result<Pose, SceneError>| match (right, pose) {
        (true, Err(error)) => Err(format!("{what} is refused: {error}")),
        (false, Ok(pose)) => Err(format!("{what} is taken: {pose:?}")),
        (_, pose) => Ok(pose.ok()),
    };
    let extreme = |random: &mut Random| random.among(&[0, 0, 1, -1, i32::MAX, i32::MIN, 1 << 30, -(1 << 30), 3 << 29]);
    let any = |random: &mut Random| if random.once_in(4) { extreme(random) } else { random.bits() as i32 };
    let rotation = match random.pick(0..4) {
        0 => {
            let quaternion = [(); 4].map(|()| any(random));
            let found = Pose::from_quaternion(quaternion.map(Rotation::from_bits));
            judged(&format!("quaternion {quaternion:?}"), quaternion != [0; 4], found)?
        }
        1 => {
            let (axis, angle) = ([(); 3].map(|()| any(random)), Angle::from_bits(any(random) as u32));
            judged(&format!("axis {axis:?}"), axis != [0; 3], Pose::about(axis, angle))?
        }
        2 => {
            let [yaw, pitch, roll] = [(); 3].map(|()| Angle::from_bits(any(random) as u32));
            Some(Pose::from_euler(yaw, pitch, roll))
        }
        _ => None,
    };
    let pose = rotation.unwrap_or(Pose::IDENTITY);
    let position = if random.once_in(8) {
        let limits = [MAX_POSITION, -MAX_POSITION, MAX_POSITION + Length::DELTA, -MAX_POSITION - Length::DELTA, Length::ZERO, Length::MIN];
        [(); 3].map(|()| random.among(&limits))
    } else {
        let reach = random.octaves(0.05, 4.0);
        random.direction().map(|c| nearest(c * reach))
    };
    let within = position.iter().all(|c| (-MAX_POSITION..=MAX_POSITION).contains(c));
    let pose = judged(&format!("position {position:?}"), within, pose.at(position))?.unwrap_or(pose);
    let scale = match random.pick(0..8) {
        0 => random.among(&[MIN_SCALE, MAX_SCALE, MIN_SCALE - Scale::DELTA, MAX_SCALE + Scale::DELTA, Scale::ZERO, Scale::MAX]),
        1..4 => Scale::ONE,
        _ => nearest(random.octaves(0.1, 2.0)),
    };
    let within = (MIN_SCALE..=MAX_SCALE).contains(&scale);
    Ok(judged(&format!("scale {scale}"), within, pose.scaled(scale))?.unwrap_or(pose))
}

/// A pose of a camera, mostly outside of the objects.
///
/// # Errors
/// Errors of [`pose`].
pub fn eye(random: &mut Random) -> Result<Pose, String> {
    let away = random.octaves(0.5, 8.0);
    let from = random.direction().map(|c| nearest::<Length>(c * away));
    let target = random.direction().map(|c| nearest::<Length>(c * 0.3));
    match Pose::looking_at(from, target, random.direction().map(nearest)) {
        Ok(pose) if !random.once_in(4) => Ok(pose),
        _ => pose(random),
    }
}

/// A colour that is sometimes out of range by a little.
fn gain(random: &mut Random) -> Gain {
    if random.once_in(32) { Gain::from_bits(MAX_GAIN + random.pick(0..2) as u16) } else { nearest(random.between(0.0, 1.2)) }
}

fn shared(random: &mut Random) -> Material {
    let mut colours = || [(); 3].map(|()| gain(random));
    let (ambient, diffuse, specular) = (colours(), colours(), colours());
    // A grey one now and then, which takes a loop of its own.
    let grey = random.once_in(3);
    let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(|colour| if grey { [colour[0]; 3] } else { colour });
    let exponent = if random.once_in(4) { random.among(&[0, 1, 2, 3, 4, 8, 1024, 1025]) } else { random.octaves(1.0, 1024.0) as u16 };
    Material::new(ambient, diffuse, specular, exponent)
}

/// Other lights, or these lights at other places.
fn lights(random: &mut Random, now: &State) -> Vec<Light> {
    let mut lights = now.lights.clone();
    if random.once_in(2) {
        let count = if random.once_in(16) { 9 } else { random.pick(0..5) };
        lights =
            (0..count).map(|_| Light::new(DIRECTIONAL, EYE_SPACE, [0, 0, -1].map(Length::from_num), colour(random).map(nearest))).collect();
    }
    for light in &mut lights {
        // Of one kind with another vector, which is mostly not in range then.
        let wrong = random.once_in(64);
        light.kind = if random.once_in(3) { POINT } else { DIRECTIONAL };
        light.space = random.pick(0..2) as u8;
        let reach = if (light.kind == POINT) != wrong { random.octaves(0.05, 15.0) } else { 1.0 };
        light.vector = random.direction().map(|c| nearest::<Length>(c * reach).to_bits());
        (light.axis, light.range, light.cone) = ([0; 3], 0, [0; 2]);
        if random.once_in(4) {
            // A range, a cone, or light from the sky, which are not in range for some lights.
            match random.pick(0..3) {
                0 => light.range = random.pick(100..65_536) as u16,
                1 => {
                    light.axis = random.direction().map(|c| nearest::<Unit>(c).to_bits());
                    light.cone = [random.pick(-20_000..16_000), random.pick(-10_000..16_385)].map(|c| c as i16);
                }
                _ => light.kind = SKY,
            }
        }
    }
    lights
}

/// The camera with another lens, elsewhere.
fn camera(random: &mut Random, now: &State) -> Camera {
    let mut camera = now.camera;
    for _ in 0..random.pick(1..3) {
        match random.pick(0..7) {
            0 => camera.projection = random.among(&[PERSPECTIVE, ORTHOGRAPHIC]),
            1 => camera.viewer ^= 1,
            2 => camera.focal = random.octaves(0.05 * 65_536.0, 17.0 * 65_536.0) as u32,
            3 => camera.near = random.octaves(200.0, 20.0 * 16_384.0) as i32,
            4 => camera.far = random.octaves(8_192.0, 33.0 * 16_384.0) as i32,
            5 => camera.translation[random.pick(0..3) as usize] = (random.between(-1.02, 1.02) * f64::from(MAX_LENGTH)) as i32,
            _ => camera.period = random.among(&[0, 1, 7, 120]),
        }
    }
    camera
}
