//! The whole core, from bytes and changes of the scene to pixels in every format of a board, with a panic handler that cannot be linked.
//!
//! `cargo build --release -p panic-free --features all --target thumbv7m-none-eabi`, in the folder `firmware`, fails with *undefined symbol:
//! a_panic_can_be_reached* if the optimised code holds a panic.
#![no_std]
#![no_main]

use embedded_graphics_core::{
    geometry::{Point, Size},
    pixelcolor::{Gray4, Rgb565},
    primitives::Rectangle,
};
use microphong::{
    Background, Layout, Light, Material, Outlines, Pose, PreparationPart, Renderer, Scene, SceneError, Shader, Stream,
    format::{Angle, ErrorBudget, Focal, Gain, Length, Rotation, Scale},
    pixel::{self, FromDrawn, LightGray, Output, PictureCrc, Pixel, Rgb565Be, gamma::SRGB},
};

use microphong_literature::ALL;

unsafe extern "C" {
    safe fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    a_panic_can_be_reached()
}

/// Pixels of a band.
const BAND: usize = 9600;
/// Room for a small scene, antialiased.
const LAYOUT: Layout = Layout::new(240, 40).vertices(600).triangles(600).materials(2).processors(2).antialias(cfg!(feature = "all"));
/// Number of words that suffices in every pixel format: the largest pixels take most.
const WORDS: usize = LAYOUT.words::<pixel::Light<5, 6, 5>>();

/// The memory that a board draws pictures in: of pixels `C` for a display with pixels `F`.
pub struct Buffers<C: Pixel, F> {
    memory: [u64; WORDS],
    band: [C; BAND],
    pixels: [F; BAND],
}

/// What to draw, and how. Nothing of it is known at compile time.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Request {
    stream: &'static [u8],
    size: [u32; 2],
    /// The method, by its index.
    shader: usize,
    number: u32,
    /// Name of the object.
    name: &'static str,
    /// Share of the triangles at which work is divided for two processors, in units of 1/65,536.
    share: u16,
    dither: bool,
    gamma: bool,
    antialias: bool,
    perspective: bool,
    output: Output,
    budget: ErrorBudget,
    /// An object, a material, and a mesh.
    indices: [u16; 3],
    position: [Length; 3],
    target: [Length; 3],
    axis: [Rotation; 3],
    quaternion: [Rotation; 4],
    scale: Scale,
    angles: [Angle; 3],
    gains: [Gain; 3],
    focal: Focal,
    /// Numbers of a sensor.
    numbers: [f32; 4],
    colour: [u8; 3],
}

/// Poses made in every way.
fn pose(request: &Request) -> Result<Pose, SceneError> {
    let Request { position, target, axis, quaternion, scale, angles: [yaw, pitch, roll], numbers, .. } = *request;
    let [x, y, z, size] = numbers;
    let turned = Pose::about(axis.map(Rotation::to_bits), yaw)?.turned(&Pose::from_quaternion(quaternion)?);
    let other = Pose::from_euler(yaw, pitch, roll).turned(&Pose::from_matrix([axis; 3])?);
    let seen = turned.turned(&other).turned(&Pose::from_f32(numbers, [x, y, z], size)?);
    Pose::looking_at(position, target, axis.map(Length::wrapping_from_num))?.turned(&seen).at(position)?.scaled(scale)
}

/// Lights of every kind that the features allow.
#[cfg(not(feature = "all"))]
fn lights(request: &Request) -> Result<[Light; 1], SceneError> {
    Ok([Light::directional(request.position, request.gains)?])
}

#[cfg(feature = "all")]
fn lights(request: &Request) -> Result<[Light; 6], SceneError> {
    let Request { position, target, angles: [full, edge, _], gains, numbers: [x, y, z, range], .. } = *request;
    let [sky, ground] = Light::hemisphere(target, gains, gains)?;
    let near = Light::near([x, y, z], [x, y, z])?.with_range(range)?.with_camera();
    let cone = Light::near(position, gains)?.with_cone(target, full, edge)?;
    Ok([sky, ground, near, cone, Light::directional([x, y, z], gains)?, Light::sky(position, gains)?])
}

/// Changes everything of the scene.
fn arrange(scene: &mut Scene<'_>, request: &Request) -> Result<u32, SceneError> {
    let Request { indices: [object, material, mesh], gains, focal, colour, position, target, .. } = *request;
    let pose = pose(request)?;
    let added = scene.add(mesh..material, pose)?;
    scene.set_pose(object.into(), pose)?;
    scene.set_visible(added, request.dither)?;
    scene.set_object_material(object.into(), request.gamma.then_some(material))?;
    scene.set_material(material.into(), Material::new(gains, gains, gains, object))?;
    scene.set_lights(&lights(request)?)?;
    scene.set_ambient(gains)?;
    scene.set_background(Background::Gradient { top: colour, bottom: [object as u8; 3] });
    scene.set_outlines(Some(Outlines::new(colour).alone(request.perspective)))?;
    let camera = *scene.camera();
    scene.set_camera(camera.with_focal(focal).orbiting(request.axis, material).with_local_viewer())?;
    scene.look_at(position, target, position)?;
    scene.set_camera_pose(&pose)?;
    let kept = scene.objects().iter().map(|object| u32::from(object.meshes().end)).sum::<u32>();
    let gains = scene.materials().map(|material| u32::from(material.specular()[0].to_bits())).sum::<u32>();
    scene.play(request.number);
    Ok(kept ^ gains ^ scene.lights().len() as u32)
}

/// One frame, band by band, as a board draws it: its checksum and its count of pixels.
fn draw<C: Pixel, F: FromDrawn<C>>(request: Request, buffers: &mut Buffers<C, F>) -> Option<u32> {
    let [width, height] = request.size;
    let literature = Shader::new(*ALL.get(request.shader / 8)?);
    let shader = Shader::ALL.get(request.shader).copied().unwrap_or(literature);
    let stream = Stream::parse(request.stream).ok()?;
    let mut renderer = Renderer::with_shader(stream, Size::new(width, height), &LAYOUT, &mut buffers.memory, shader).ok()?;
    renderer.set_dither(request.dither);
    renderer.set_gamma(request.gamma.then_some(&SRGB));
    #[cfg(feature = "all")]
    renderer.set_antialias(request.antialias).ok()?;
    renderer.set_perspective_correct(request.perspective).ok()?;
    renderer.set_budget(request.budget).ok()?;
    #[cfg(feature = "all")]
    {
        renderer.set_levels_of_detail(request.perspective);
        renderer.set_partial_redraw(request.dither);
        renderer.invalidate(Rectangle::new(Point::zero(), Size::new(height, width)));
    }
    let changed = arrange(renderer.scene(), &request).ok()?;
    let mut frame = renderer.frame(request.number);
    let mut crc = PictureCrc::default();
    while let Some(area) = frame.next_band(&mut buffers.band).ok()? {
        frame.output().convert(&buffers.band, area, &mut buffers.pixels);
        crc.update(&buffers.pixels);
        frame.output().pixels::<C, F>(&buffers.band, area).for_each(|pixel| crc.update(&[pixel]));
    }
    let mut preparation = renderer.prepare(request.number, request.share);
    preparation.parts().into_iter().for_each(PreparationPart::run);
    let frame = preparation.frame();
    let row = frame.row_at(request.share);
    let mut frame = frame.in_two(row);
    for mut part in frame.parts() {
        while let Some(area) = part.next_band(&mut buffers.band).ok()? {
            part.output().convert(&buffers.band, area, &mut buffers.pixels);
            crc.update(&buffers.pixels);
        }
    }
    let named = stream.mesh(request.name).map_or(0, |meshes| meshes.end.into());
    let characters = stream.names().flatten().map(|(name, _)| name.len() as u32).sum::<u32>();
    Some(crc.finish() ^ frame.stats().pixels ^ named ^ characters ^ changed)
}

/// Arguments come from outside, so nothing is known at compile time. The formats are those of the boards.
#[unsafe(no_mangle)]
pub extern "C" fn _start(
    request: &'static Request,
    rgb565: &'static mut Buffers<Rgb565, Rgb565>,
    rgb565_be: &'static mut Buffers<Rgb565Be, Rgb565Be>,
    light: &'static mut Buffers<pixel::Light<5, 6, 5>, Rgb565>,
    gray4: &'static mut Buffers<LightGray<4>, Gray4>,
    packed: &'static mut [u8; BAND / 2],
) -> u32 {
    if cfg!(feature = "with-a-panic") {
        return u32::from(request.stream[request.shader]);
    }
    let checksums = [draw(*request, rgb565), draw(*request, rgb565_be), draw(*request, light), draw(*request, gray4)];
    let (area, output) = (Rectangle::new(Point::zero(), request.size.into()), request.output);
    output.pack(&gray4.band, area, packed);
    checksums.into_iter().flatten().fold(0, |all, one| all ^ one)
}
