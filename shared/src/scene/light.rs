//! Lights as a program makes them: x to the right, y up, z to the viewer.

#[cfg(feature = "light-shapes")]
use crate::{
    format::{Angle, COSINE, Reach},
    scene::angle::sin_cos,
    stream::{MIN_RANGE, record::SKY},
};
use crate::{
    format::{Gain, Length, UNIT},
    math::vector::normalise,
    scene::{SceneError, error::in_format, in_range},
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
        checked(Self::new(DIRECTIONAL, OBJECT_SPACE, direction(towards)?.map(Length::from_bits), gains(colour)?))
    }

    /// Creates light from a half of the sky, whose middle is in the direction `up`. A surface that faces `up` gets all of it, one that faces away
    /// gets none, and light changes evenly in between. It makes no highlights. The arguments are those of [`Self::directional`].
    ///
    /// # Errors
    /// Returns the errors of [`Self::directional`].
    #[cfg(feature = "light-shapes")]
    pub fn sky<V: ToFixed, C: ToFixed>(up: [V; 3], colour: [C; 3]) -> Result<Self, SceneError> {
        Ok(Self { kind: SKY, ..Self::directional(up, colour)? })
    }

    /// Creates the two lights of a hemisphere light: from the `sky`, whose middle is in the direction `up`, and from the `ground` on the other side.
    /// Both are colours. A surface that faces sideways gets half of each.
    ///
    /// # Errors
    /// Returns the errors of [`Self::directional`].
    #[cfg(feature = "light-shapes")]
    pub fn hemisphere<V: ToFixed, C: ToFixed>(up: [V; 3], sky: [C; 3], ground: [C; 3]) -> Result<[Self; 2], SceneError> {
        let sky = Self::sky(up, sky)?;
        Ok([sky, Self { vector: sky.vector.map(|c| -c), colour: gains(ground)?.map(Gain::to_bits), ..sky }])
    }

    /// Creates a point light at `position`, which stays fixed in the world. Its light does not weaken with distance unless it has a range or a cone.
    /// It takes more time to draw than a directional light.
    ///
    /// `position` is in world units, each coordinate -16 to 16. `colour` is red, green and blue, each 0 to 2; 1 is full intensity.
    ///
    /// # Errors
    /// Returns [`SceneError::Position`] or [`SceneError::Range`] if a number is not finite or out of range.
    pub fn near<V: ToFixed, C: ToFixed>(position: [V; 3], colour: [C; 3]) -> Result<Self, SceneError> {
        checked(Self::new(POINT, OBJECT_SPACE, in_format(position, SceneError::Position)?, gains(colour)?))
    }

    /// Gives a point light a range, from 1/16 to less than 32 units of the world. At the distance d its light is (1 - d²/range²)² of what it is
    /// close to the light, and from the range on there is none.
    ///
    /// # Errors
    /// Returns [`SceneError::Range`] if the range is out of range, or the light is no point light.
    #[cfg(feature = "light-shapes")]
    pub fn with_range(self, range: impl ToFixed) -> Result<Self, SceneError> {
        let range = range.checked_to_fixed::<Reach>().filter(|range| range.to_bits() >= MIN_RANGE);
        let range = range.ok_or(SceneError::Range { name: "light range" })?.to_bits();
        checked(Self { range, ..self })
    }

    /// Gives a point light a cone, like a spotlight. `towards` is the direction in which it shines, of any length but 0, in the axes that the
    /// position counts in. `full` and `edge` are angles from this direction, as fractions of a turn of at most a half: light is full up to the first,
    /// and there is none from the second on.
    ///
    /// # Errors
    /// Returns [`SceneError::Direction`] if the direction is zero, not finite or too long, and [`SceneError::Range`] if the light is no point
    /// light, if `edge` is more than half a turn, or if the cosine of `edge` is not smaller than that of `full` by at least 1/16,384. Close to
    /// the axis this is about half a degree.
    ///
    /// ```
    /// use microphong::{Light, SceneError, format::Angle};
    ///
    /// # fn main() -> Result<(), SceneError> {
    /// // A spotlight above the object: light is full up to 15 degrees from straight down, and ends at 25 degrees.
    /// let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
    /// let spot = Light::near([0, 3, 0], [1, 1, 1])?.with_cone([0, -1, 0], degrees(15.0), degrees(25.0))?.with_range(6)?;
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(feature = "light-shapes")]
    pub fn with_cone<V: ToFixed>(self, towards: [V; 3], full: Angle, edge: Angle) -> Result<Self, SceneError> {
        let wrong = SceneError::Range { name: "light cone" };
        if full >= edge || edge > Angle::from_bits(1 << 31) {
            return Err(wrong);
        }
        let cosine = |angle| {
            let [_, cosine] = sin_cos(angle);
            ((cosine >> (COSINE - 1 - UNIT)) + 1) >> 1
        };
        let [x, y, z] = direction(towards)?.map(|c| c as i16);
        let axis = if self.space == EYE_SPACE { [x, y, -z] } else { [x, y, z] };
        let cone = [cosine(edge), cosine(full)].map(|c| c as i16);
        checked(Self { axis, cone, ..self })
    }

    /// Attaches the light to the camera, like a lamp on a helmet. The light's direction or position then counts in the axes of the picture,
    /// from the eye: x to the right, y up, z to the viewer. So a position in front of the camera has a negative z.
    #[must_use]
    pub fn with_camera(self) -> Self {
        let [x, y, z] = self.vector;
        let [along_x, along_y, along_z] = self.axis;
        // Eye space has z away from the viewer.
        let (z, along_z) = if self.space == EYE_SPACE { (z, along_z) } else { (z.saturating_neg(), along_z.saturating_neg()) };
        Self { vector: [x, y, z], space: EYE_SPACE, axis: [along_x, along_y, along_z], ..self }
    }
}

/// The unit vector in a direction of any length but zero, each component a [`Unit`](crate::format::Unit).
fn direction<V: ToFixed>(towards: [V; 3]) -> Result<[i32; 3], SceneError> {
    let vector = in_format(towards, SceneError::Direction)?.map(I32F32::to_bits);
    // Components of at most 30 bits.
    let largest = vector.iter().fold(0, |largest, c| largest | c.unsigned_abs());
    let less = 34u32.saturating_sub(largest.leading_zeros());
    let unit = normalise(vector.map(|c| (c >> less) as i32));
    if unit == [0; 3] {
        return Err(SceneError::Direction);
    }
    Ok(unit.map(|c| ((c >> (29 - UNIT)) + 1) >> 1))
}

/// The light, if [`crate::Scene::set_lights`] will take it.
fn checked(light: Light) -> Result<Light, SceneError> {
    in_range(light.fault()).map(|()| light)
}

fn gains<C: ToFixed>(colour: [C; 3]) -> Result<[Gain; 3], SceneError> {
    in_format(colour, SceneError::Range { name: "light colour" })
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

    #[cfg(feature = "light-shapes")]
    #[test]
    fn ranges_and_cones() {
        let degrees = |degrees: f32| Angle::from_num(degrees / 360.0);
        let (far, near) = (Light::directional([0, 0, 1], [1; 3]).unwrap(), Light::near([0, 3, 0], [1; 3]).unwrap());
        let spot = near.with_range(6).unwrap().with_cone([0, -7, 1], degrees(30.0), degrees(60.0)).unwrap();
        assert_eq!((f64::from(spot.range()), spot.cone), (6.0, [8192, 14189]));
        let axis = spot.axis.map(|c| f64::from(c) / 16_384.0);
        assert!(axis[0] == 0.0 && (axis[1] + 0.98995).abs() < 1e-4 && (axis[2] - 0.14142).abs() < 1e-4, "{axis:?}");
        // The axis turns with the position.
        assert_eq!(spot.with_camera().axis, [0, spot.axis[1], -spot.axis[2]]);
        assert_eq!(
            spot.with_camera(),
            near.with_camera().with_cone([0, -7, 1], degrees(30.0), degrees(60.0)).unwrap().with_range(6).unwrap()
        );
        let (range, cone) = (Err(SceneError::Range { name: "light range" }), Err(SceneError::Range { name: "light cone" }));
        for wrong in [0.0, 0.06, 32.0, -1.0, f32::NAN] {
            assert_eq!(near.with_range(wrong), range, "{wrong}");
        }
        assert_eq!(far.with_range(6), range);
        assert_eq!(near.with_cone([0, -1, 0], degrees(30.0), degrees(30.0)), cone);
        assert_eq!(near.with_cone([0, -1, 0], degrees(30.0), degrees(181.0)), cone);
        assert_eq!(near.with_cone([0, -1, 0], degrees(0.01), degrees(0.02)), cone);
        assert_eq!(near.with_cone([0; 3], degrees(30.0), degrees(60.0)), Err(SceneError::Direction));
        assert_eq!(far.with_cone([0, -1, 0], degrees(30.0), degrees(60.0)), cone);
        let [sky, ground] = Light::hemisphere([0, 2, 0], [0.5, 0.6, 1.0], [0.4, 0.3, 0.2]).unwrap();
        assert_eq!((sky.kind, sky.vector, ground.vector), (SKY, [0, 1 << 14, 0], [0, -1 << 14, 0]));
        assert_eq!(ground.colour().map(|gain| (10.0 * f64::from(gain)).round()), [4.0, 3.0, 2.0]);
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
