//! Values on the command line.

use clap::{
    Arg, Command,
    builder::{PossibleValue, TypedValueParser},
};
use microphong::{
    MAX_SIDE,
    format::{ErrorBudget, LARGEST_BUDGET, LEAST_BUDGET},
};
use microphong_sim::{
    coat::TextureSize,
    import::Colours,
    look::{Cone, LIGHT_RANGE, Lamp, LampKind},
    papers::Topic,
    render::Format,
    shader::Shader,
    vector::{V3, unit},
    view::{Projection, Up},
};
use std::{ffi::OsStr, iter};

/// The value among `all` that has the name `text`.
pub(crate) fn among<T: Copy>(text: &str, all: &[T], name: impl Fn(T) -> &'static str) -> Result<T, String> {
    all.iter().copied().find(|&value| name(value) == text).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|&value| name(value)).collect();
        format!("one of {} is needed", names.join(", "))
    })
}

/// Some values, or each of them that can be had.
#[derive(Clone)]
pub(crate) struct Several<T> {
    pub(crate) values: Vec<T>,
    pub(crate) all: bool,
}

/// `all`, or values separated by commas.
pub(crate) fn several<T: Copy + PartialEq>(text: &str, all: &[T], one: impl Fn(&str) -> Result<T, String>) -> Result<Several<T>, String> {
    if text == "all" {
        return Ok(Several { values: all.to_vec(), all: true });
    }
    let mut values = Vec::new();
    for name in text.split(',') {
        let value = one(name.trim()).map_err(|error| format!("{error}, or all"))?;
        if !values.contains(&value) {
            values.push(value);
        }
    }
    Ok(Several { values, all: false })
}

/// Shading methods, separated by commas. Help lists all names.
#[derive(Clone)]
pub(crate) struct SeveralShaders;

impl TypedValueParser for SeveralShaders {
    type Value = Several<Shader>;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<Several<Shader>, clap::Error> {
        shaders.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let names = Shader::ALL.into_iter().map(Shader::name).chain(iter::once("all"));
        Some(Box::new(names.map(PossibleValue::new)))
    }
}

/// Shading methods by name.
pub(crate) fn shaders(text: &str) -> Result<Several<Shader>, String> {
    several(text, &Shader::ALL, shader)
}

/// Papers by name.
pub(crate) fn topics(text: &str) -> Result<Several<Topic>, String> {
    several(text, &Topic::ALL, |text| among(text, &Topic::ALL, Topic::name))
}

/// A shading method. Help lists all names.
#[derive(Clone)]
pub(crate) struct Shaders;

impl TypedValueParser for Shaders {
    type Value = Shader;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<Shader, clap::Error> {
        shader.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Shader::ALL.into_iter().map(|shader| PossibleValue::new(shader.name()))))
    }
}

/// A shading method by name.
pub(crate) fn shader(text: &str) -> Result<Shader, String> {
    among(text, &Shader::ALL, Shader::name)
}

/// A pixel format by name, of which help lists all.
#[derive(Clone)]
pub(crate) struct Formats;

impl TypedValueParser for Formats {
    type Value = Format;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<Format, clap::Error> {
        format.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Format::ALL.into_iter().map(|format| PossibleValue::new(format.name()))))
    }
}

/// What becomes of the colours of textures and vertices. Help lists all names.
#[derive(Clone)]
pub(crate) struct Corners;

impl TypedValueParser for Corners {
    type Value = Colours;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<Colours, clap::Error> {
        let colours = |text: &str| among(text, &Colours::ALL, Colours::name);
        colours.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Colours::ALL.into_iter().map(|colours| PossibleValue::new(colours.name()))))
    }
}

/// The largest side of a texture.
pub(crate) fn texture_size(text: &str) -> Result<TextureSize, String> {
    text.parse().ok().and_then(TextureSize::of).ok_or_else(|| format!("one of {} is needed", TextureSize::names()))
}

/// A pixel format by its name here, or by the name of its type in programs.
pub(crate) fn format(text: &str) -> Result<Format, String> {
    format_among(text, &Format::ALL)
}

/// One of these pixel formats, by the names that [`format()`] takes.
pub(crate) fn format_among(text: &str, all: &[Format]) -> Result<Format, String> {
    let name = text.to_ascii_lowercase();
    let name = match name.as_str() {
        "binarycolor" => Format::Binary.name(),
        "lightrgb565" => Format::LightRgb565.name(),
        name => name,
    };
    among(name, all, Format::name)
}

/// An axis by name.
pub(crate) fn up(text: &str) -> Result<Up, String> {
    among(text, &Up::ALL, Up::name)
}

/// Degrees from 0 to 180.
pub(crate) fn crease(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|angle| (0.0..=180.0).contains(angle)).ok_or_else(|| "a number of degrees from 0 to 180 is needed".to_owned())
}

/// Farthest coordinate of a near light, in radii of the mesh; farther ones do not fit a stream with every camera.
const FARTHEST_LIGHT: f64 = 8.0;

/// Numbers between commas.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite())).collect();
    numbers.and_then(|numbers| numbers.try_into().ok())
}

/// `X,Y,Z`, a direction, or with `at:` before it a position, or with `sky:` the direction to the middle of the sky: x to the right, y up and z to the
/// eye. Behind it may follow `:RRGGBB`, a colour, and of a near light `:range=R` and `:shines=X,Y,Z:cone=A,B`. Positions count from the centre of the
/// mesh.
pub(crate) fn light(text: &str) -> Result<Lamp, String> {
    let (kind, rest) = match text.split_once(':') {
        Some(("at", rest)) => (LampKind::Near, rest),
        Some(("sky", rest)) => (LampKind::Sky, rest),
        _ => (LampKind::Distant, text),
    };
    let mut parts = rest.split(':');
    // In eye space z runs away from the eye.
    let vector = |text| numbers(text).map(|[x, y, z]| [x, y, -z]);
    let place = vector(parts.next().unwrap_or_default()).ok_or(
        "three numbers are needed, such as -0.5,0.6,0.7, at:-0.5,0.6,1.7 for a near light, or sky:0,1,0; a colour may follow, such as :ffc080",
    )?;
    let mut lamp = Lamp { kind, ..Lamp::distant(place, [1.0; 3]) };
    let (mut axis, mut angles, mut given) = (None, None, Vec::new());
    for part in parts {
        let name = part.split_once('=').map_or("a colour", |(name, _)| name);
        if given.contains(&name) {
            return Err(format!("{name} is given twice"));
        }
        given.push(name);
        match part.split_once('=') {
            None => lamp.colour = colour(part)?,
            Some(("range", range)) => {
                let range = range.parse().ok().filter(|range| LIGHT_RANGE.contains(range));
                lamp.range =
                    Some(range.ok_or_else(|| format!("a range is a number from {} to {}", LIGHT_RANGE.start(), LIGHT_RANGE.end()))?);
            }
            Some(("shines", text)) => {
                axis = Some(vector(text).and_then(unit).ok_or("shines= needs a direction of three numbers, such as shines=0,-1,0")?);
            }
            Some(("cone", text)) => {
                let valid = |&[full, edge]: &[f64; 2]| 0.0 <= full && full < edge && edge <= 180.0;
                angles = Some(numbers(text).filter(valid).ok_or(
                    "cone= needs two angles from 0 to 180 degrees, such as cone=15,25: light is full up to the first, and ends at the second",
                )?);
            }
            Some((name, _)) => return Err(format!("there is no {name}=; a near light can have range=, shines= and cone=")),
        }
    }
    lamp.cone = match (axis, angles) {
        (Some(axis), Some([full, edge])) => Some(Cone { axis, full, edge }),
        (None, None) => None,
        _ => return Err("a light with a cone needs both shines=X,Y,Z and cone=A,B".to_owned()),
    };
    if kind == LampKind::Near {
        if place.iter().any(|c| c.abs() > FARTHEST_LIGHT) {
            return Err(format!(
                "a near light has coordinates from -{FARTHEST_LIGHT} to {FARTHEST_LIGHT}; use a direction for a light that is farther away"
            ));
        }
        return Ok(lamp);
    }
    if lamp.range.is_some() || lamp.cone.is_some() {
        return Err("only a near light, with at: before its position, can have range=, shines= and cone=".to_owned());
    }
    lamp.vector = unit(place).ok_or("a direction is needed; 0,0,0 is not a direction")?;
    Ok(lamp)
}

/// `perspective` or `parallel`.
pub(crate) fn projection(text: &str) -> Result<Projection, String> {
    let name = |p| if p == Projection::Perspective { "perspective" } else { "parallel" };
    among(text, &[Projection::Perspective, Projection::Orthographic], name)
}

/// `640x480`.
pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let wrong = || format!("WIDTHxHEIGHT is needed, such as 320x240, each side from 1 to {MAX_SIDE}");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side)).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

/// `RRGGBB` in hexadecimal, with or without `#`.
pub(crate) fn bytes(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6);
    let [_, r, g, b] = number.ok_or("six hexadecimal digits are needed, such as e0a060")?.to_be_bytes();
    Ok([r, g, b])
}

/// A colour as [`bytes`] reads it, where 1 is ff.
pub(crate) fn colour(text: &str) -> Result<V3, String> {
    Ok(bytes(text)?.map(|c| f64::from(c) / 255.0))
}

/// A number of 64 bits.
pub(crate) fn whole(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {} is needed", u64::MAX))
}

/// A number of 64 bits of something that is done.
pub(crate) fn count(text: &str) -> Result<u64, String> {
    text.parse().ok().filter(|&count| count > 0).ok_or_else(|| format!("a whole number from 1 to {} is needed", u64::MAX))
}

/// An error budget in 1/255, 1/2 to 16.
pub(crate) fn budget(text: &str) -> Result<ErrorBudget, String> {
    let within = |budget: &f64| (f64::from(LEAST_BUDGET)..=f64::from(LARGEST_BUDGET)).contains(budget);
    // Never more than was asked for.
    let budget = text.parse().ok().filter(within).map(|budget: f64| ErrorBudget::from_num(budget));
    budget.ok_or_else(|| format!("a number from {LEAST_BUDGET} to {LARGEST_BUDGET} is needed"))
}

/// A share of light, 0 to 2.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|share| (0.0..=2.0).contains(share)).ok_or_else(|| "a number from 0 to 2 is needed".to_owned())
}

/// A sentence that somebody else will understand.
#[cfg(feature = "boards")]
pub(crate) fn reason(text: &str) -> Result<String, String> {
    Some(text.trim().to_owned()).filter(|text| !text.is_empty()).ok_or_else(|| "a reason is needed, in a sentence".to_owned())
}

/// Degrees, any finite number.
pub(crate) fn degrees(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|angle: &f64| angle.is_finite()).ok_or_else(|| "a number of degrees is needed".to_owned())
}
