//! The scenes in colours of the boards in examples/, each at the moment that docs/examples shows. Emulated processors draw them, and so does this computer.

use microphong::{Pose, format::Rotation};

#[path = "../../examples/esp32c3-gc9a01/src/scene.rs"]
pub(crate) mod esp32c3_gc9a01;
#[path = "../../examples/nrf52840-gc9a01/src/scene.rs"]
pub(crate) mod nrf52840_gc9a01;
#[path = "../../examples/rp2350-st7789/src/scene.rs"]
pub(crate) mod rp2350_st7789;
#[path = "../../examples/stm32f411-ili9341/src/scene.rs"]
pub(crate) mod stm32f411_ili9341;

/// The time on the watch, in seconds.
pub(crate) const TEN_PAST_TEN: u32 = (10 * 60 + 10) * 60;

/// A rotation as the sensor of the watch reports it: a quaternion w, x, y, z.
pub(crate) fn tilt() -> Pose {
    Pose::from_quaternion([15_488, -4_864, 2_048, 512].map(|c| Rotation::from_bits(c << 16))).expect("a rotation")
}

/// Calls the macro `$with` for each scene, with the name of the example, its module, and the picture that a renderer and a band make of it.
/// The caller has to import what this file contains.
macro_rules! each_scene {
    ($with:ident) => {
        $with!("esp32c3-gc9a01", esp32c3_gc9a01, |renderer, band| {
            esp32c3_gc9a01::set(renderer.scene(), 43.0).expect("a needle");
            ::microphong::Picture::of_scene(renderer, band)
        });
        $with!("nrf52840-gc9a01", nrf52840_gc9a01, |renderer, band| {
            nrf52840_gc9a01::set(renderer, &tilt(), TEN_PAST_TEN).expect("hands");
            nrf52840_gc9a01::picture(renderer, band, TEN_PAST_TEN)
        });
        $with!("rp2350-st7789", rp2350_st7789, |renderer, band| rp2350_st7789::picture(renderer, band, 0, None));
        $with!("stm32f411-ili9341", stm32f411_ili9341, |renderer, band| stm32f411_ili9341::picture(renderer, band, 0));
    };
}
