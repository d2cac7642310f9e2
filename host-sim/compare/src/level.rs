//! A picture of light levels, before any pixel format rounds them: what errors are measured on.

use anyhow::Result;
use embedded_graphics_core::geometry::Size;
use microphong::{
    Stream,
    format::{BIAS, CHANNEL, Intensity, RAMP, WALK},
    method::{Facts, Reflectance},
    pixel::{Channels, Gamma, Pixel, PixelFormat, ramps::Rounded},
    stream::record::{HAS_COLOURS, HAS_TEXTURE, Mesh},
};
use microphong_oracle::{Facet, Frame, Levels};
use microphong_render::{
    choices::{self, Told},
    render::{self, Style},
};
use zerocopy::FromZeros;

/// A pixel that keeps its levels as they come. They are walked levels, which include half a step.
#[derive(Clone, Copy, Debug)]
struct Fine {
    levels: [u32; 3],
    /// Whether a triangle covers the pixel. Else it has the colour of the background.
    is_drawn: bool,
}

impl Fine {
    /// The pixel of a triangle.
    const fn drawn(levels: [u32; 3]) -> Self {
        Self { levels, is_drawn: true }
    }
}

/// The walked level that is `level` in 1/255.
const fn walked(level: u32) -> u32 {
    ((level + BIAS as u32) << WALK) + (1 << (WALK - 1))
}

/// An entry of the table of colours of a material of one channel.
const ONE_CHANNEL: [u32; 3] = [u32::MAX; 3];

impl PixelFormat for Fine {
    const GRAY: bool = false;
    const DEPTH: [u32; 3] = [8; 3];
    const BYTES: usize = 3;

    fn pack(channels: [u32; 3]) -> Self {
        Self { levels: channels.map(walked), is_drawn: false }
    }

    fn channels(self) -> [u8; 3] {
        [0; 3]
    }

    fn bits(self) -> u32 {
        0
    }
}

impl Pixel for Fine {
    /// Levels of three channels, or [`ONE_CHANNEL`].
    type Stored = [u32; 3];
    type Ramps = Rounded<[u32; 3]>;

    /// Pictures for errors are drawn as boards draw them. The one difference is that a walked level of one channel has a bit more than in formats
    /// with a checkerboard.
    const COARSE: bool = true;

    fn stored(self) -> [u32; 3] {
        self.levels
    }

    fn from_stored(levels: [u32; 3]) -> Self {
        Self::drawn(levels)
    }

    fn tabled(_: [u32; 3], _: u32) -> [u32; 3] {
        ONE_CHANNEL
    }

    fn mixed_with(self, other: Self, share: u32, _: Option<&'static Gamma>) -> Self {
        // Beyond black and white no pixel format has levels that could be mixed.
        let shown = |walked_level: u32| u64::from(walked_level.clamp(walked(0), walked(255)));
        let mixed = |own: u32, other: u32| (shown(own) * u64::from(128 - share) + shown(other) * u64::from(share)) >> 7;
        Self::drawn(std::array::from_fn(|k| mixed(self.levels[k], other.levels[k]) as u32))
    }

    fn entry(ramp: &[[u32; 3]; RAMP], level: u32, bits: u32) -> [u32; 3] {
        let walked = level << (WALK - bits);
        // Between two entries of a table of colours: the level includes the half that rounds to the nearest.
        let exact = walked.saturating_sub(1 << (WALK - 1));
        let (entry, fraction) = ((exact >> WALK) as usize % RAMP, i64::from(exact & ((1 << WALK) - 1)));
        let (here, next) = (ramp[entry], ramp[(entry + 1).min(RAMP - 1)]);
        if here == ONE_CHANNEL {
            return [walked; 3];
        }
        let between = |k: usize| (i64::from(here[k]) + (((i64::from(next[k]) - i64::from(here[k])) * fraction) >> WALK)) as u32;
        [between(0), between(1), between(2)]
    }

    fn quantised(intensity: Intensity, _: u32) -> Self {
        Self::drawn(intensity.map(|level| ((level as u32) << (WALK - 8)) + walked(0)))
    }

    fn mixed(levels: [i32; 3]) -> Self {
        // Biased, and within what that leaves room for.
        let level = |level: i32| level.clamp(-BIAS << CHANNEL, (2 * BIAS + 127) << CHANNEL) + (BIAS << CHANNEL);
        Self::drawn(levels.map(|walked| (level(walked) as u32) << (WALK - CHANNEL)))
    }
}

/// The materials of which [`picture`] walks one level for all channels, in the stream's order. By default there are none.
#[derive(Clone, Debug, Default)]
pub struct Walked(Vec<bool>);

impl Walked {
    /// The materials of a stream as a method walks them. Some methods have loops for three channels alone.
    #[must_use]
    pub fn of(stream: &Stream<'_>, method: &Facts) -> Self {
        let mut reflectance = Box::new(Reflectance::new_zeroed());
        let has_colours = |mesh: &&Mesh| mesh.flags & (HAS_COLOURS | HAS_TEXTURE) != 0;
        let is_coloured = |index: usize| stream.meshes.iter().filter(has_colours).any(|mesh| usize::from(mesh.material) == index);
        let highlight = (method.highlight, method.highlight_levels);
        let is_one_channel = |(index, material)| {
            reflectance.fill(
                Channels::of::<Fine>(),
                stream.header.ambient,
                material,
                stream.lights,
                highlight,
                [is_coloured(index), stream.header.camera.has_local_viewer()],
            );
            !reflectance.three_channels()
        };
        Self(stream.materials.iter().enumerate().map(is_one_channel).collect())
    }

    /// The light of a facet as [`picture`] has it: that of the brightest channel in all three, where one level is walked. Approximation may lift
    /// others above it.
    #[must_use]
    pub fn shown(&self, frame: &Frame, facet: &Facet, light: Levels) -> Levels {
        if self.0.get(facet.material) != Some(&true) {
            return light;
        }
        [frame.only_channel(facet).map_or(light.into_iter().fold(0.0, f64::max), |channel| light[channel]); 3]
    }
}

/// The error budget of [`picture`], in 1/255.
#[must_use]
pub fn budget(stream: &Stream<'_>) -> f64 {
    stream.header.budget().unwrap_or(Fine::BUDGET).to_num()
}

/// The way that a method chooses for each triangle of [`picture`]; `None` unless the method has an error budget.
///
/// # Errors
/// When `size` is out of range.
pub fn choices(stream: Stream<'_>, size: Size, style: Style, number: u32) -> Result<Option<Told>> {
    choices::by::<Fine>(style.shader, stream, size, style.perspective_correct, number)
}

/// Levels of red, green and blue, where 255 is full, row by row from the top; `None` where nothing is drawn.
///
/// Where the renderer walks one level for all channels, all three have the level of the brightest channel. A transparent surface mixes these levels
/// with what is behind it.
///
/// # Errors
/// When `size` is out of range, or the scene cannot be drawn in this style.
pub fn picture(stream: Stream<'_>, size: Size, style: impl Into<Style>, number: u32) -> Result<Vec<Option<[f64; 3]>>> {
    let (pixels, _) = render::frame::<Fine>(stream, size, style, size.height, number)?;
    // The half that rounds, and the guards below black.
    let level = |level: u32| ((f64::from(level) - f64::from(walked(0))) / f64::from(1 << WALK)).clamp(0.0, 255.0);
    Ok(pixels.into_iter().map(|pixel| pixel.is_drawn.then(|| pixel.levels.map(level))).collect())
}
