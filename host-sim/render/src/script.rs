//! Scripted scenes: a text that says which objects there are, how they look, and how they, lights and camera move from frame to frame.
//!
//! The text is TOML. What it says becomes a stream: host and boards play that, and nothing else.

use crate::{
    bytes::StreamBytes,
    import::{self, Imported, surfaces},
    look::{Cast, KEY, Lamp, Look, Member, Surface, Way},
    mesh::{CREASE, Mesh, Weld},
    number::nearest,
    quantise::{Part, quantise},
    shader::Shader,
    shapes,
    vector::{V3, add, cross, dot, scale, sub, unit},
    view::{Projection, View},
};
use anyhow::{Context, Result, bail, ensure};
use microphong::{
    format::{ErrorBudget, Length, MAX_LIGHTS, Rotation, Scale},
    scene::Background,
    stream::record::{CAMERA_TRACK, Key, LABEL_TEXT, LEAST_LINE, LEFT, LIGHT_TRACK, Label, MIDDLE, OBJECT_TRACK, RIGHT},
};
use serde::Deserialize;
use std::path::Path;

/// A scene as its text says.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Script {
    /// Frames of the animation.
    frames: u16,
    /// Width and height that suit it.
    #[serde(default = "square")]
    size: [u32; 2],
    background: Option<BackgroundScript>,
    /// Method unless another one is asked for.
    shader: Option<String>,
    /// How far a pixel may be off by `auto`.
    budget: Option<f64>,
    camera: Camera,
    #[serde(default)]
    light: Vec<Light>,
    mesh: Vec<MeshScript>,
    object: Vec<Object>,
    #[serde(default)]
    label: Vec<LabelScript>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a background is a colour, as \"203040\", or a gradient, as { top = \"203040\", bottom = \"000000\" }")]
enum BackgroundScript {
    /// RRGGBB.
    Colour(String),
    Gradient(Gradient),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Gradient {
    top: String,
    bottom: String,
}

/// A text over the picture. In pictures of another size it lies where the scene behind it does.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LabelScript {
    text: String,
    /// In a picture of the size of the script, pixels from its upper left corner.
    at: [f64; 2],
    /// Which part of the text is there: `left`, `middle` or `right`.
    #[serde(default)]
    align: Align,
    /// Height of a line in such a picture, pixels.
    #[serde(default = "line")]
    height: f64,
    colour: Option<String>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Align {
    Left,
    #[default]
    Middle,
    Right,
}

fn line() -> f64 {
    13.0
}

fn square() -> [u32; 2] {
    [240, 240]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Camera {
    at: V3,
    #[serde(default)]
    looks_at: V3,
    #[serde(default = "up")]
    up: V3,
    /// Degrees that the smaller side of the picture shows.
    #[serde(default = "view")]
    view: f64,
    #[serde(default = "near")]
    near: f64,
    #[serde(default)]
    keys: Vec<CameraKey>,
}

fn up() -> V3 {
    [0.0, 1.0, 0.0]
}

fn view() -> f64 {
    40.0
}

fn near() -> f64 {
    0.5
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct CameraKey {
    frame: u32,
    at: V3,
    #[serde(default)]
    looks_at: V3,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Light {
    /// Direction, of a light that is infinitely far.
    towards: Option<V3>,
    /// Position, of one that is near.
    at: Option<V3>,
    colour: Option<String>,
    #[serde(default)]
    keys: Vec<LightKey>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LightKey {
    frame: u32,
    towards: Option<V3>,
    at: Option<V3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct MeshScript {
    name: String,
    /// A file of a mesh, from the folder of the text on; it is centred and scaled to a sphere of radius 1.
    file: Option<String>,
    /// One of [`SHAPES`].
    shape: Option<String>,
    /// Half of the extent of a shape along each axis.
    size: Option<V3>,
    /// Radius of the tube of a torus, as a share of that of its ring.
    tube: Option<f64>,
    /// Where the middle of a shape lies; the object turns about the origin.
    #[serde(default)]
    centre: V3,
    colour: Option<String>,
    /// Whether the highlight is white.
    #[serde(default)]
    plastic: bool,
    exponent: Option<u16>,
    crease: Option<f64>,
}

/// Shapes that need no file.
const SHAPES: &str = "box, cylinder, sphere or torus";

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Object {
    mesh: String,
    #[serde(flatten)]
    pose: Pose,
    #[serde(default)]
    keys: Vec<ObjectKey>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectKey {
    frame: u32,
    #[serde(flatten)]
    pose: Pose,
}

/// How an object lies. At most one way to say a rotation is used.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Pose {
    #[serde(default)]
    at: V3,
    /// An axis, and the angle about it in degrees.
    axis: Option<V3>,
    angle: Option<f64>,
    /// About y, then x, then z of the object, in degrees.
    euler: Option<V3>,
    /// w, x, y, z.
    quaternion: Option<[f64; 4]>,
    scale: Option<f64>,
    #[serde(default)]
    hidden: bool,
}

/// Reads a scripted scene; meshes are looked for in `folder`. Returns the stream and the size that suits it.
///
/// # Errors
/// Says the place in the text, or the object, and what is wrong with it.
pub fn stream(text: &str, folder: &Path) -> Result<(StreamBytes, (u32, u32))> {
    let script: Script = toml::from_str(text).map_err(|error| anyhow::anyhow!("{}", error.to_string().trim_end()))?;
    ensure!(script.frames > 0, "frames: there must be one at least");
    ensure!(!script.object.is_empty(), "the scene has no [[object]]");
    ensure!(script.light.len() <= MAX_LIGHTS, "the scene has {} lights; there may be {MAX_LIGHTS}", script.light.len());
    let (parts, surfaces, ranges) = meshes(&script.mesh, folder)?;
    let mut look = Look { surfaces, ..Look::new(surface(&script.mesh[0])?, eye(&script.camera)?) };
    look.frames = script.frames;
    if let Some(background) = &script.background {
        look.background = match background {
            BackgroundScript::Colour(text) => Background::Colour(bytes(text).context("background")?),
            BackgroundScript::Gradient(Gradient { top, bottom }) => {
                Background::Gradient { top: bytes(top).context("background: top")?, bottom: bytes(bottom).context("background: bottom")? }
            }
        };
    }
    if let Some(name) = &script.shader {
        look.shader = Shader::ALL
            .into_iter()
            .find(|shader| shader.name() == name.as_str())
            .with_context(|| format!("shader: there is no method {name:?}"))?;
    }
    if let Some(budget) = script.budget {
        look.budget = nearest::<ErrorBudget>(budget);
    }
    look.lamps =
        script.light.iter().enumerate().map(|(i, light)| lamp(light).with_context(|| format!("light {}", i + 1))).collect::<Result<_>>()?;
    if script.light.is_empty() {
        look.lamps = vec![Lamp::Fixed(KEY.map(|c| -c), [1.0; 3])];
    }
    look.cast = cast(&script, &ranges)?;
    let label = |(i, text): (usize, &LabelScript)| label(text, script.size).with_context(|| format!("label {}, {:?}", i + 1, text.text));
    look.labels = script.label.iter().enumerate().map(label).collect::<Result<_>>()?;
    let stream = look.stream(&parts)?;
    let [width, height] = script.size;
    Ok((stream, (width, height)))
}

/// The parts and materials of all meshes, and which parts each mesh has.
type Meshes = (Vec<Part>, Vec<Surface>, Vec<(String, u16, u16)>);

fn meshes(scripts: &[MeshScript], folder: &Path) -> Result<Meshes> {
    let (mut parts, mut materials, mut ranges) = (Vec::new(), Vec::new(), Vec::<(String, u16, u16)>::new());
    ensure!(!scripts.is_empty(), "the scene has no [[mesh]]");
    for script in scripts {
        let place = || format!("mesh {:?}", script.name);
        let (mut mesh, own) = mesh(script, folder).with_context(place)?;
        if script.colour.is_some() {
            mesh.materials.clear();
        }
        let own = if script.colour.is_some() { vec![None] } else { own };
        let first = parts.len();
        for mut part in quantise(&mesh).0 {
            part.material += materials.len() as u16;
            parts.push(part);
        }
        materials.extend(surfaces(&own, &surface(script).with_context(place)?, AMBIENT));
        ensure!(!ranges.iter().any(|(name, ..)| *name == script.name), "there are two meshes of the name {:?}", script.name);
        ranges.push((script.name.clone(), first as u16, (parts.len() - first) as u16));
    }
    Ok((parts, materials, ranges))
}

/// Share of light that is everywhere.
const AMBIENT: f64 = 0.12;

fn surface(script: &MeshScript) -> Result<Surface> {
    let colour = script.colour.as_deref().map_or(Ok([0.8; 3]), colour)?;
    let exponent = script.exponent.unwrap_or(30);
    Ok(if script.plastic {
        Surface::plastic(colour, [AMBIENT, 0.75, 0.35], exponent)
    } else {
        Surface::metal(colour, [AMBIENT, 0.6, 0.4], exponent)
    })
}

fn mesh(script: &MeshScript, folder: &Path) -> Result<(Mesh, Vec<Option<crate::mtl::Material>>)> {
    let (mut mesh, materials) = match (&script.file, script.shape.as_deref()) {
        (Some(file), None) => {
            let weld = Weld { crease: script.crease.unwrap_or(CREASE), ..Weld::default() };
            let Imported { mesh, materials, .. } = import::file(&folder.join(file), weld)?;
            (mesh, materials)
        }
        (None, Some(shape)) => {
            let mesh = match shape {
                "box" => shapes::cuboid(),
                "cylinder" => shapes::cylinder(32),
                "sphere" => shapes::sphere(18, 11, 0.0),
                "torus" => {
                    let tube = script.tube.unwrap_or(shapes::TUBE);
                    ensure!(tube > 0.0 && tube < 1.0, "tube: it must be more than 0 and less than 1");
                    shapes::ring(28, 10, tube)
                }
                other => bail!("there is no shape {other:?}; take {SHAPES}"),
            };
            (mesh, vec![None])
        }
        _ => bail!("say either the file of the mesh, or as its shape {SHAPES}"),
    };
    if let Some(size) = script.size {
        ensure!(size.iter().all(|c| *c > 0.0), "size: each extent must be more than 0");
        mesh = shapes::stretched(mesh, size);
    }
    mesh.positions.iter_mut().for_each(|position| *position = add(*position, script.centre));
    let farthest = mesh.positions.iter().map(|&position| dot(position, position)).fold(0.0, f64::max).sqrt();
    ensure!(
        farthest < 2.0,
        "it reaches {farthest:.2} units from its origin; less than 2 are possible: make it smaller, and scale the object"
    );
    Ok((mesh, materials))
}

fn colour(text: &str) -> Result<V3> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6);
    let value = value.with_context(|| format!("{text:?} is no colour; write it as RRGGBB"))?;
    Ok([16, 8, 0].map(|shift| f64::from(value >> shift & 255) / 255.0))
}

/// Of 8 bits a channel.
fn bytes(text: &str) -> Result<[u8; 3]> {
    Ok(colour(text)?.map(|c| (c * 255.0).round() as u8))
}

fn label(script: &LabelScript, size: [u32; 2]) -> Result<Label> {
    let text = script.text.chars().map(u8::try_from).collect::<Result<Vec<_>, _>>();
    let is_printed = |text: &Vec<u8>| !text.iter().any(|&character| char::from(character).is_control());
    let text = text.ok().filter(is_printed).context("text: its characters must be those of ISO 8859-1, in one line")?;
    ensure!((1..=LABEL_TEXT).contains(&text.len()), "text: it has {} characters; it can have 1 to {LABEL_TEXT}", text.len());
    let [width, height] = size.map(f64::from);
    let (side, [x, y]) = (width.min(height), script.at);
    let position = [x - width / 2.0, y - height / 2.0].map(|offset| offset / side);
    ensure!(position.iter().all(|share| share.abs() < 8.0), "at: it is too far from the picture");
    ensure!(
        script.height >= f64::from(LEAST_LINE) && script.height < 8.0 * side,
        "height: a line must be {LEAST_LINE} pixels high at least, as the smallest font is, and no higher than 8 pictures"
    );
    let alignment = match script.align {
        Align::Left => LEFT,
        Align::Middle => MIDDLE,
        Align::Right => RIGHT,
    };
    let colour = script.colour.as_deref().map_or(Ok([255; 3]), bytes)?;
    Ok(Label::new(position.map(nearest), nearest(script.height / side), colour, alignment, &text))
}

fn direction(towards: V3) -> Result<V3> {
    unit(towards).context("towards: the direction must not be zero")
}

fn lamp(light: &Light) -> Result<Lamp> {
    let colour = light.colour.as_deref().map_or(Ok([1.0; 3]), colour)?;
    match (light.towards, light.at) {
        (Some(towards), None) => Ok(Lamp::Fixed(direction(towards)?, colour)),
        (None, Some(at)) => Ok(Lamp::FixedNear(at, colour)),
        _ => bail!("say either where it shines from, by `towards`, or where it is, by `at`"),
    }
}

/// Columns of the rotation of something at `at` whose z axis points to `target`.
fn looking(at: V3, target: V3, up: V3) -> Result<[V3; 3]> {
    let z = unit(sub(target, at)).context("camera: it must not look at the point where it is")?;
    let x = unit(cross(up, z)).context("camera: it must not look along its up")?;
    Ok([x, cross(z, x), z])
}

fn eye(camera: &Camera) -> Result<View> {
    let [x, y, z] = looking(camera.at, camera.looks_at, camera.up)?;
    ensure!((1.0..170.0).contains(&camera.view), "camera: it can show 1 to 170 degrees");
    let rotation = [scale(x, -1.0), y, z];
    Ok(View {
        rotation,
        translation: rotation.map(|row| -dot(row, camera.at)),
        axis: up(),
        period: 0,
        projection: Projection::Perspective,
        focal: 1.0 / (camera.view.to_radians() / 2.0).tan(),
        near: camera.near,
        far: 32.0,
    })
}

fn cast(script: &Script, ranges: &[(String, u16, u16)]) -> Result<Cast> {
    let mut cast = Cast::default();
    for (i, object) in script.object.iter().enumerate() {
        let place = || format!("object {}, of {:?}", i + 1, object.mesh);
        let range = ranges.iter().find(|(name, ..)| *name == object.mesh);
        let &(_, first_mesh, meshes) = range.with_context(|| format!("{}: there is no such mesh", place()))?;
        cast.members.push(Member { first_mesh, meshes });
        let mut keys = vec![(0, pose(&object.pose).with_context(place)?)];
        if !object.keys.is_empty() {
            keys = object.keys.iter().map(|key| Ok((key.frame, pose(&key.pose)?))).collect::<Result<_>>().with_context(place)?;
        }
        cast.ways.push(way(OBJECT_TRACK, i, keys).with_context(place)?);
    }
    for (i, light) in script.light.iter().enumerate().filter(|(_, light)| !light.keys.is_empty()) {
        let place = || format!("light {}", i + 1);
        let vector = |key: &LightKey| match (light.towards, key.towards, key.at) {
            (Some(_), Some(towards), None) => direction(towards),
            (None, None, Some(at)) => Ok(at),
            _ => bail!("its keys must say the same as the light: `towards` or `at`"),
        };
        let keys = light.keys.iter().map(|key| Ok((key.frame, still(vector(key)?)))).collect::<Result<_>>().with_context(place)?;
        cast.ways.push(way(LIGHT_TRACK, i, keys).with_context(place)?);
    }
    if !script.camera.keys.is_empty() {
        let pose = |key: &CameraKey| {
            let [x, y, z] = looking(key.at, key.looks_at, script.camera.up)?;
            Ok((key.frame, Key { rotation: of_columns([x, y, z]).map(|c| nearest::<Rotation>(c).to_bits()), ..still(key.at) }))
        };
        let keys = script.camera.keys.iter().map(pose).collect::<Result<_>>().context("camera")?;
        cast.ways.push(way(CAMERA_TRACK, 0, keys).context("camera")?);
    }
    Ok(cast)
}

fn way(kind: u16, index: usize, keys: Vec<(u32, Key)>) -> Result<Way> {
    ensure!(keys.windows(2).all(|pair| pair[0].0 < pair[1].0), "keys: their frames must rise");
    Ok(Way { kind, index: index as u16, keys: keys.into_iter().map(|(frame, key)| Key { frame, ..key }).collect() })
}

/// At a place, neither turned nor scaled.
fn still(position: V3) -> Key {
    Key { frame: 0, rotation: [1 << 30, 0, 0, 0], position: position.map(|c| nearest::<Length>(c).to_bits()), scale: 1 << 16 }
}

fn pose(pose: &Pose) -> Result<Key> {
    let about = |axis: V3, degrees: f64| -> Result<[f64; 4]> {
        let [x, y, z] = unit(axis).context("axis: it must not be zero")?;
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        Ok([cos, x * sin, y * sin, z * sin])
    };
    let rotation = match (pose.quaternion, pose.euler, pose.axis, pose.angle) {
        (None, None, None, None) => [1.0, 0.0, 0.0, 0.0],
        (Some(quaternion), None, None, None) => {
            let length = quaternion.iter().map(|c| c * c).sum::<f64>().sqrt();
            ensure!(length > 1e-6, "quaternion: it must not be zero");
            quaternion.map(|c| c / length)
        }
        (None, Some([yaw, pitch, roll]), None, None) => {
            times(times(about([0.0, 1.0, 0.0], yaw)?, about([1.0, 0.0, 0.0], pitch)?), about([0.0, 0.0, 1.0], roll)?)
        }
        (None, None, Some(axis), Some(angle)) => about(axis, angle)?,
        _ => bail!("say a rotation by `axis` and `angle`, by `euler`, or by `quaternion`"),
    };
    let scale = pose.scale.unwrap_or(1.0);
    ensure!((1.0 / 16.0..=8.0).contains(&scale), "scale: it can be 1/16 to 8");
    ensure!(pose.at.iter().all(|c| c.abs() <= 16.0), "at: objects must be within 16 units of the origin along each axis");
    let scale = if pose.hidden { 0 } else { nearest::<Scale>(scale).to_bits() };
    Ok(Key { rotation: rotation.map(|c| nearest::<Rotation>(c).to_bits()), scale, ..still(pose.at) })
}

/// The product of two quaternions.
fn times([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w]
}

/// The quaternion of a rotation matrix. Source: Shepperd (1978).
fn of_columns([[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]]: [V3; 3]) -> [f64; 4] {
    let candidates = [
        [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, 1.0 + xx - yy - zz, xy + yx, zx + xz],
        [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy],
        [yx - xy, zx + xz, yz + zy, 1.0 - xx - yy + zz],
    ];
    let best = (0..4).max_by(|&a, &b| candidates[a][a].total_cmp(&candidates[b][b])).unwrap_or(0);
    let length = candidates[best].iter().map(|c| c * c).sum::<f64>().sqrt();
    candidates[best].map(|c| c / length)
}
