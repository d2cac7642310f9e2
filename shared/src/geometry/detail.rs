//! Levels of detail: the largest distance of a coarser level from its mesh that pictures of a size do not show.
//!
//! Let a point of one surface lie within `e` of a point of the other, both in the ball of the stream's radius about the origin, so that
//! neither is nearer to the eye than the depth `z`. On the way from one to the other the picture of the point moves by at most
//! `f √(1 + s²) / z` pixels a unit, where `f` is the distance of the eye from the viewport in pixels, and `s` the slope under which the
//! point is seen. In a viewport whose diagonal is `d`, `s` is at most `d / 2f`, and `√(1 + s²)` at most `1 + s²/2`: hardly more for any
//! but the widest views. With `g = 2 f` that is less than half a pixel if
//!
//! `e < 2 z / (2 g + d²/g)`.
//!
//! Under parallel rays a unit is `f` pixels at all depths, and the same formula holds with `z` one unit and `d` zero.
//!
//! Outlines therefore differ by less than half a pixel, but for the rounding of corners to 1/16 pixel. How light is interpolated on larger
//! triangles is not bounded.

use crate::{
    arch::quotient::long,
    format::{GeometricError, UNIT},
    stream::record::{Camera, Header, PERSPECTIVE},
};
use embedded_graphics_core::geometry::Size;

/// Largest distance of a level from its mesh, rounded down, that is less than half a pixel in a viewport of `size` pixels. The mesh lies in a ball of
/// `radius`, whose centre is at the depth `depth`, both Q18.14. A margin of 1/32 is left for a rotation that is rounded and stretches.
///
/// Domain: a checked camera, sides up to [`crate::MAX_SIDE`]. Error: at most 4 % too little in views of up to 53 degrees along the diagonal, 9 % in
/// views of up to 90 degrees, the margin included (tests::no_less_than_need_be). Source: the formula above.
pub fn tolerance(camera: &Camera, depth: i32, radius: u32, size: Size) -> GeometricError {
    let (width, height) = (size.width, size.height);
    let (depth, square) = if camera.projection == PERSPECTIVE {
        let radius = radius as i32;
        let nearest = depth.wrapping_sub(radius + (radius >> 5) + 1);
        (nearest.max(camera.near), width.wrapping_mul(width).wrapping_add(height.wrapping_mul(height)))
    } else {
        (1 << UNIT, 0)
    };
    // 2 f, Q.16, below 2^31, and the square of the diagonal over it, rounded up. 31/16 units of depth are two without what is spared.
    let focal = width.min(height).wrapping_mul(camera.focal);
    let beside = long(u64::from(square) << 32, focal.into()) + 1;
    let error = long(u64::from(depth.unsigned_abs() * 31) << 12, 2 * u64::from(focal) + beside);
    GeometricError::from_bits(error.min(u16::MAX.into()) as u16)
}

/// The [`tolerance`] for the whole stream, as its camera sees it in all frames.
pub fn stream_tolerance(header: &Header, size: Size) -> GeometricError {
    tolerance(&header.camera, header.camera.translation[2], header.radius.into(), size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        error::MAX_SIDE,
        format::{Focal, Length, Radius, Rotation},
        stream::record::ORTHOGRAPHIC,
    };
    use proptest::prelude::*;
    use zerocopy::FromZeros;

    /// A header whose camera looks along z, as far as matters here.
    fn header(projection: u8, [distance, near, radius, focal]: [f64; 4]) -> Header {
        let length = |number: f64| Length::from_num(number).to_bits();
        let one = Rotation::ONE.to_bits();
        let camera = Camera {
            projection,
            rotation: [[one, 0, 0], [0, one, 0], [0, 0, -one]],
            translation: [0, 0, length(distance)],
            focal: Focal::from_num(focal).to_bits(),
            near: length(near),
            far: length(32.0),
            ..Camera::new_zeroed()
        };
        Header { camera, radius: Radius::from_num(radius).to_bits(), ..Header::new_zeroed() }
    }

    fn of(header: &Header, [width, height]: [u32; 2]) -> GeometricError {
        stream_tolerance(header, Size::new(width, height))
    }

    /// The distance of the eye from the viewport, and half of its diagonal, in pixels.
    fn pixels(size: [u32; 2], focal: f64) -> [f64; 2] {
        let [width, height] = size.map(f64::from);
        [focal * width.min(height) / 2.0, width.hypot(height) / 2.0]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

        /// A point of a mesh and a point as far from it as a level of detail may lie are projected to points less than half a pixel apart, if one of
        /// them is seen.
        #[test]
        fn less_than_half_a_pixel(
            perspective in any::<bool>(),
            (distance, near, radius, focal) in (0.1f64..15.9, 0.02f64..4.0, 0.1f64..3.9, 0.07f64..15.0),
            size in prop::array::uniform2(1..=MAX_SIDE),
            (place, depth) in (prop::array::uniform2(-1.0f64..1.0), 0.0f64..1.0),
            way in prop::array::uniform3(-1.0f64..1.0),
        ) {
            let projection = if perspective { PERSPECTIVE } else { ORTHOGRAPHIC };
            let header = header(projection, [distance, near, radius, focal]);
            let error = f64::from(of(&header, size));
            let [f, _] = pixels(size, focal);
            // Any point that is seen, at the depth of the ball.
            let nearest = (distance - radius).max(near);
            let z = nearest + depth * depth * depth * 2.0 * radius;
            let z = if perspective { z } else { 1.0 };
            let [x, y] = [0, 1].map(|k| place[k] * f64::from(size[k]) / 2.0 / f * z);
            let length = way.iter().map(|c| c * c).sum::<f64>().sqrt().max(1e-9);
            let [dx, dy, dz] = way.map(|c| c / length * error);
            let other = if perspective { (z + dz).max(nearest) } else { 1.0 };
            let apart = (((x + dx) / other - x / z) * f).hypot(((y + dy) / other - y / z) * f);
            prop_assert!(apart < 0.5, "{apart} pixels by {error}");
        }

        #[test]
        fn no_less_than_need_be(
            perspective in any::<bool>(),
            (distance, near, radius, focal) in (0.1f64..15.9, 0.02f64..4.0, 0.1f64..3.9, 0.5f64..15.0),
            size in prop::array::uniform2(1..=MAX_SIDE),
        ) {
            let projection = if perspective { PERSPECTIVE } else { ORTHOGRAPHIC };
            let header = header(projection, [distance, near, radius, focal]);
            let error = f64::from(of(&header, size));
            let [f, h] = pixels(size, focal);
            let (z, slope) = if perspective { ((distance - radius * 33.0 / 32.0).max(near), h / f) } else { (1.0, 0.0) };
            let exact = z / (2.0 * f * slope.hypot(1.0));
            let share = if slope < 0.5 { 0.96 } else { 0.91 };
            // Formats are rounded by a few of their steps.
            let step = f64::from(GeometricError::DELTA);
            let least = ((z - 3.0 * step) / z * share * exact - step).min(4.0 - step);
            prop_assert!(slope > 1.0 || error >= least, "{error} of {exact}");
        }
    }

    #[test]
    fn extremes_of_the_domain() {
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            for [distance, focal] in [[-16.0, 1.0 / 16.0], [-16.0, 16.0], [16.0, 1.0 / 16.0], [16.0, 16.0]] {
                for size in [[1, 1], [1, MAX_SIDE], [MAX_SIDE, MAX_SIDE]] {
                    let header = header(projection, [distance, 1.0 / 64.0, 3.9, focal]);
                    let error = f64::from(of(&header, size));
                    let [f, h] = pixels(size, focal);
                    let (z, slope) = if projection == PERSPECTIVE { ((distance - 3.9f64).max(1.0 / 64.0), h / f) } else { (1.0, 0.0) };
                    assert!(error < z / (2.0 * f * slope.hypot(1.0)));
                }
            }
        }
    }
}
