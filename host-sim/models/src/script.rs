//! Scripted scenes: a text that describes objects, their looks, and the movements of objects, lights and camera.
//!
//! The text is TOML. It becomes a stream, and host and boards play only the stream.

use crate::{
    backs::Sides,
    bytes::StreamBytes,
    coat::TextureSize,
    fields::{Field, Place, Table, quoted},
    files::Files,
    import::{self, Colours, Imported, Rules, surfaces},
    look::{Cast, Cone, KEY, LIGHT_RANGE, Lamp, LampKind, Look, Member, Surface, Way},
    mesh::{CREASE, Mesh, Weld},
    mtl::Material,
    number::nearest,
    quantise::{Part, quantise},
    records, shapes,
    turn::{Stop, Turn, along},
    vector::{V3, add, cross, dot, length, scale, sub, unit},
    view::{Projection, View},
};
use anyhow::{Context, Result, anyhow, ensure};
use microphong::{
    MAX_SIDE, Outlines,
    format::{ErrorBudget, LARGEST_BUDGET, LEAST_BUDGET, Length, MAX_LIGHTS, Scale},
    scene::Background,
    stream::{
        MAX_EXPONENT, MAX_NAME,
        record::{CAMERA_TRACK, Key, LABEL_TEXT, LEAST_LINE, LEFT, LIGHT_TRACK, Label, MAX_POSITION, MIDDLE, OBJECT_TRACK, RIGHT},
    },
};
use microphong_render::shader::Shader;
use std::{
    collections::HashMap,
    ops::{Range, RangeInclusive},
    path::Path,
};

/// Frames, and all else that 16 bits number.
const NUMBERS: u32 = u16::MAX as u32;
/// Coordinates in the world.
const WORLD: RangeInclusive<f64> = -16.0..=16.0;
/// Coordinates of meshes.
const MESH: RangeInclusive<f64> = -2.0..=2.0;
/// Components of directions, of which the length is of no matter, and degrees of turns.
const LARGE: RangeInclusive<f64> = -1e6..=1e6;
/// Degrees that the smaller side of a picture shows.
const VIEW: Range<f64> = 1.0..170.0;
/// Distance of the near plane.
const NEAR: Range<f64> = 1.0 / 64.0..16.0;
/// Half of the extent of a shape.
const EXTENT: Range<f64> = 1e-3..2.0;
/// Radius of the tube of a torus, as a fraction of its ring's.
const TUBE: RangeInclusive<f64> = 0.01..=0.99;
/// Degrees by which edges fold.
const FOLD: RangeInclusive<f64> = 0.0..=180.0;
/// Size of an object.
const SCALE: RangeInclusive<f64> = 1.0 / 16.0..=8.0;
/// Shapes that need no file.
const SHAPES: &str = "box, cylinder, sphere or torus";
/// The direction that is upwards in the picture by default.
const UP: V3 = [0.0, 1.0, 0.0];
/// Share of light that is everywhere.
const AMBIENT: f64 = 0.12;

/// A folder among files.
pub type Folder<'f> = (&'f Files, &'f Path);

/// Reads a scripted scene from the bytes of a file, as [`stream`] does. `warn` is called for what is wrong with its mesh files, and mended.
///
/// # Errors
/// The error names the line, the field and its fault.
pub fn of_bytes(bytes: &[u8], folder: Option<Folder<'_>>, warn: &dyn Fn(&str)) -> Result<(StreamBytes, (u32, u32))> {
    let text = str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
        anyhow!("line {line}: the text is not UTF-8; save it in this encoding")
    })?;
    read(text, folder, warn)
}

/// Reads a scripted scene. Mesh files are searched in `folder`; without one the text may name none. Returns the stream and the size of its picture.
///
/// # Errors
/// The error names the line, the field and its fault.
pub fn stream(text: &str, folder: Option<Folder<'_>>) -> Result<(StreamBytes, (u32, u32))> {
    read(text, folder, &|_| ())
}

fn read(text: &str, folder: Option<Folder<'_>>, warn: &dyn Fn(&str)) -> Result<(StreamBytes, (u32, u32))> {
    let mut script = Table::parse(text)?;
    let most = NUMBERS as usize;
    let frames = script.need("frames", |field| field.integer(&(1..=NUMBERS)))?;
    let size = script.get("size", |field| field.array(|side| side.integer(&(1..=MAX_SIDE))))?.unwrap_or([240; 2]);
    let background = script.get("background", background)?;
    let outlines = script.get("outlines", outlines)?;
    let shader = script.get("shader", shader)?;
    let budget = script.get("budget", |field| field.number(&(LEAST_BUDGET.to_num::<f64>()..=LARGEST_BUDGET.to_num())))?;
    let camera = script.need("camera", Field::table)?;
    let lights = script.list("light", "light", MAX_LIGHTS)?;
    let meshes = script.list("mesh", "mesh", most)?;
    let objects = script.list("object", "object", most)?;
    let labels = script.list("label", "label", u8::MAX.into())?;
    script.end()?;
    ensure!(!meshes.is_empty(), script.place.error("the scene has no [[mesh]]"));
    ensure!(!objects.is_empty(), script.place.error("the scene has no [[object]]"));

    let mut cast = Cast::default();
    let view = self::camera(camera, &mut cast)?;
    let mut stock = Stock::default();
    meshes.into_iter().try_for_each(|table| stock.add(table, folder, warn))?;
    for (i, table) in objects.into_iter().enumerate() {
        object(table, i, &stock, &mut cast)?;
    }
    let Stock { parts, surfaces, names, .. } = stock;
    let mut look = Look { frames: frames as u16, ..Look::new(surfaces[0], view) };
    look.surfaces = surfaces;
    look.objects = names;
    look.background = background.unwrap_or(look.background);
    look.shader = shader.unwrap_or(look.shader);
    look.budget = budget.map(nearest::<ErrorBudget>);
    look.lamps = vec![Lamp::fixed(KEY.map(|c| -c), [1.0; 3])];
    if !lights.is_empty() {
        look.lamps = lights.into_iter().enumerate().map(|(i, table)| lamp(table, i, &mut cast)).collect::<Result<_>>()?;
    }
    // Tracks come in this order: objects, lights, camera.
    cast.ways.sort_by_key(|way| way.kind);
    look.labels = labels.into_iter().map(|table| label(table, size)).collect::<Result<_>>()?;
    look.cast = cast;
    let mut stream = look.stream(&parts).with_context(|| script.place.to_string())?;
    if let Some(outlines) = outlines {
        stream = stream.with_outlines(outlines).with_context(|| script.place_of("outlines").to_string())?;
    }
    Ok((stream, size.into()))
}

/// A direction in the world.
fn direction(field: Field<'_>) -> Result<V3> {
    let place = field.place.clone();
    unit(field.numbers(&LARGE)?).ok_or_else(|| place.error("it must not be zero"))
}

fn colour(field: Field<'_>) -> Result<V3> {
    let place = field.place.clone();
    let text = field.text()?;
    let digits = text.strip_prefix('#').unwrap_or(&text);
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6 && !digits.starts_with('+'));
    let value = value.ok_or_else(|| place.error(format!("\"{}\" is not a colour; write it as RRGGBB", quoted(&text))))?;
    Ok([16, 8, 0].map(|shift| f64::from(value >> shift & 255) / 255.0))
}

/// A colour of 8 bits a channel.
fn bytes(field: Field<'_>) -> Result<[u8; 3]> {
    Ok(colour(field)?.map(|c| (c * 255.0).round() as u8))
}

/// A colour, or a gradient of two.
fn background(field: Field<'_>) -> Result<Background> {
    if !field.is_table() {
        let (place, is_text) = (field.place.clone(), field.is_text());
        let wanted = "a background is a colour, as \"203040\", or a gradient, as { top = \"203040\", bottom = \"000000\" }";
        return bytes(field).map(Background::Colour).map_err(|error| if is_text { error } else { place.error(wanted) });
    }
    let mut table = field.table()?;
    let [top, bottom] = [table.need("top", bytes)?, table.need("bottom", bytes)?];
    table.end()?;
    Ok(Background::Gradient { top, bottom })
}

/// Lines along outlines.
fn outlines(field: Field<'_>) -> Result<Outlines> {
    let mut table = field.table()?;
    let colour = table.get("colour", bytes)?.unwrap_or([255; 3]);
    let alone = table.get("alone", Field::flag)?.unwrap_or(false);
    table.end()?;
    Ok(Outlines::new(colour).alone(alone))
}

fn shader(field: Field<'_>) -> Result<Shader> {
    let place = field.place.clone();
    let name = field.text()?;
    Shader::ALL.into_iter().find(|shader| shader.name() == name).ok_or_else(|| {
        let names: Vec<_> = Shader::ALL.iter().map(|shader| shader.name()).collect();
        place.error(format!("there is no method \"{}\"; use one of {}", quoted(&name), names.join(", ")))
    })
}

/// Shapes and materials from which objects are made.
#[derive(Default)]
struct Stock {
    parts: Vec<Part>,
    surfaces: Vec<Surface>,
    /// Names of the meshes.
    names: Vec<String>,
    /// The first part of each mesh, and how many it has.
    meshes: HashMap<String, Member>,
}

impl Stock {
    /// Adds a mesh.
    fn add(&mut self, mut table: Table<'_>, folder: Option<Folder<'_>>, warn: &dyn Fn(&str)) -> Result<()> {
        let name = table.need("name", name)?;
        let file = table.get("file", Field::text)?;
        let shape = table.get("shape", Field::text)?;
        let size = table.get("size", |field| field.numbers(&EXTENT))?;
        let tube = table.get("tube", |field| field.number(&TUBE))?.unwrap_or(shapes::TUBE);
        let centre = table.get("centre", |field| field.numbers(&MESH))?.unwrap_or_default();
        let colour = table.get("colour", colour)?;
        let plastic = table.get("plastic", Field::flag)?.unwrap_or(false);
        let exponent = table.get("exponent", |field| field.integer(&(1..=MAX_EXPONENT.into())))?.unwrap_or(30) as u16;
        let crease = table.get("crease", |field| field.number(&FOLD))?.unwrap_or(CREASE);
        let sides = table.get("two-sided", Field::flag)?.map_or(Sides::OfFile, |two| if two { Sides::Two } else { Sides::One });
        let colours = table.get("colours", colours)?.unwrap_or_default();
        let texture_size = table.get("texture-size", texture_size)?.unwrap_or_default();
        table.end()?;
        let rules = Rules { colours, texture_size, sides, ..Rules::default() };
        let (mut mesh, mut materials) = match (&file, &shape) {
            (Some(file), None) => from_file(file, (crease, rules), folder, warn).with_context(|| table.place_of("file").to_string())?,
            (None, Some(shape)) => (of_shape(shape, tube, &table.place_of("shape"))?, vec![None]),
            _ => return Err(table.place.error(format!("a mesh needs either `file`, or `shape` with {SHAPES}"))),
        };
        if let Some(size) = size {
            mesh = shapes::stretched(mesh, size);
        }
        mesh.positions.iter_mut().for_each(|position| *position = add(*position, centre));
        let farthest = mesh.positions.iter().map(|&position| length(position)).fold(0.0, f64::max);
        let too_large =
            || format!("it reaches {farthest:.2} units from its origin; less than 2 are possible: make it smaller, and scale the object");
        ensure!(farthest < 2.0, table.place_of(if size.is_some() { "size" } else { "centre" }).error(too_large()));
        if colour.is_some() {
            mesh.merge_materials();
            materials = vec![None];
        }
        let colour = colour.unwrap_or([0.8; 3]);
        let surface = if plastic {
            Surface::plastic(colour, [AMBIENT, 0.75, 0.35], exponent)
        } else {
            Surface::metal(colour, [AMBIENT, 0.6, 0.4], exponent)
        };
        let first = self.parts.len();
        // A file's own objects are one object here.
        mesh.merge_objects();
        let (object, first_material) = (self.names.len(), self.surfaces.len() as u16);
        self.names.push(name.clone());
        self.parts.extend(quantise(&mesh).0.into_iter().map(|part| Part { object, material: part.material + first_material, ..part }));
        self.surfaces.extend(surfaces(&materials, &surface, AMBIENT));
        ensure!(
            self.parts.len() > first,
            table.place.error("rounded to steps of 1/16384, nothing is left of it; make it larger, and scale the object")
        );
        let many = "there are too many materials and parts of meshes; 65535 are possible";
        ensure!(self.parts.len().max(self.surfaces.len()) <= NUMBERS as usize, table.place.error(many));
        let member = Member { first_mesh: first as u16, meshes: (self.parts.len() - first) as u16 };
        let twice = format!("there are two meshes of the name \"{}\"", quoted(&name));
        ensure!(self.meshes.insert(name, member).is_none(), table.place_of("name").error(twice));
        Ok(())
    }
}

/// What becomes of the colours of a file.
fn colours(field: Field<'_>) -> Result<Colours> {
    let place = field.place.clone();
    let name = field.text()?;
    let names = || Colours::ALL.map(Colours::name).join(", ");
    let found = Colours::ALL.into_iter().find(|colours| colours.name() == name);
    found.ok_or_else(|| place.error(format!("there is no \"{}\"; use one of {}", quoted(&name), names())))
}

/// The largest side of a texture.
fn texture_size(field: Field<'_>) -> Result<TextureSize> {
    let place = field.place.clone();
    let texels = field.integer(&(0..=NUMBERS))?;
    TextureSize::of(texels).ok_or_else(|| place.error(format!("{texels} is not possible; use one of {}", TextureSize::names())))
}

/// A name that a stream can keep.
fn name(field: Field<'_>) -> Result<String> {
    let place = field.place.clone();
    let name = field.text()?;
    let is_kept = (1..=MAX_NAME).contains(&name.len());
    ensure!(is_kept, place.error(format!("it has {} bytes; a name can have 1 to {MAX_NAME}", name.len())));
    Ok(name)
}

fn from_file(
    file: &str,
    (crease, rules): (f64, Rules),
    folder: Option<Folder<'_>>,
    warn: &dyn Fn(&str),
) -> Result<(Mesh, Vec<Option<Material>>)> {
    let (files, folder) = folder.context("there is no folder from which files could be read; use a shape")?;
    let Imported { mesh, materials, faults, .. } = import::file_from(files, &folder.join(file), Weld { crease, ..Weld::default() }, rules)?;
    faults.iter().for_each(|fault| warn(&format!("{file}: {fault}")));
    Ok((mesh, materials))
}

fn of_shape(shape: &str, tube: f64, place: &Place<'_>) -> Result<Mesh> {
    Ok(match shape {
        "box" => shapes::cuboid(),
        "cylinder" => shapes::cylinder(32),
        "sphere" => shapes::sphere(18, 11, 0.0),
        "torus" => shapes::ring(28, 10, tube),
        other => return Err(place.error(format!("there is no shape \"{}\"; use {SHAPES}", quoted(other)))),
    })
}

/// A text over the picture. In pictures of another size it lies where the scene behind it does.
fn label(mut table: Table<'_>, size: [u32; 2]) -> Result<Label> {
    let [width, height] = size.map(f64::from);
    let side = width.min(height);
    let text = table.need("text", Field::text)?;
    let at: [f64; 2] = table.need("at", |field| field.numbers(&LARGE))?;
    let alignment = table.get("align", align)?.unwrap_or(MIDDLE);
    let line = table.get("height", |field| field.number(&(LEAST_LINE.into()..8.0 * side)))?.unwrap_or(13.0);
    let colour = table.get("colour", bytes)?.unwrap_or([255; 3]);
    table.end()?;
    let place = table.place_of("text");
    let characters = text.chars().map(u8::try_from).collect::<Result<Vec<_>, _>>();
    let is_printed = |text: &Vec<u8>| !text.iter().any(|&character| char::from(character).is_control());
    let text = characters.ok().filter(is_printed);
    let text = text.ok_or_else(|| place.error("its characters must be those of ISO 8859-1, in one line"))?;
    let count = text.len();
    ensure!((1..=LABEL_TEXT).contains(&count), place.error(format!("it has {count} characters; it can have 1 to {LABEL_TEXT}")));
    let position = [at[0] - width / 2.0, at[1] - height / 2.0].map(|offset| offset / side);
    let far = "it is too far from the picture; less than 8 of its smaller sides from its middle are possible";
    ensure!(position.iter().all(|share| share.abs() < 8.0), table.place_of("at").error(far));
    Ok(records::label(position.map(nearest), nearest(line / side), colour, alignment, &text))
}

fn align(field: Field<'_>) -> Result<u8> {
    let place = field.place.clone();
    match field.text()?.as_str() {
        "left" => Ok(LEFT),
        "middle" => Ok(MIDDLE),
        "right" => Ok(RIGHT),
        other => Err(place.error(format!("there is no \"{}\"; use left, middle or right", quoted(other)))),
    }
}

/// Angles of cones, in degrees.
const ANGLES: RangeInclusive<f64> = 0.0..=180.0;

/// The light of number `index`, and its way.
fn lamp(mut table: Table<'_>, index: usize, cast: &mut Cast) -> Result<Lamp> {
    let towards = table.get("towards", direction)?;
    let at = table.get("at", |field| field.numbers(&WORLD))?;
    let sky = table.get("sky", direction)?;
    let colour = table.get("colour", colour)?.unwrap_or([1.0; 3]);
    let range = table.get("range", |field| field.number(&LIGHT_RANGE))?;
    let shines = table.get("shines", direction)?;
    let cone: Option<[f64; 2]> = table.get("cone", |field| field.numbers(&ANGLES))?;
    let keys = table.list("keys", "key", NUMBERS as usize)?;
    table.end()?;
    let mut lamp = match (towards, at, sky) {
        (Some(towards), None, None) => Lamp::fixed(towards, colour),
        (None, Some(at), None) => Lamp::fixed_near(at, colour),
        (None, None, Some(up)) => Lamp { kind: LampKind::Sky, ..Lamp::fixed(up, colour) },
        _ => {
            let needs =
                "a light needs one of `towards`, its direction, `at`, its position, and `sky`, the direction to the middle of the sky";
            return Err(table.place.error(needs));
        }
    };
    let has_beam = range.is_some() || shines.is_some() || cone.is_some();
    ensure!(lamp.kind == LampKind::Near || !has_beam, table.place.error("only a light with `at` can have `range`, `shines` and `cone`"));
    lamp.range = range;
    lamp.cone = match (shines, cone) {
        (None, None) => None,
        (Some(axis), Some([full, edge])) if full < edge => Some(Cone { axis, full, edge }),
        (Some(_), Some(_)) => {
            let order = "the first angle, up to which light is full, must be smaller than the second, where it ends";
            return Err(table.place_of("cone").error(order));
        }
        _ => return Err(table.place.error("a light with a cone needs both `shines`, its direction, and `cone`, two angles in degrees")),
    };
    let mut before = None;
    let stop = |mut table: Table<'_>, frame| {
        let towards = table.get("towards", direction)?;
        let at = table.get("at", |field| field.numbers(&WORLD))?;
        let sky = table.get("sky", direction)?;
        table.end()?;
        let vector = match (lamp.kind, towards, at, sky) {
            (LampKind::Distant, Some(vector), None, None)
            | (LampKind::Near, None, Some(vector), None)
            | (LampKind::Sky, None, None, Some(vector)) => vector,
            _ => return Err(table.place.error("a light and its keys must all have `towards`, all `at`, or all `sky`")),
        };
        let towards = towards.or(sky);
        // Between opposite directions there is no shorter way, and the straight one goes through no light.
        let is_opposite = towards.zip(before.replace(vector)).is_some_and(|(now, before)| dot(now, before) < OPPOSITE);
        let opposite = "it is opposite to the key before, and there are many ways between them; write a key in between";
        ensure!(!is_opposite, table.place_of("towards").error(opposite));
        Ok(Stop::new(frame, vector, Turn::NONE))
    };
    way(cast, LIGHT_TRACK, index, keys, stop)?;
    Ok(lamp)
}

/// The cosine of 179 degrees.
const OPPOSITE: f64 = -0.999_85;

/// The position of the camera, and the point it looks at.
fn eye(table: &mut Table<'_>) -> Result<[V3; 2]> {
    let at: V3 = table.need("at", |field| field.numbers(&WORLD))?;
    let target = table.get("looks-at", |field| field.numbers(&LARGE))?.unwrap_or_default();
    // As it is, and as it is rounded.
    let farthest = length(at).max(length(at.map(|c| nearest::<Length>(c).to_num())));
    let far = || format!("it is {farthest:.2} units from the origin; at most {MAX_POSITION} are possible");
    ensure!(farthest <= MAX_POSITION.to_num::<f64>(), table.place_of("at").error(far()));
    Ok([at, target])
}

/// Columns of the rotation of a camera whose z axis points to its target.
fn looking([at, target]: [V3; 2], up: V3, table: &Table<'_>) -> Result<[V3; 3]> {
    let z = unit(sub(target, at)).ok_or_else(|| table.place_of("at").error("the camera must not look at the point where it is"))?;
    let side = Some(cross(up, z)).filter(|&side| length(side) > 1e-3);
    let x = side.and_then(unit).ok_or_else(|| table.place_of("at").error("the camera must not look along its `up`"))?;
    Ok([x, cross(z, x), z])
}

/// The camera, and its way.
fn camera(mut table: Table<'_>, cast: &mut Cast) -> Result<View> {
    let eye = self::eye(&mut table)?;
    let up = table.get("up", direction)?.unwrap_or(UP);
    let view = table.get("view", |field| field.number(&VIEW))?.unwrap_or(40.0);
    let near = table.get("near", |field| field.number(&NEAR))?.unwrap_or(0.5);
    let keys = table.list("keys", "key", NUMBERS as usize)?;
    table.end()?;
    let [x, y, z] = looking(eye, up, &table)?;
    let stop = |mut table: Table<'_>, frame| {
        let eye = self::eye(&mut table)?;
        table.end()?;
        let rotation = of_columns(looking(eye, up, &table)?);
        Ok(Stop::new(frame, eye[0], Turn::Quaternion(rotation)))
    };
    way(cast, CAMERA_TRACK, 0, keys, stop)?;
    let rotation = [scale(x, -1.0), y, z];
    Ok(View {
        rotation,
        translation: rotation.map(|row| -dot(row, eye[0])),
        axis: UP,
        period: 0,
        projection: Projection::Perspective,
        focal: 1.0 / libm::tan(view.to_radians() / 2.0),
        near,
        far: 32.0,
    })
}

/// An object, and its way.
fn object(mut table: Table<'_>, index: usize, stock: &Stock, cast: &mut Cast) -> Result<()> {
    let mesh = table.need("mesh", Field::text)?;
    let keys = table.list("keys", "key", NUMBERS as usize)?;
    let pose = self::pose(&mut table, 0)?;
    let no_mesh = || table.place_of("mesh").error(format!("there is no mesh \"{}\"; write a [[mesh]] of this name", quoted(&mesh)));
    cast.members.push(*stock.meshes.get(&mesh).ok_or_else(no_mesh)?);
    if keys.is_empty() {
        cast.ways.push(Way { kind: OBJECT_TRACK, index: index as u16, keys: vec![pose.key] });
    }
    way(cast, OBJECT_TRACK, index, keys, |mut table, frame| self::pose(&mut table, frame))
}

/// The way of something, by the keys that `stop` reads, if there are any.
fn way(
    cast: &mut Cast,
    kind: u16,
    index: usize,
    tables: Vec<Table<'_>>,
    mut stop: impl FnMut(Table<'_>, u32) -> Result<Stop>,
) -> Result<()> {
    let mut stops = Vec::<Stop>::new();
    for mut table in tables {
        let frame = table.need("frame", |field| field.integer(&(0..=NUMBERS)))?;
        let before = stops.last().map(|stop| stop.key.frame);
        ensure!(before.is_none_or(|before| before < frame), table.place_of("frame").error("the frames of keys must rise"));
        stops.push(stop(table, frame)?);
    }
    if !stops.is_empty() {
        cast.ways.push(Way { kind, index: index as u16, keys: along(&stops) });
    }
    Ok(())
}

/// The pose of an object: all fields of a table that are left.
fn pose(table: &mut Table<'_>, frame: u32) -> Result<Stop> {
    let at = table.get("at", |field| field.numbers(&WORLD))?.unwrap_or_default();
    let axis = table.get("axis", direction)?;
    let angle = table.get("angle", |field| field.number(&LARGE))?;
    let euler = table.get("euler", |field| field.numbers(&LARGE))?;
    let quaternion = table.get("quaternion", quaternion)?;
    let scale = table.get("scale", |field| field.number(&SCALE))?.unwrap_or(1.0);
    let hidden = table.get("hidden", Field::flag)?.unwrap_or(false);
    table.end()?;
    let turn = match (quaternion, euler, axis, angle) {
        (None, None, None, None) => Turn::NONE,
        (Some(quaternion), None, None, None) => Turn::Quaternion(quaternion),
        (None, Some(euler), None, None) => Turn::Euler(euler),
        (None, None, Some(axis), Some(angle)) => Turn::About(axis, angle),
        _ => {
            let place = table.place_of_any(&["quaternion", "euler", "axis", "angle"]);
            return Err(place.error("a rotation needs either `axis` and `angle`, or `euler`, or `quaternion`"));
        }
    };
    let scale = if hidden { 0 } else { nearest::<Scale>(scale).to_bits() };
    let stop = Stop::new(frame, at, turn);
    Ok(Stop { key: Key { scale, ..stop.key }, ..stop })
}

/// w, x, y, z; it becomes a unit one.
fn quaternion(field: Field<'_>) -> Result<[f64; 4]> {
    let place = field.place.clone();
    let quaternion = field.numbers(&LARGE)?;
    let length = quaternion.iter().map(|c| c * c).sum::<f64>().sqrt();
    ensure!(length > 1e-6, place.error("it must not be zero"));
    Ok(quaternion.map(|c| c / length))
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
