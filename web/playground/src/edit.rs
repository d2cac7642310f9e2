//! Changes of a stream: another method, budget, material, light, background and view.
//!
//! What is drawn is always the changed stream, so that the file which a user takes away shows the same picture.

use crate::choices::{self, Choices, LightKind, Lights};
use anyhow::Result;
use microphong::{
    Stream,
    format::Focal,
    stream::{MAX_FOCAL, MIN_FOCAL, record::Camera},
};
use microphong_models::{
    bytes::StreamBytes,
    look::{Lamp, LampKind},
    number::nearest,
    vector::{V3, add, product, rotation},
};

/// Whether a user has changed the scene itself, and not only the way in which it is drawn.
pub(crate) fn is_changed(choices: &Choices) -> bool {
    choices.material.is_some() || choices.lights.is_some() || choices.background.is_some() || is_viewed_otherwise(choices)
}

/// Whether a user looks at the mesh from another side or distance than the scene does.
fn is_viewed_otherwise(choices: &Choices) -> bool {
    choices.turn != [0.0; 2] || choices.zoom != 1.0
}

/// The stream with all that is chosen but the view.
pub(crate) fn painted(stream: StreamBytes, choices: &Choices) -> Result<StreamBytes> {
    let mut stream = stream;
    if let Some(shader) = choices.shader()? {
        stream = stream.with_shader(shader);
    }
    if let Some(budget) = choices.budget() {
        stream = stream.with_budget(budget);
    }
    if let Some(material) = &choices.material {
        stream = stream.with_material(material.surface()?.record())?;
    }
    if let Some(lights) = choices.lights {
        let records: Vec<_> = lamps(lights, &stream.view()?).iter().map(Lamp::record).collect();
        stream = stream.with_lights(&records)?;
    }
    if let Some(background) = &choices.background {
        stream = stream.with_background(choices::bytes(background)?);
    }
    Ok(stream)
}

/// The stream in the chosen view.
pub(crate) fn viewed(stream: StreamBytes, choices: &Choices) -> StreamBytes {
    if !is_viewed_otherwise(choices) {
        return stream;
    }
    stream.with_camera(|camera| {
        turn(camera, choices.turn);
        *camera = camera.with_focal(zoomed(camera.focal(), choices.zoom));
    })
}

/// A focal length times the zoom, as far as cameras have it.
fn zoomed(focal: Focal, zoom: f64) -> Focal {
    let [shortest, longest] = [MIN_FOCAL, MAX_FOCAL].map(|bits| f64::from(Focal::from_bits(bits)));
    Focal::saturating_from_num((f64::from(focal) * zoom).clamp(shortest, longest))
}

/// Turns the mesh by degrees to the right about the axis of the orbit, and then towards the viewer.
fn turn(camera: &mut Camera, [right, towards]: [f64; 2]) {
    let one = f64::from(1 << 30);
    let real = |row: [i32; 3]| row.map(|c| f64::from(c) / one);
    let about = rotation(real(camera.axis), right.to_radians());
    let tilt = rotation([1.0, 0.0, 0.0], towards.to_radians());
    let rows = product(&tilt, &product(&camera.rotation.map(real), &about));
    camera.rotation = rows.map(|row| row.map(|c| nearest::<microphong::format::Rotation>(c).to_bits()));
}

/// The lights of a choice. Near ones count from the eye.
fn lamps(Lights { kind, azimuth, elevation }: Lights, stream: &Stream<'_>) -> Vec<Lamp> {
    let towards = direction(azimuth, elevation);
    match kind {
        LightKind::One => vec![Lamp::distant(towards, [1.0; 3])],
        LightKind::WarmAndCold => {
            vec![Lamp::distant(towards, [1.0, 0.95, 0.86]), Lamp::distant(direction(azimuth + 150.0, 5.0), [0.2, 0.3, 0.5])]
        }
        LightKind::Near => {
            let centre = stream.header.camera.translation.map(|c| f64::from(c) / f64::from(1 << 14));
            vec![Lamp::near(add(centre, towards.map(|c| 2.0 * c)), [1.0; 3])]
        }
        LightKind::Sky => {
            let sky = Lamp { kind: LampKind::Sky, ..Lamp::distant([0.0, 1.0, 0.0], [0.56, 0.7, 1.0]) };
            vec![Lamp::distant(towards, [0.7, 0.6, 0.45]), sky]
        }
    }
}

/// A direction in eye space, where z runs away from the eye.
fn direction(azimuth: f64, elevation: f64) -> V3 {
    let ((sin, cos), (high, flat)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
    [sin * flat, high, -cos * flat]
}
