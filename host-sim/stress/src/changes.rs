//! Scenes of several objects that change between frames. Each frame is compared with the frame of a new renderer for the state at that time.
//!
//! The compared picture is updated by partial redraw: only areas that the renderer names are drawn, in bands of any height, with little memory or
//! much, prepared and drawn in one part or in two. The new renderer draws the whole picture at once, with room for everything.

use crate::{
    Family, Verdict,
    case::Case,
    change::{Change, State, eye, pose},
    random::Random,
    scenes::{self, Wishes},
    transparency,
};
use embedded_graphics_core::{
    geometry::{Point, Size},
    pixelcolor::Rgb565,
    primitives::{PointsIter, Rectangle},
};
use microphong::{
    Frame, Layout, Outlines, Pose, Renderer, Stream,
    format::Length,
    pixel::gamma,
    stream::record::{CAMERA_TRACK, Key, LIGHT_TRACK, OBJECT_TRACK},
};
use microphong_models::{
    look::{Cast, LampKind, Look, Member, Way},
    number::nearest,
    quantise::Part,
};
use microphong_render::{render::Style, shader::Shader};

/// Random scenes of up to twelve objects, and random changes.
pub struct Changes;

impl Family for Changes {
    fn name(&self) -> &'static str {
        "changes"
    }

    fn about(&self) -> &'static str {
        "partial redraw gives the picture of a new renderer; values out of range are errors"
    }

    fn counts(&self) -> &'static [&'static str] {
        &["frames", "of them in part", "changes", "of them refused"]
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let case = match case(random, 60) {
            Ok(Some(case)) => case,
            Ok(None) => return Verdict::skipped(),
            Err(what) => return Verdict { failure: Some(what), ..Verdict::default() },
        };
        match judge(&case, all) {
            Ok(Some(found)) => Verdict { counts: found.into(), case: Some(case), ..Verdict::default() },
            // The method cannot draw this scene.
            Ok(None) => Verdict::skipped(),
            Err(what) => Verdict { failure: Some(what), case: Some(case), ..Verdict::default() },
        }
    }

    fn fails(&self, case: &Case) -> bool {
        judge(case, all).is_err()
    }
}

/// Frames of a case.
const FRAMES: i32 = 12;
/// Objects that there is room for.
const OBJECTS: usize = 12;

/// Random meshes of about `triangles` triangles, as one object or as several that tracks move. The frame of the case is the seed of its changes.
/// `None` if they would not make a valid stream.
///
/// # Errors
/// When a pose out of range is accepted, or a valid one refused.
pub fn case(random: &mut Random, triangles: i32) -> Result<Option<Case>, String> {
    let width = random.between(8.0, 100.0);
    let size = scenes::size(random, width);
    let wishes = Wishes { closed: random.once_in(2), unclipped: !random.once_in(4), triangles, hard: scenes::Hard::default() };
    let meshes: Vec<_> = (0..random.pick(1..5)).map(|_| scenes::mesh(random, wishes)).collect();
    let mut look = scenes::look(random, &meshes[0], size, wishes);
    look.surfaces = (0..random.pick(1..4)).map(|_| scenes::surface(random, false)).collect();
    let mut parts = Vec::new();
    for mesh in &meshes {
        let Some(mut of_mesh) = scenes::parts(random, mesh, &look) else { return Ok(None) };
        of_mesh.iter_mut().for_each(|part| part.material = random.pick(0..look.surfaces.len() as i32) as u16);
        parts.append(&mut of_mesh);
    }
    if random.once_in(2) {
        look.frames = random.pick(2..100) as u16;
        look.cast = cast(random, &parts, &look)?;
    }
    let Ok(stream) = look.stream(&parts) else { return Ok(None) };
    let stream = transparency::sometimes(random, stream);
    let mut case = scenes::styled(random, stream, size);
    case.frame = random.bits() as u32;
    Ok(Some(case))
}

/// Objects, and tracks of most of them, of lights and of the camera.
fn cast(random: &mut Random, parts: &[Part], look: &Look) -> Result<Cast, String> {
    let mut cast = Cast::default();
    for index in 0..random.pick(1..OBJECTS as i32 + 1) as u16 {
        let first = random.pick(0..parts.len() as i32) as usize;
        let many = random.pick(1..parts.len() as i32 - first as i32 + 1) as usize;
        // Coarser levels are meshes of their own.
        let count = |parts: &[Part]| parts.iter().map(|part| part.levels().count() as u16).sum();
        cast.members.push(Member { first_mesh: count(&parts[..first]), meshes: count(&parts[first..first + many]) });
        if !random.once_in(4) {
            cast.ways.push(Way { kind: OBJECT_TRACK, index, keys: keys(random, look, pose)? });
        }
    }
    for (index, lamp) in (0..).zip(&look.lamps).filter(|_| random.once_in(3)).collect::<Vec<_>>() {
        let mut keys = keys(random, look, pose)?;
        if lamp.kind != LampKind::Near {
            keys.iter_mut().for_each(|key| key.position = random.direction().map(|c| nearest::<Length>(c).to_bits()));
        }
        cast.ways.push(Way { kind: LIGHT_TRACK, index, keys });
    }
    if random.once_in(3) {
        cast.ways.push(Way { kind: CAMERA_TRACK, index: 0, keys: keys(random, look, eye)? });
    }
    Ok(cast)
}

/// Poses in some frames, of which some are hidden.
fn keys(random: &mut Random, look: &Look, pose: impl Fn(&mut Random) -> Result<Pose, String>) -> Result<Vec<Key>, String> {
    let mut keys: Vec<Key> = Vec::new();
    let mut frame = random.pick(0..8) as u32;
    for _ in 0..random.pick(1..5) {
        let pose = pose(random)?;
        keys.push(Key {
            frame,
            rotation: pose.quaternion().map(|c| c.to_bits()),
            position: pose.position().map(Length::to_bits),
            scale: if random.once_in(6) { 0 } else { pose.scale().to_bits() },
        });
        frame += random.pick(1..i32::from(look.frames)) as u32;
    }
    Ok(keys)
}

/// Amounts that were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    frames: u64,
    in_part: u64,
    changes: u64,
    refused: u64,
}

impl From<Found> for Vec<u64> {
    fn from(Found { frames, in_part, changes, refused }: Found) -> Self {
        vec![frames, in_part, changes, refused]
    }
}

/// An additional limit for a frame, by which it leaves out more than the renderer does.
pub type Limit = fn(&mut Frame<'_, Rgb565>);

/// The limit that leaves out nothing more.
pub fn all(_: &mut Frame<'_, Rgb565>) {}

/// Draws some frames of a case with changes between them; `None` if its method cannot draw it.
///
/// # Errors
/// The faulty frame, its fault, and the changes since the frame before.
pub fn judge(case: &Case, limit: Limit) -> Result<Option<Found>, String> {
    let Ok(bytes) = case.stream.with_neighbours() else { return Ok(None) };
    let Ok(stream) = bytes.parse() else { return Ok(None) };
    let random = &mut Random::new(case.frame.into(), 0);
    let mut state = State::new(&stream, case.style);
    let layout = layout(random, case, &stream, &state);
    let mut memory = vec![0x0123_4567_89AB_CDEF; layout.words::<Rgb565>()];
    let shader = case.style.shader.on();
    let Ok(mut renderer) = Renderer::with_shader(stream, case.pixels(), &layout, &mut memory, shader) else { return Ok(None) };
    let (antialias, outlines) = (layout.antialias && case.style.antialias, Outlines::of(stream.header));
    state.style = Style { perspective_correct: false, antialias, outlines, ..case.style };
    renderer.set_antialias(state.style.antialias).map_err(|error| error.to_string())?;
    renderer.set_dither(case.style.dither);
    renderer.set_gamma(case.style.srgb.then_some(&gamma::SRGB));
    let mut shown = vec![Rgb565::default(); (case.size[0] * case.size[1]) as usize];
    let mut found = Found::default();
    for number in 0..random.pick(2..FRAMES) {
        let mut told = Vec::new();
        let mut tell = |change: Change, state: &mut State| {
            let is_taken = tell(&change, &mut renderer, state, &stream, &layout).map_err(|what| format!("frame {number}: {what}"))?;
            found.changes += 1;
            found.refused += u64::from(!is_taken);
            told.push(change);
            Ok::<(), String>(())
        };
        if number == 0 && !state.is_scripted() && !random.once_in(4) {
            for change in Change::arrangement(random, OBJECTS, &stream)? {
                tell(change, &mut state)?;
            }
        }
        let calm = random.once_in(2);
        for _ in 0..random.pick(0..4) {
            tell(Change::new(random, calm, &state, &stream)?, &mut state)?;
        }
        found.frames += 1;
        // What has not changed need not be drawn.
        if number == 0 || !renderer.scene().is_unchanged() || random.once_in(2) {
            found.in_part += u64::from(draw(random, &mut renderer, &state, &layout, limit, &mut shown)?);
        }
        let whole = whole(case, &stream, &state).map_err(|what| format!("frame {number}: a new renderer refuses the scene: {what}"))?;
        let differ: Vec<_> = (0..whole.len()).filter(|&pixel| shown[pixel] != whole[pixel]).collect();
        if let (Some(first), Some(last)) = (differ.first(), differ.last()) {
            let rows = [first, last].map(|pixel| pixel / case.size[0] as usize);
            return Err(format!(
                "frame {number}: {} of {} pixels differ from those of a new renderer, in rows {} to {}, after {told:?}",
                differ.len(),
                whole.len(),
                rows[0],
                rows[1],
            ));
        }
    }
    Ok(Some(found))
}

/// Room for all objects or for few triangles and vertices, for one processor or two.
fn layout(random: &mut Random, case: &Case, stream: &Stream<'_>, state: &State) -> Layout {
    let rows = case.band_rows.min(case.size[1]);
    let layout = state.room(Layout::new(case.size[0] as usize, rows as usize), stream);
    let some = |random: &mut Random, all: usize| if random.once_in(3) { random.pick(0..all as i32 + 1) as usize } else { 4 * all };
    layout
        .objects(layout.objects.max(OBJECTS))
        .vertices(some(random, layout.vertices))
        .triangles(some(random, layout.triangles))
        .active_triangles(random.pick(0..64) as usize)
        .antialias(random.once_in(3))
        .edges(random.pick(0..400) as usize)
        .processors(random.pick(1..3) as usize)
}

/// Changes the scene and its expected state. Returns whether the change was accepted.
fn tell(
    change: &Change,
    renderer: &mut Renderer<'_, Rgb565>,
    state: &mut State,
    stream: &Stream<'_>,
    layout: &Layout,
) -> Result<bool, String> {
    let right = change.is_right(state, stream, layout);
    let was_unchanged = renderer.scene().is_unchanged();
    let told = change.tell(renderer);
    match (right, &told) {
        (Some(false), Ok(())) => return Err(format!("{change:?} is taken, which is out of range")),
        (Some(true), Err(error)) => return Err(format!("{change:?} is refused: {error}")),
        _ => {}
    }
    if told.is_ok() {
        change.clone().keep(state);
    } else if was_unchanged && !renderer.scene().is_unchanged() {
        return Err(format!("{change:?} is refused, and changes the scene"));
    }
    Ok(told.is_ok())
}

/// Draws changed areas over the picture `shown`, in one way or another. Returns whether they are less than the whole picture.
fn draw(
    random: &mut Random,
    renderer: &mut Renderer<'_, Rgb565>,
    state: &State,
    layout: &Layout,
    limit: Limit,
    shown: &mut [Rgb565],
) -> Result<bool, String> {
    let size = renderer.size();
    let mut band = vec![Rgb565::default(); layout.band()];
    // A whole frame now and then.
    renderer.set_partial_redraw(!random.once_in(8));
    while random.once_in(4) {
        let mut range = |side: u32| {
            let start = random.pick(-20..side as i32 + 20);
            (start, random.pick(0..60) as u32)
        };
        let ((left, width), (top, height)) = (range(size.width), range(size.height));
        let area = Rectangle::new(Point::new(left, top), Size::new(width, height));
        renderer.invalidate(area);
        // The program has drawn there.
        for point in area.intersection(&Rectangle::new(Point::zero(), size)).points() {
            shown[(point.y as u32 * size.width) as usize + point.x as usize] = Rgb565::new(31, 0, 31);
        }
    }
    let mut frame = match random.pick(0..3) {
        0 => renderer.draw(),
        1 => renderer.frame(state.frame()),
        _ => renderer.prepare(state.frame(), random.bits() as u16).frame(),
    };
    let in_part = !frame.is_whole();
    limit(&mut frame);
    let mut show = |area: Rectangle, band: &[Rgb565]| {
        for (row, pixels) in (area.top_left.y as u32..).zip(band.chunks_exact(area.size.width as usize)).take(area.size.height as usize) {
            let first = (row * size.width) as usize + area.top_left.x as usize;
            shown[first..][..pixels.len()].copy_from_slice(pixels);
        }
    };
    if layout.processors > 1 && random.once_in(2) {
        let mut frame = frame.in_two(random.pick(0..size.height as i32 + 1) as u32);
        for mut part in frame.parts() {
            while let Some(area) = part.next_band(&mut band).map_err(|error| error.to_string())? {
                show(area, &band);
            }
        }
    } else {
        while !frame.is_complete() {
            let area = frame.next_band(&mut band).map_err(|error| error.to_string())?;
            show(area.ok_or("a frame has no band, though it is not complete")?, &band);
        }
        if frame.next_band(&mut band) != Ok(None) {
            return Err("a frame has a band, though it is complete".to_owned());
        }
    }
    Ok(in_part)
}

/// The whole picture of a scene by a new renderer, in one band, with room for everything.
fn whole(case: &Case, stream: &Stream<'_>, state: &State) -> Result<Vec<Rgb565>, String> {
    let [width, height] = case.size.map(|side| side as usize);
    let layout = state.room(Layout::new(width, height).active_triangles(0), stream);
    let mut memory = vec![0; layout.words::<Rgb565>()];
    // The stream may be such that the method cannot draw it, unlike what has become of it.
    let renderer = Renderer::with_shader(*stream, case.pixels(), &layout, &mut memory, Shader::FLAT.on());
    let mut renderer = renderer.map_err(|error| error.to_string())?;
    state.set(&mut renderer)?;
    let mut pixels = vec![Rgb565::default(); width * height];
    let mut frame = renderer.draw();
    let area = frame.next_band(&mut pixels).map_err(|error| error.to_string())?;
    if area != Some(Rectangle::new(Point::zero(), case.pixels())) {
        return Err(format!("one band is {area:?}"));
    }
    Ok(pixels)
}
