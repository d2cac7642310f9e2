//! Poses: rotation, position and scale of an object in the world.

use crate::{
    arch::product::product,
    format::{Angle, Length, ROTATION, Rotation, Scale},
    math::{
        rsqrt::rsqrt_wide,
        vector::{cross, dot, normalise, sub, zip},
    },
    scene::{
        angle::sin_cos,
        error::{SceneError, in_format},
    },
    stream::{
        self,
        record::{Key, MAX_POSITION},
    },
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Least scale of an object: 1/16.
pub const MIN_SCALE: Scale = Scale::from_bits(stream::MIN_SCALE);
/// Largest scale of an object: 8.
pub const MAX_SCALE: Scale = Scale::from_bits(stream::MAX_SCALE);

/// A pose: the rotation, position and scale of an object in the world. The object is first scaled, then rotated about its origin, then
/// moved.
///
/// The rotation is stored as a unit quaternion that each operation normalises again, so errors do not build up over many rotations. The
/// world is right-handed.
///
/// ```
/// use microphong::{Pose, SceneError, fixed::types::{I18F14, U0F32, U16F16}};
///
/// # fn main() -> Result<(), SceneError> {
/// // A quarter of a turn about x, half as large, one unit to the right. No floating point is compiled for it.
/// let quarter = U0F32::from_bits(1 << 30);
/// let [zero, one] = [0, 1].map(I18F14::from_num);
/// let lying = Pose::about([1, 0, 0], quarter)?.scaled(U16F16::from_bits(1 << 15))?.at([one, zero, zero])?;
/// // From what a sensor says.
/// let held = Pose::from_f32([0.9, 0.1, 0.0, 0.42], [0.0, 0.5, 0.0], 1.0)?;
/// # Ok(())
/// # }
/// ```
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Pose {
    /// Unit quaternion w, x, y, z, Q2.30.
    rotation: [i32; 4],
    /// [`Length`].
    position: [i32; 3],
    /// [`Scale`].
    scale: u32,
}

/// One, Q2.30.
const ONE: i32 = 1 << ROTATION;

/// Largest difference of the length of a [`Pose`]'s quaternion from 1: two units of Q2.30.
pub const QUATERNION_ERROR: f64 = 2.0 / (1u32 << 30) as f64;
/// Largest error of the rotation in one call of [`Pose::turned`], in radians. Errors of several calls add up to at most this much a call.
pub const STEP_ERROR: f64 = 1.0e-8;

impl Pose {
    /// The pose of an object at the origin, without rotation, at the size of its mesh.
    pub const IDENTITY: Self = Self { rotation: [ONE, 0, 0, 0], position: [0; 3], scale: 1 << 16 };

    /// Creates a pose at the origin with the rotation of the quaternion `[w, x, y, z]`, which need not be normalised.
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if all four numbers are zero.
    pub fn from_quaternion(quaternion: [Rotation; 4]) -> Result<Self, SceneError> {
        Self::rotated(quaternion.map(|c| c.to_bits().into()))
    }

    /// Creates a pose at the origin with the rotation of a 3x3 matrix, given by rows, which transforms vectors from object space to the
    /// world.
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if the matrix mirrors or is not orthonormal: the squared length of each row has to be within 1/256
    /// of 1, and the dot product of two rows within 1/256 of 0.
    pub fn from_matrix(rows: [[Rotation; 3]; 3]) -> Result<Self, SceneError> {
        let rows = rows.map(|row| row.map(Rotation::to_bits));
        let [x, y, z] = rows;
        let is = |product: i64, value: i64| (product - (value << (2 * ROTATION))).abs() <= 1 << (2 * ROTATION - 8);
        let handed = dot(cross(x, y).map(|c| (c >> ROTATION) as i32), z) > 0;
        let in_range = rows.as_flattened().iter().all(|c| c.abs() <= ONE + (ONE >> 8));
        if !(in_range
            && handed
            && [x, y, z].iter().all(|&row| is(dot(row, row), 1))
            && is(dot(x, y), 0)
            && is(dot(y, z), 0)
            && is(dot(z, x), 0))
        {
            return Err(SceneError::Rotation);
        }
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = rows.map(|row| row.map(i64::from));
        let one = i64::from(ONE);
        // Four times the square of each component times the quaternion is one of these; the longest is the most exact. Source: Shepperd
        // (1978).
        let candidates = [
            [one + xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, one + xx - yy - zz, xy + yx, zx + xz],
            [xz - zx, xy + yx, one - xx + yy - zz, yz + zy],
            [yx - xy, zx + xz, yz + zy, one - xx - yy + zz],
        ];
        // The first of several that are equally long is taken.
        let longest = candidates.into_iter().enumerate().rev().max_by_key(|(k, candidate)| candidate.get(*k).copied());
        Self::rotated(longest.map_or([0; 4], |(_, candidate)| candidate))
    }

    /// Creates a pose at the origin, rotated by `angle` (in turns, 0 to 1) about `axis`, which may have any length but zero. The object
    /// turns counter-clockwise as seen from the tip of the axis.
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if the axis is zero.
    pub fn about(axis: [i32; 3], angle: Angle) -> Result<Self, SceneError> {
        let [sin, cos] = sin_cos(Angle::from_bits(angle.to_bits() >> 1));
        let [x, y, z] = normalise(axis).map(|c| (i64::from(c) * i64::from(sin)) >> ROTATION);
        if axis == [0; 3] {
            return Err(SceneError::Rotation);
        }
        Self::rotated([cos.into(), x, y, z])
    }

    /// Creates a pose at the origin, rotated by Euler angles in turns. The object turns first by `roll` about z, then by `pitch` about x,
    /// then by `yaw` about y; all three are fixed axes of the world.
    #[must_use]
    pub fn from_euler(yaw: Angle, pitch: Angle, roll: Angle) -> Self {
        let about = |axis, angle| Self::about(axis, angle).unwrap_or(Self::IDENTITY);
        about([0, 0, 1], roll).turned(&about([1, 0, 0], pitch)).turned(&about([0, 1, 0], yaw))
    }

    /// Creates a pose at `position` whose z axis points to `target`, and whose y axis is as close to the direction `up` as possible. This
    /// suits objects that face something, and cameras ([`Scene::set_camera_pose`](crate::Scene::set_camera_pose)).
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if `position` equals `target`, or `up` is zero or parallel to the direction of the target. Returns
    /// [`SceneError::Position`] if a coordinate is more than 16 in size.
    pub fn looking_at(position: [Length; 3], target: [Length; 3], up: [Length; 3]) -> Result<Self, SceneError> {
        let from = Self::IDENTITY.at(position)?.position;
        let along = sub(Self::IDENTITY.at(target)?.position, from);
        let up = up.map(Length::to_bits);
        // Unit vectors, of which the product fits 32 bits as Q2.29.
        let across = |a: [i32; 3], b: [i32; 3]| cross(normalise(a), normalise(b)).map(|c| (c >> (ROTATION + 1)) as i32);
        let side = across(up, along);
        if side.iter().all(|c| c.unsigned_abs() < 1 << 16) {
            return Err(SceneError::Rotation);
        }
        let (x, z) = (normalise(side), normalise(along));
        let y = normalise(across(z, x));
        let rows = zip(zip(x, y, |x, y| (x, y)), z, |(x, y), z| [x, y, z].map(Rotation::from_bits));
        Self::from_matrix(rows)?.at(position)
    }

    /// Creates a pose from floating-point numbers, for example from a motion sensor: the quaternion `[w, x, y, z]`, which need not be
    /// normalised, the position in world units, each coordinate -16 to 16, and the scale, 1/16 to 8.
    ///
    /// # Errors
    /// Returns [`SceneError::Rotation`] if the quaternion is zero or one of its numbers is not finite or 2 or more in size. Returns
    /// [`SceneError::Position`] or [`SceneError::Scale`] if the position or the scale is out of range or not finite.
    pub fn from_f32(quaternion: [f32; 4], position: [f32; 3], scale: f32) -> Result<Self, SceneError> {
        let (quaternion, position) = (in_format(quaternion, SceneError::Rotation)?, in_format(position, SceneError::Position)?);
        let scale = Scale::checked_from_num(scale).ok_or(SceneError::Scale)?;
        Self::from_quaternion(quaternion)?.at(position)?.scaled(scale)
    }

    /// Returns a copy of this pose at another position, in world units.
    ///
    /// # Errors
    /// Returns [`SceneError::Position`] if a coordinate is more than 16 in size.
    pub fn at(self, position: [Length; 3]) -> Result<Self, SceneError> {
        let within = position.iter().all(|c| (-MAX_POSITION..=MAX_POSITION).contains(c));
        if within { Ok(Self { position: position.map(Length::to_bits), ..self }) } else { Err(SceneError::Position) }
    }

    /// Returns a copy of this pose with another scale, from 1/16 to 8, where 1 is the size of the mesh.
    ///
    /// # Errors
    /// Returns [`SceneError::Scale`] if the scale is out of this range.
    pub fn scaled(self, scale: Scale) -> Result<Self, SceneError> {
        if (MIN_SCALE..=MAX_SCALE).contains(&scale) { Ok(Self { scale: scale.to_bits(), ..self }) } else { Err(SceneError::Scale) }
    }

    /// Returns a copy of this pose, rotated further by the rotation of `other` about the axes of the world. Position and scale stay. Called
    /// once a frame with a small rotation, it makes an object spin; the result stays a rotation after any number of calls. Each call adds
    /// an error of at most 1e-8 radians.
    #[must_use]
    pub fn turned(self, other: &Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (other.rotation.map(i64::from), self.rotation.map(i64::from));
        let product =
            [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w];
        Self { rotation: put_back(product.map(|c| (c + (1 << (ROTATION - 1))) >> ROTATION)), ..self }
    }

    /// Interpolates from this pose to another by `share / 2^16`: positions and scales linearly, rotations the shorter way round, in
    /// constant time. Source: Shoemake (1985), with the chord in place of the arc.
    pub(crate) fn towards(&self, other: &Self, share: i64) -> Self {
        let mean = |a: i32, b: i32| (i64::from(a) + (((i64::from(b) - i64::from(a)) * share) >> 16)) as i32;
        let (from, to) = (self.rotation, other.rotation);
        let cosine: i64 = from.iter().zip(to).map(|(&a, b)| i64::from(a) * i64::from(b)).sum();
        let to = if cosine < 0 { to.map(|c| -c) } else { to };
        let ([a, b, c, d], [w, x, y, z]) = (from, to);
        let rotation = unit([mean(a, w), mean(b, x), mean(c, y), mean(d, z)].map(i64::from)).unwrap_or(from);
        let scale = mean(self.scale as i32, other.scale as i32) as u32;
        Self { rotation, position: zip(self.position, other.position, mean), scale }
    }

    /// The pose of a key.
    pub(crate) fn of_key(key: &Key) -> Self {
        let rotation = unit(key.rotation.map(i64::from)).unwrap_or(Self::IDENTITY.rotation);
        Self { rotation, position: key.position, scale: key.scale }
    }

    fn rotated(quaternion: [i64; 4]) -> Result<Self, SceneError> {
        unit(quaternion).map(|rotation| Self { rotation, ..Self::IDENTITY }).ok_or(SceneError::Rotation)
    }

    /// Returns the rotation as a unit quaternion `[w, x, y, z]`.
    #[must_use]
    pub fn quaternion(&self) -> [Rotation; 4] {
        self.rotation.map(Rotation::from_bits)
    }

    /// Returns the position of the object's origin in the world, in world units.
    #[must_use]
    pub fn position(&self) -> [Length; 3] {
        self.position.map(Length::from_bits)
    }

    /// Returns the scale of the object, where 1 is the size of its mesh.
    #[must_use]
    pub fn scale(&self) -> Scale {
        Scale::from_bits(self.scale)
    }

    /// Rows of the rotation from object space to the world, Q2.30: orthonormal to a few units of the last place, by which entries may be above
    /// one.
    pub(crate) fn matrix(&self) -> [[i32; 3]; 3] {
        let [w, x, y, z] = self.rotation;
        // Twice the products, rounded: at most 2^31 + 8 in size, by [`QUATERNION_ERROR`], and 2^30 + 8 where they are taken from one.
        let twice = |sum: i64| ((sum + (1 << (ROTATION - 2))) >> (ROTATION - 1)) as i32;
        let [xx, yy, zz] = [product(x, x), product(y, y), product(z, z)];
        let [xy, yz, zx] = [product(x, y), product(y, z), product(z, x)];
        let [wx, wy, wz] = [product(w, x), product(w, y), product(w, z)];
        let along = |sum| ONE.wrapping_sub(twice(sum));
        [
            [along(yy + zz), twice(xy - wz), twice(zx + wy)],
            [twice(xy + wz), along(xx + zz), twice(yz - wx)],
            [twice(zx - wy), twice(yz + wx), along(xx + yy)],
        ]
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// The unit quaternion along another one; `None` if that is zero.
fn unit(quaternion: [i64; 4]) -> Option<[i32; 4]> {
    let largest = quaternion.iter().fold(0, |m, c| m | c.unsigned_abs());
    if largest == 0 {
        return None;
    }
    // Components below 2^30 in size: four squares fit 62 bits.
    let bits = 64 - largest.leading_zeros();
    let quaternion = quaternion.map(|c| if bits > 30 { c >> ((bits - 30) & 63) } else { c << ((30 - bits) & 63) });
    let (mantissa, exponent) = rsqrt_wide(quaternion.iter().map(|c| c * c).sum::<i64>() as u64);
    let right = exponent.saturating_sub(ROTATION) & 63;
    Some(put_back(quaternion.map(|c| (c * i64::from(mantissa)) >> right)))
}

/// A quaternion, Q2.30, that is a unit one to 2^-20, put back to the length 1 by a step of the method of Newton.
fn put_back(quaternion: [i64; 4]) -> [i32; 4] {
    let square: i64 = quaternion.iter().map(|c| c * c).sum::<i64>() >> ROTATION;
    let factor = (3 << ROTATION) - square;
    quaternion.map(|c| ((c * factor + (1 << ROTATION)) >> (ROTATION + 1)).clamp(-i64::from(ONE), ONE.into()) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;
    use proptest::prelude::*;

    fn length(pose: &Pose) -> f64 {
        pose.rotation.iter().map(|&c| (f64::from(c) / f64::from(ONE)).powi(2)).sum::<f64>().sqrt()
    }

    /// The largest difference between products of rows and those of an orthonormal matrix, in units of Q2.30.
    fn skew(pose: &Pose) -> f64 {
        let rows = pose.matrix().map(|row| row.map(|c| f64::from(c) / f64::from(ONE)));
        let mut worst = 0f64;
        for (i, a) in rows.iter().enumerate() {
            for (k, b) in rows.iter().enumerate() {
                let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                worst = worst.max((product - f64::from(u8::from(i == k))).abs());
            }
        }
        worst * f64::from(ONE)
    }

    fn quaternion() -> impl Strategy<Value = [i32; 4]> {
        prop::array::uniform4(-ONE..=ONE).prop_filter("zero", |q| *q != [0; 4])
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 5_000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn rotations_are_orthonormal(q in quaternion(), bits in 0u32..30) {
            let q = q.map(|c| c >> bits);
            prop_assume!(q != [0; 4]);
            let pose = Pose::from_quaternion(q.map(Rotation::from_bits)).unwrap();
            prop_assert!((length(&pose) - 1.0).abs() <= QUATERNION_ERROR, "{}", length(&pose));
            prop_assert!(skew(&pose) <= 12.0, "{}", skew(&pose));
        }

        /// A matrix is made of a quaternion, and the same quaternion of the matrix.
        #[test]
        fn matrices_lead_back(q in quaternion()) {
            let pose = Pose::from_quaternion(q.map(Rotation::from_bits)).unwrap();
            let back = Pose::from_matrix(pose.matrix().map(|row| row.map(Rotation::from_bits))).unwrap();
            let same: i64 = pose.rotation.iter().zip(back.rotation).map(|(&a, b)| i64::from(a) * i64::from(b)).sum();
            prop_assert!((same.abs() - (1 << (2 * ROTATION))).abs() < 16 << ROTATION, "{pose:?} {back:?}");
        }

        /// Rotated one after the other is rotated by the product.
        #[test]
        fn turned_is_the_product(a in quaternion(), b in quaternion()) {
            let [a, b] = [a, b].map(|q| Pose::from_quaternion(q.map(Rotation::from_bits)).unwrap());
            let both = a.turned(&b).matrix();
            let columns = crate::math::vector::transposed(a.matrix());
            let product = b.matrix().map(|row| columns.map(|column| (dot(row, column) >> ROTATION) as i32));
            for (exact, found) in product.iter().flatten().zip(both.iter().flatten()) {
                prop_assert!((exact - found).abs() <= 24, "{exact} {found}");
            }
        }

        /// The z axis points to the target, and the y axis upwards.
        #[test]
        fn looking_at_looks_there(at in prop::array::uniform3(-8.0f64..8.0), to in prop::array::uniform3(-8.0f64..8.0)) {
            let way = [to[0] - at[0], to[1] - at[1], to[2] - at[2]];
            let long = way.iter().map(|c| c * c).sum::<f64>().sqrt();
            prop_assume!(way[0].hypot(way[2]) > 0.05 * long && long > 0.1);
            let pose = Pose::looking_at(at.map(Length::from_num), to.map(Length::from_num), [Length::ZERO, Length::ONE, Length::ZERO]).unwrap();
            let [x, y, z] = pose.matrix();
            for (found, exact) in [x[2], y[2], z[2]].into_iter().zip(way) {
                prop_assert!((f64::from(found) / f64::from(ONE) - exact / long).abs() < 2e-3, "{pose:?}");
            }
            prop_assert!(y[1] > 0 && x[1].abs().max(z[1].abs()) <= ONE && y[0].abs() < ONE >> 9, "{pose:?}");
        }
    }

    /// However many steps there are, the rotation stays one, and is where it should be.
    #[test]
    fn steps() {
        let (steps, axis) = (1_000_000u32, [3, -2, 5]);
        // Not a divisor of a turn.
        let angle = Angle::from_bits(7_654_321);
        let step = Pose::about(axis, angle).unwrap();
        let mut pose = Pose::IDENTITY;
        for _ in 0..steps {
            pose = pose.turned(&step);
        }
        assert!((length(&pose) - 1.0).abs() <= QUATERNION_ERROR && skew(&pose) <= 12.0, "{} {}", length(&pose), skew(&pose));
        // What the rounded step turns by.
        let [w, x, y, z] = step.rotation.map(f64::from);
        let half = x.hypot(y).hypot(z).atan2(w) * f64::from(steps);
        let [w, x, y, z] = pose.rotation.map(f64::from);
        let direction = [3.0, -2.0, 5.0].map(|c: f64| c / 38f64.sqrt());
        let along = x * direction[0] + y * direction[1] + z * direction[2];
        let found = along.atan2(w);
        let off = (found - half).rem_euclid(TAU / 2.0);
        let off = 2.0 * off.min(TAU / 2.0 - off);
        assert!(off <= f64::from(steps) * STEP_ERROR, "{off:e}");
    }

    #[test]
    fn angles_of_euler() {
        let quarter = Angle::from_bits(1 << 30);
        let [x, y, z] = Pose::from_euler(quarter, Angle::ZERO, Angle::ZERO).matrix();
        // Turned to the left about y, the z axis points along x.
        assert!(x[2] > ONE - 9 && z[0] < 9 - ONE && y[1] > ONE - 9, "{x:?} {y:?} {z:?}");
        let all = Pose::from_euler(Angle::from_num(0.1), Angle::from_num(0.2), Angle::from_num(0.3));
        let one_by_one = Pose::about([0, 0, 1], Angle::from_num(0.3)).unwrap();
        let one_by_one = one_by_one.turned(&Pose::about([1, 0, 0], Angle::from_num(0.2)).unwrap());
        assert_eq!(all, one_by_one.turned(&Pose::about([0, 1, 0], Angle::from_num(0.1)).unwrap()));
    }

    /// Half-way between two rotations is half the angle, the shorter way round.
    #[test]
    fn half_way() {
        let [from, to] = [0.05, 0.85].map(|turns| Pose::about([0, 1, 0], Angle::from_num(turns)).unwrap());
        let middle = from.towards(&to, 1 << 15);
        let exact = Pose::about([0, 1, 0], Angle::from_num(0.95)).unwrap();
        let same: i64 = middle.rotation.iter().zip(exact.rotation).map(|(&a, b)| i64::from(a) * i64::from(b)).sum();
        assert!((same.abs() - (1 << (2 * ROTATION))).abs() < 16 << ROTATION, "{middle:?} {exact:?}");
    }
}
