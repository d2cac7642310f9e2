//! Flat shading: one colour per triangle, lit at its centroid with the plane's normal.
//!
//! Cost: nothing per pixel; one evaluation of the lights per triangle. Not continuous across edges.

use crate::{
    format::UNIT,
    interpolate::Constant,
    lighting::{
        albedo::{Albedo, IfColoured, Parts},
        lights::{MeanNormal, point, vertex_cosine},
        material_tables::MaterialTables,
    },
    math::vector::{add, wide},
    method::{Facts, Loops, Method, Shading, Style, TriangleSetup, VertexLight, draw_uniform, node::Node, texture},
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas, pixel_shader::Solid},
    stream::record::{Triangle, Vertex},
};

static FACTS: Facts = Facts { name: "flat", id: 0, source: "", vertex_light: VertexLight::None, ..Facts::OWN };

/// Flat shading.
pub struct Flat;

impl Method for Flat {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn needs_highlight_tables(&self) -> bool {
        false
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        if setup.has_texture() {
            return setup.draw_parts([parts(setup, shading); 3], canvas);
        }
        draw_uniform(setup, levels(setup.triangle, setup.vertices, setup.colour_at([1; 3]), shading), canvas)
    }
}

impl Loops for Flat {
    const DECLINES: bool = false;
    fn take(style: Style) -> bool {
        style.is_plain
    }

    #[inline(always)]
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        if setup.has_texture() {
            return texture::fill(setup, shading, &[parts(setup, shading); 3], tables, band);
        }
        let colour = match shading.constant {
            Some([towards, half]) => {
                let normal = wide(setup.triangle.normal);
                tables.one_light([vertex_cosine(normal, towards), vertex_cosine(normal, half)])
            }
            None => tables.colour(levels(setup.triangle, setup.vertices, setup.colour_at([1; 3]), shading)),
        };
        Some(setup.fill(|| Constant, Solid::face(colour), band))
    }
}

/// Levels at the centroid with the plane's normal.
#[inline(never)]
fn levels(triangle: &Triangle, vertices: &[Vertex], albedo: IfColoured<Option<Albedo>>, shading: &Shading<'_>) -> [i32; 3] {
    let normal = wide(triangle.normal);
    if shading.lighting.is_constant() {
        return shading.constant_levels(&MeanNormal::at(normal), albedo);
    }
    shading.levels(&Node { albedo, ..centroid(triangle, vertices, normal) })
}

/// The parts of light at the centroid with the plane's normal.
#[inline(never)]
fn parts(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Parts {
    let normal = wide(setup.triangle.normal);
    if shading.lighting.is_constant() {
        return shading.reflectance.constant_parts(shading.lighting.sources(), &MeanNormal::at(normal));
    }
    shading.parts(&centroid(setup.triangle, setup.vertices, normal))
}

/// The triangle's centroid, and the `normal` of its plane (Q2.14).
fn centroid(triangle: &Triangle, vertices: &[Vertex], normal: [i32; 3]) -> Node {
    // A checked stream has all vertices.
    let [a, b, c] = triangle.corners.map(|corner| vertices.get(usize::from(corner)).unwrap_or(&Vertex::ZERO));
    let sum = add(point(a.position), add(point(b.position), point(c.position)));
    Node { position: sum.map(|c| c / 3), normal: normal.map(|c| c << (30 - UNIT)), albedo: Node::NO_COLOUR }
}
