//! The cubic through ten points (Vlasic 2002): lit at the corners, at the thirds of the edges and at the centroid.
//!
//! Cost: three additions of 64 bits a pixel and channel; ten points to light. Continuous: both neighbours light the thirds of their edge alike. It
//! has a third to a half of the error of [`microphong::method::levels::six_point`]. Domain: any lights.

pub mod field;
pub mod fit;
pub mod terms;

use crate::nodes::third;
use field::TenNodes;
use microphong::{
    format::{BIAS, LEVEL, WALK},
    method::{Area, Canvas, Facts, Highlight, HighlightField, Method, Shading, TriangleSetup, VertexLight, Walked},
};

static FACTS: Facts = Facts {
    name: "cubic",
    id: 15,
    source: "Vlasic 2002",
    vertex_light: VertexLight::Levels,
    highlight: Highlight::Half,
    highlight_levels: false,
    highlight_field: HighlightField::Level,
    near_lights: true,
    perspective: true,
};

/// Ten-point shading.
pub struct Cubic;

impl Method for Cubic {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        draw(setup, shading, canvas)
    }
}

fn draw(setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
    let [a, b, c] = setup.levels();
    let thirds = [[2, 1, 0], [1, 2, 0], [0, 2, 1], [0, 1, 2], [1, 0, 2], [2, 0, 1], [1, 1, 1]];
    let [ab, ba, bc, cb, ca, ac, middle] = thirds.map(|weights| shading.levels(&third(setup, weights, 0)));
    let nodes = [a, b, c, ab, ba, bc, cb, ca, ac, middle];
    let (extra, bias) = (WALK - LEVEL, BIAS << WALK);
    if shading.reflectance.three_channels() {
        let values = [nodes.map(|[red, ..]| red), nodes.map(|[_, green, _]| green), nodes.map(|[.., blue]| blue)];
        setup.draw(&TenNodes { values, extra, bias: [bias; 3] }, Walked, canvas)
    } else {
        setup.draw(&TenNodes { values: [nodes.map(|[level, ..]| level)], extra, bias: [bias] }, Walked, canvas)
    }
}
