//! Programs of boards, by the cargo features that they have.

use anyhow::{Result, ensure};
use embedded_graphics_core::pixelcolor::Rgb565;
use microphong::{Stream, features::Feature, pixel::Channels};
use microphong_boards::{Board, build, verify};
use std::path::PathBuf;

/// A program of a board: its firmware, with more cargo features. Each bit stands for one of the names below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Program(u32);

/// Cargo features of the firmware. Those from [`FIRST_FORMAT`] on are pixel formats, of which a program has one.
const NAMES: [&str; 15] = [
    "antialias",
    "textures",
    "vertex-colours",
    "transparency",
    "perspective",
    "gamma",
    "rgb888",
    "gray8",
    "gray4",
    "gray2",
    "binary",
    "bgr565",
    "rgb666",
    "rgb332",
    "light-rgb565",
];

/// The place of the first pixel format among the [`NAMES`].
const FIRST_FORMAT: u32 = 6;

/// The pixel format of programs that ask for no other.
const USUAL_FORMAT: &str = "rgb565";

impl Program {
    /// The firmware of the board.
    pub const PLAIN: Self = Self(0);
    /// The firmware that draws smooth outlines, lines, and all lights.
    pub const ANTIALIAS: Self = Self(1);
    /// The program that draws textures.
    pub const TEXTURES: Self = Self(1 << 1);
    /// The program that draws colours at corners.
    pub const VERTEX_COLOURS: Self = Self(1 << 2);
    /// The program that draws transparent surfaces.
    pub const TRANSPARENCY: Self = Self(1 << 3);
    /// The program that draws textures with holes.
    pub const HOLES: Self = Self::TEXTURES.and(Self::TRANSPARENCY);
    /// The program that interpolates light in perspective.
    pub(super) const PERSPECTIVE: Self = Self(1 << 4);
    /// The program that corrects colours for the curve of sRGB.
    pub(super) const GAMMA: Self = Self(1 << 5);

    /// The program that draws in a pixel format, by its number among the formats.
    pub(super) const fn in_format(number: u32) -> Self {
        Self(1 << (FIRST_FORMAT + number))
    }

    /// The least program that draws a stream.
    #[must_use]
    pub fn needed_by(stream: &Stream<'_>) -> Self {
        let needs = |feature: Feature| feature.is_needed_by(stream, &Channels::of::<Rgb565>());
        let of = |feature, program| if needs(feature) { program } else { Self::PLAIN };
        let textures = of(Feature::Textures, Self::TEXTURES);
        [
            of(Feature::Antialias, Self::ANTIALIAS),
            of(Feature::LightShapes, Self::ANTIALIAS),
            // Programs that draw textures draw colours as well.
            if textures == Self::PLAIN { of(Feature::VertexColours, Self::VERTEX_COLOURS) } else { textures },
            of(Feature::Transparency, Self::TRANSPARENCY),
        ]
        .into_iter()
        .fold(Self::PLAIN, Self::and)
    }

    /// The program that has the features of both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether it has the features of another.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.and(other).0 == self.0
    }

    /// The names of its features, separated by commas.
    pub(super) fn features(self) -> String {
        let names = (0..).zip(NAMES).filter(|(bit, _)| self.0 >> bit & 1 == 1).map(|(_, name)| name);
        names.collect::<Vec<_>>().join(",")
    }

    /// Asks whether there is one for `board`.
    ///
    /// # Errors
    /// When the board has too little memory for more than its firmware.
    pub fn check(self, board: Board) -> Result<()> {
        ensure!(self == Self::PLAIN || board.smooths(), "{board} has too little memory for the program with {}", self.features());
        Ok(())
    }

    /// Builds it for `board`, and returns the ELF's path.
    ///
    /// # Errors
    /// Errors of [`Self::check`], or when the program does not compile.
    pub fn build(self, board: Board) -> Result<PathBuf> {
        self.check(board)?;
        if [Self::PLAIN, Self::ANTIALIAS].contains(&self) {
            return verify::build(board, self == Self::ANTIALIAS);
        }
        let has_format = self.0 >> FIRST_FORMAT != 0;
        let features = self.features();
        build::styles(board, &if has_format { features } else { format!("{USUAL_FORMAT},{features}") })
    }
}
