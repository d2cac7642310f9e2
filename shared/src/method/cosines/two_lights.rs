//! Two constant lights on a triangle in three channels, for methods' loops.

use crate::{
    lighting::{constant_lights::TwoLightsRgb, material_tables::MaterialTables},
    method::{CornerCosines, TriangleSetup},
    pixel::Pixel,
};

/// Two lights on a triangle. If one of them has a highlight there that can be seen, it is the first.
pub(super) struct TwoLights<'a, C> {
    /// Colours that the material reflects of the lights.
    pub(super) colours: TwoLightsRgb<'a, C>,
    /// Cosines of the lights at the corners.
    pub(super) cosines: [CornerCosines; 2],
    /// Number of lights that have a highlight on the triangle.
    pub(super) highlights: u32,
}

impl<'a, C: Pixel> TwoLights<'a, C> {
    /// The lights on the triangle `setup`, whose vertices have [`crate::method::VertexLight::Cosines`]; `None` unless there are two, with loops for
    /// them.
    #[inline]
    pub(super) fn on(setup: &TriangleSetup<'_>, tables: MaterialTables<'a, C>) -> Option<Self> {
        let [forth, back] = tables.two_lights_rgb()?;
        let [one, two] = setup.corners_of_two_lights();
        let highlit = |[_, half]: &CornerCosines| !setup.leaves_out_highlight(tables.reflectance, half);
        Some(match (highlit(&one), highlit(&two)) {
            (false, true) => Self { colours: back, cosines: [two, one], highlights: 1 },
            (first, second) => Self { colours: forth, cosines: [one, two], highlights: u32::from(first) + u32::from(second) },
        })
    }
}
