//! Lights as a program makes them: x to the right, y up, z to the viewer.

use crate::{
    format::{Gain, Length, UNIT},
    math::vector::normalise,
    scene::{SceneError, in_range},
    stream::record::{DIRECTIONAL, EYE_SPACE, Light, OBJECT_SPACE, POINT},
};
use fixed::{traits::ToFixed, types::I32F32};

/// Constructors of lights. Numbers are `f32` or any type of the crate [`fixed`]; with fixed-point numbers a program contains no
/// floating-point code.
///
/// ```
/// use microphong::{Light, SceneError, fixed::types::I18F14};
///
/// # fn main() -> Result<(), SceneError> {
/// // White, from the upper left, in front of the object; and an orange one nearby, which goes where the camera goes.
/// let key = Light::directional([-0.4, 0.6, 0.7], [1.0; 3])?;
/// let near = Light::near([1, 0, -2].map(I18F14::from_num), [1.0, 0.6, 0.2])?.with_camera();
/// assert!(Light::directional([0.0; 3], [1.0; 3]).is_err());
/// # Ok(())
/// # }
/// ```
impl Light {
    /// Creates a directional light, which is infinitely far away and stays fixed in the world.
    ///
    /// `towards` is the direction from the objects to the light, of any length but 0. Its axes are those of the world: x to the right, y
    /// up, z to the viewer. `colour` is red, green and blue, each 0 to 2; 1 is full intensity.
    ///
    /// # Errors
    /// Returns [`SceneError::Direction`] if the direction is zero, not finite or too long, and [`SceneError::Range`] if a colour is out of
    /// range.
    pub fn directional<V: ToFixed, C: ToFixed>(towards: [V; 3], colour: [C; 3]) -> Result<Self, SceneError> {
        let mut vector = [0i64; 3];
        for (bits, number) in vector.iter_mut().zip(towards) {
            *bits = number.checked_to_fixed::<I32F32>().ok_or(SceneError::Direction)?.to_bits();
        }
        // Components of at most 30 bits.
        let largest = vector.iter().fold(0, |largest, c| largest | c.unsigned_abs());
        let less = 34u32.saturating_sub(largest.leading_zeros());
        let unit = normalise(vector.map(|c| (c >> less) as i32));
        if unit == [0; 3] {
            return Err(SceneError::Direction);
        }
        let rounded = |c: i32| Length::from_bits(((c >> (29 - UNIT)) + 1) >> 1);
        checked(Self::new(DIRECTIONAL, OBJECT_SPACE, unit.map(rounded), gains(colour)?))
    }

    /// Creates a point light at `position`, which stays fixed in the world. Its light does not weaken with distance. It takes more time to
    /// draw than a directional light.
    ///
    /// `position` is in world units, each coordinate -16 to 16. `colour` is red, green and blue, each 0 to 2; 1 is full intensity.
    ///
    /// # Errors
    /// Returns [`SceneError::Position`] or [`SceneError::Range`] if a number is not finite or out of range.
    pub fn near<V: ToFixed, C: ToFixed>(position: [V; 3], colour: [C; 3]) -> Result<Self, SceneError> {
        let mut place = [Length::ZERO; 3];
        for (length, number) in place.iter_mut().zip(position) {
            *length = number.checked_to_fixed().ok_or(SceneError::Position)?;
        }
        checked(Self::new(POINT, OBJECT_SPACE, place, gains(colour)?))
    }

    /// Attaches the light to the camera, like a lamp on a helmet. The light's direction or position then counts in the axes of the picture,
    /// from the eye: x to the right, y up, z to the viewer. So a position in front of the camera has a negative z.
    #[must_use]
    pub fn with_camera(self) -> Self {
        let [x, y, z] = self.vector;
        // Eye space has z away from the viewer.
        let z = if self.space == EYE_SPACE { z } else { z.saturating_neg() };
        Self { vector: [x, y, z], space: EYE_SPACE, ..self }
    }
}

/// The light, if [`crate::Scene::set_lights`] will take it.
fn checked(light: Light) -> Result<Light, SceneError> {
    in_range(light.fault()).map(|()| light)
}

fn gains<C: ToFixed>(colour: [C; 3]) -> Result<[Gain; 3], SceneError> {
    let mut gains = [Gain::ZERO; 3];
    for (gain, number) in gains.iter_mut().zip(colour) {
        *gain = number.checked_to_fixed().ok_or(SceneError::Range { name: "light colour" })?;
    }
    Ok(gains)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Directions of any length are unit vectors, to half a unit of the last place.
        #[test]
        fn directions_are_normalised(towards in [(); 3].map(|()| -1.0e3f32..1.0e3), exponent in -14i32..20) {
            let towards = towards.map(|c| c * 2f32.powi(exponent));
            let length = towards.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            prop_assume!(length > 1e-2);
            let light = Light::directional(towards, [1.0f32; 3]).unwrap();
            for (found, exact) in light.vector.map(Length::from_bits).into_iter().zip(towards) {
                let error = f64::from(found) - f64::from(exact) / length;
                prop_assert!(error.abs() <= 0.51 / f64::from(1 << UNIT), "{light:?}");
            }
        }
    }

    #[test]
    fn what_is_no_direction_is_refused() {
        for towards in [[0.0, 0.0, 0.0], [f32::NAN, 0.0, 1.0], [0.0, f32::INFINITY, 1.0], [1e30, 0.0, 0.0]] {
            assert_eq!(Light::directional(towards, [1; 3]), Err(SceneError::Direction), "{towards:?}");
        }
        assert_eq!(Light::near([f32::NAN, 0.0, 0.0], [1; 3]), Err(SceneError::Position));
        for colour in [[-1, 0, 0], [3, 0, 0], [9, 0, 0]] {
            assert_eq!(Light::near([0; 3], colour), Err(SceneError::Range { name: "light colour" }), "{colour:?}");
        }
        assert_eq!(Light::near([0, 0, 100], [1; 3]), Err(SceneError::Range { name: "light vector" }));
        assert!(Light::near([0, 0, 16], [2; 3]).is_ok());
    }

    #[test]
    fn lights_with_the_camera_have_z_away_from_the_viewer() {
        let light = Light::directional([0, 0, 5], [1; 3]).unwrap();
        assert_eq!((light.vector.map(|c| f64::from(Length::from_bits(c))), light.space), ([0.0, 0.0, 1.0], OBJECT_SPACE));
        let moving = light.with_camera();
        assert_eq!((moving.vector.map(|c| f64::from(Length::from_bits(c))), moving.space), ([0.0, 0.0, -1.0], EYE_SPACE));
        assert_eq!(moving.with_camera(), moving);
    }
}
