//! [retrofire](https://crates.io/crates/retrofire): vertex and fragment shaders, always perspective-correct, depth in `f32`.

use crate::{
    Drawing, HEIGHT, WIDTH,
    scene::{self, Scene},
};
use alloc::{boxed::Box, vec, vec::Vec};
use core::array;
use retrofire_core::{
    geom::{Tri, Vertex3, tri, vertex},
    math::{Color, Color3f, Color4, Mat4, ProjMat3, Vary, Vec3, perspective, pt2, pt3, viewport},
    render::{Colorbuf, Context, Frag, Framebuf, Model, Ndc, Screen, Shader, View, render, shader},
    util::{Dims, MutSlice2, pixfmt::Rgb565},
};

/// The space of a shader's variables, its own: so that shaders share no code, and each is inlined as if it were alone.
#[derive(Clone, Copy, Debug, Default)]
struct Own<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16>;

type Normal<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> = Vec3<Own<CHANNELS, LIGHTS, EXPONENT>>;

/// Shares of full light.
type Levels<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> = Color<[f32; CHANNELS], Own<CHANNELS, LIGHTS, EXPONENT>>;

type Corner<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> = Vertex3<Normal<CHANNELS, LIGHTS, EXPONENT>>;

/// Reflectances of a surface. All numbers are constants, as in shaders that are written for one scene, so a power is a few products.
struct Surface<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> {
    ambient: [f32; CHANNELS],
    lights: [Light<CHANNELS, LIGHTS, EXPONENT>; LIGHTS],
}

struct Light<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> {
    towards: Normal<CHANNELS, LIGHTS, EXPONENT>,
    half: Normal<CHANNELS, LIGHTS, EXPONENT>,
    diffuse: [f32; CHANNELS],
    specular: [f32; CHANNELS],
}

impl<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> Surface<CHANNELS, LIGHTS, EXPONENT> {
    fn new(scene: &Scene) -> Self {
        let channels = |colour: [f32; 3]| array::from_fn(|channel| colour[channel]);
        let light = |index| {
            let scene::Light { towards, half, diffuse, specular } = scene.lights[index];
            Light { towards: towards.into(), half: half.into(), diffuse: channels(diffuse), specular: channels(specular) }
        };
        Self { ambient: channels(scene.ambient), lights: array::from_fn(light) }
    }

    #[inline]
    fn levels(&self, normal: Normal<CHANNELS, LIGHTS, EXPONENT>) -> Levels<CHANNELS, LIGHTS, EXPONENT> {
        let mut levels = self.ambient;
        for light in &self.lights {
            let diffuse = normal.dot(&light.towards).max(0.0);
            let highlight = power(normal.dot(&light.half).max(0.0), EXPONENT);
            for (channel, level) in levels.iter_mut().enumerate() {
                *level += light.diffuse[channel] * diffuse + light.specular[channel] * highlight;
            }
        }
        levels.into()
    }
}

/// A power, by repeated squaring.
#[inline]
fn power(mut base: f32, mut exponent: u16) -> f32 {
    let mut result = 1.0;
    while exponent > 0 {
        if exponent & 1 != 0 {
            result *= base;
        }
        base *= base;
        exponent >>= 1;
    }
    result
}

/// A single channel is red, green and blue at once.
#[inline]
fn colour<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16>(levels: Levels<CHANNELS, LIGHTS, EXPONENT>) -> Color4 {
    Color3f::new(array::from_fn(|channel| levels.0[channel % CHANNELS])).to_color4()
}

/// Constants of a scene for the shaders.
struct Uniforms<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16> {
    to_clip: ProjMat3<Model>,
    surface: Surface<CHANNELS, LIGHTS, EXPONENT>,
}

/// The place where light is computed.
#[derive(Clone, Copy)]
pub(crate) enum Shading {
    /// Light is computed at the vertices.
    Gouraud,
    /// Light is computed at each pixel. Normals are interpolated, and normalised in the cheaper of retrofire's two ways.
    Phong,
}

/// Shaders are compiled for the channels, lights and exponents of ordinary scenes; `None` for others.
pub(crate) fn drawing(scene: &Scene, shading: Shading) -> Option<Drawing<'_>> {
    match (scene.channels(), scene.lights.len(), scene.exponent) {
        (1, 1, 50) => Some(shaded::<1, 1, 50>(scene, shading)),
        (3, 1, 20) => Some(shaded::<3, 1, 20>(scene, shading)),
        (3, 1, 30) => Some(shaded::<3, 1, 30>(scene, shading)),
        (3, 1, 50) => Some(shaded::<3, 1, 50>(scene, shading)),
        (3, 2, 24) => Some(shaded::<3, 2, 24>(scene, shading)),
        (3, 2, 50) => Some(shaded::<3, 2, 50>(scene, shading)),
        _ => None,
    }
}

fn shaded<const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16>(scene: &Scene, shading: Shading) -> Drawing<'_> {
    match shading {
        Shading::Gouraud => with_shader(
            scene,
            shader::new(
                |v: Corner<CHANNELS, LIGHTS, EXPONENT>, uniforms: &Uniforms<CHANNELS, LIGHTS, EXPONENT>| {
                    vertex(uniforms.to_clip.apply(&v.pos), uniforms.surface.levels(v.attrib))
                },
                |fragment: Frag<Levels<CHANNELS, LIGHTS, EXPONENT>>, _: &Uniforms<CHANNELS, LIGHTS, EXPONENT>| colour(fragment.var),
            ),
        ),
        Shading::Phong => with_shader(
            scene,
            shader::new(
                |v: Corner<CHANNELS, LIGHTS, EXPONENT>, uniforms: &Uniforms<CHANNELS, LIGHTS, EXPONENT>| {
                    vertex(uniforms.to_clip.apply(&v.pos), v.attrib)
                },
                |fragment: Frag<Normal<CHANNELS, LIGHTS, EXPONENT>>, uniforms: &Uniforms<CHANNELS, LIGHTS, EXPONENT>| {
                    colour(uniforms.surface.levels(fragment.var.normalize_approx()))
                },
            ),
        ),
    }
}

fn with_shader<'s, V, S, const CHANNELS: usize, const LIGHTS: usize, const EXPONENT: u16>(scene: &'s Scene, shader: S) -> Drawing<'s>
where
    V: Vary,
    S: for<'u> Shader<Corner<CHANNELS, LIGHTS, EXPONENT>, V, &'u Uniforms<CHANNELS, LIGHTS, EXPONENT>> + 's,
{
    let vertices: Vec<Corner<CHANNELS, LIGHTS, EXPONENT>> =
        scene.positions.iter().zip(&scene.normals).map(|(&[x, y, z], &normal)| vertex(pt3(x, y, z), normal.into())).collect();
    // On its screen y runs down, so that they turn the other way.
    let triangles: Vec<Tri<usize>> = scene.faces.iter().map(|&[a, b, c]| tri(a, c, b)).collect();
    let uniforms = Uniforms { to_clip: to_view(scene).then(&to_clip(scene)), surface: Surface::new(scene) };
    let size = Dims(WIDTH as u32, HEIGHT as u32);
    let to_screen: Mat4<Ndc, Screen> = viewport(pt2(0, 0)..pt2(size.0, size.1));
    let context = Context::default();
    // Of 1 / z: infinitely far.
    let mut depth = vec![0.0f32; WIDTH * HEIGHT];
    Box::new(move |picture| {
        let mut target = Framebuf {
            color_buf: Colorbuf { buf: MutSlice2::new(size, size.0, picture), fmt: Rgb565 },
            depth_buf: MutSlice2::new(size, size.0, &mut depth),
        };
        render(&triangles, &vertices, &shader, &uniforms, to_screen, &mut target, &context);
    })
}

/// The transformation to retrofire's view space, where y runs down, and z away from the eye.
fn to_view(scene: &Scene) -> Mat4<Model, View> {
    let [x, y, z] = scene.eye;
    [[1.0, 0.0, 0.0, -x], [0.0, -1.0, 0.0, y], [0.0, 0.0, -1.0, z], [0.0, 0.0, 0.0, 1.0]].into()
}

fn to_clip(scene: &Scene) -> ProjMat3<View> {
    let aspect = WIDTH as f32 / HEIGHT as f32;
    perspective(scene.focal / aspect, aspect, scene.near..1000.0)
}
