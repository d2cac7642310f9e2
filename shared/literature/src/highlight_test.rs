//! Phong shading on triangles that may have a highlight, Gouraud shading on others.
//!
//! N·H is linear under constant light, and no interpolated normal is shorter than r. So N·H over |N| is at most the largest of the corners' values
//! over r. Where this stays below the cosine whose power counts as 0, for each light, only diffuse light is left, and it changes slowly. Near lights
//! have no such bound at a fair price, so all triangles are drawn by Phong shading.
//!
//! Cost: three comparisons a triangle and light, and then the cost of [`microphong::method::levels::gouraud`] or
//! [`microphong::method::cosines::phong`]. Not continuous where the two meet. Error against Phong: Gouraud's error of diffuse light. Domain: any
//! lights.

use microphong::method::{
    Canvas, Facts, Highlight, HighlightField, LEVEL_RANGE, Method, Shading, Source, TriangleSetup, VertexLight, cosine,
    cosines::phong::Phong, levels::gouraud::Gouraud,
};

static FACTS: Facts = Facts {
    name: "highlight-test",
    id: 7,
    source: "Szirmay-Kalos et al. 2000",
    vertex_light: VertexLight::CosinesOrLevels,
    highlight: Highlight::Half,
    highlight_levels: true,
    highlight_field: HighlightField::Quadratic,
    near_lights: true,
    perspective: true,
};

/// Phong shading where a highlight can be.
pub struct HighlightTest;

impl Method for HighlightTest {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    if !has_no_highlight(setup, shading) {
        return Phong.shade(setup, shading, canvas);
    }
    if !shading.vertices_have_cosines() {
        return Gouraud.shade(setup, shading, canvas);
    }
    let levels = setup.corners.map(|corner| shading.reflectance.one_light([corner.light[0], corner.light[1]]));
    shading.draw_levels::<3, LEVEL_RANGE>(setup, levels, canvas)
}

/// No light's highlight reaches a visible level anywhere on the triangle.
fn has_no_highlight(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> bool {
    if shading.vertices_have_cosines() {
        return setup.has_no_highlight(&shading.reflectance);
    }
    let limit = setup.highlight_threshold(&shading.reflectance);
    let corners = setup.corner_nodes();
    shading.lighting.is_constant()
        && shading
            .lighting
            .sources()
            .iter()
            .filter(|source| !source.is_sky())
            .filter_map(Source::directional)
            .all(|&[_, half]| corners.iter().all(|corner| cosine(corner.normal, half) < limit))
}
