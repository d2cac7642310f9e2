//! [retrofire](https://crates.io/crates/retrofire): vertex and fragment shaders, always perspective-correct, depth in `f32`.

use crate::{
    HEIGHT, Picture, WIDTH,
    scene::{Scene, Surface},
};
use alloc::{vec, vec::Vec};
use retrofire_core::{
    geom::{Tri, Vertex3, tri, vertex},
    math::{Color3f, Mat4, ProjMat3, Vary, Vec3, perspective, pt2, pt3, viewport},
    render::{Colorbuf, Context, Frag, Framebuf, Model, Ndc, Screen, Shader, View, render, shader},
    util::{Dims, MutSlice2, pixfmt::Rgb565},
};

type Normal = Vec3<Model>;

/// What its shaders know of a scene.
struct Uniforms {
    to_clip: ProjMat3<Model>,
    towards: Normal,
    half: Normal,
    surface: Surface,
}

impl Uniforms {
    /// Its own type of colours, 1 is full.
    #[inline]
    fn colour(&self, normal: Normal) -> Color3f {
        Color3f::new([self.surface.shade(normal.dot(&self.towards), normal.dot(&self.half)); 3])
    }
}

/// Light is worked out at the vertices.
pub(crate) fn gouraud(scene: &Scene) -> impl FnMut(&mut Picture) {
    let shader = shader::new(
        |v: Vertex3<Normal>, uniforms: &Uniforms| vertex(uniforms.to_clip.apply(&v.pos), uniforms.colour(v.attrib)),
        |fragment: Frag<Color3f>, _: &Uniforms| fragment.var.to_color4(),
    );
    drawing(scene, shader)
}

/// Normals are interpolated, and light is worked out at each pixel, with the cheaper of its two ways to normalise.
pub(crate) fn phong(scene: &Scene) -> impl FnMut(&mut Picture) {
    let shader = shader::new(
        |v: Vertex3<Normal>, uniforms: &Uniforms| vertex(uniforms.to_clip.apply(&v.pos), v.attrib),
        |fragment: Frag<Normal>, uniforms: &Uniforms| uniforms.colour(fragment.var.normalize_approx()).to_color4(),
    );
    drawing(scene, shader)
}

fn drawing<V, S>(scene: &Scene, shader: S) -> impl FnMut(&mut Picture)
where
    V: Vary,
    S: for<'u> Shader<Vertex3<Normal>, V, &'u Uniforms>,
{
    let vertices: Vec<Vertex3<Normal>> =
        scene.positions.iter().zip(&scene.normals).map(|(&[x, y, z], &normal)| vertex(pt3(x, y, z), normal.into())).collect();
    // On its screen y runs down, so that they turn the other way.
    let triangles: Vec<Tri<usize>> = scene.faces.iter().map(|&[a, b, c]| tri(a, c, b)).collect();
    let uniforms = Uniforms {
        to_clip: to_view(scene).then(&to_clip(scene)),
        towards: scene.towards.into(),
        half: scene.half.into(),
        surface: scene.surface,
    };
    let size = Dims(WIDTH as u32, HEIGHT as u32);
    let to_screen: Mat4<Ndc, Screen> = viewport(pt2(0, 0)..pt2(size.0, size.1));
    let context = Context::default();
    // Of 1 / z: infinitely far.
    let mut depth = vec![0.0f32; WIDTH * HEIGHT];
    move |picture| {
        let mut target = Framebuf {
            color_buf: Colorbuf { buf: MutSlice2::new(size, size.0, picture), fmt: Rgb565 },
            depth_buf: MutSlice2::new(size, size.0, &mut depth),
        };
        render(&triangles, &vertices, &shader, &uniforms, to_screen, &mut target, &context);
    }
}

/// Its screen's y runs down.
fn to_view(scene: &Scene) -> Mat4<Model, View> {
    let [right, up, away] = scene.rotation;
    let [x, y, z] = scene.translation;
    let row = |[a, b, c]: [f32; 3], d| [a, b, c, d];
    [row(right, x), row(up.map(|c| -c), -y), row(away, z), [0.0, 0.0, 0.0, 1.0]].into()
}

fn to_clip(scene: &Scene) -> ProjMat3<View> {
    let aspect = WIDTH as f32 / HEIGHT as f32;
    perspective(scene.focal / aspect, aspect, scene.near..100.0)
}
