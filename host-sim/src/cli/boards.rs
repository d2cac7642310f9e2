//! What each board's firmware can draw. A build without emulators knows it as well.

// The firmware's own file: the numbers exist once.
#[path = "../../../firmware/src/budget.rs"]
#[expect(unreachable_pub, reason = "it is a module of libraries as well")]
mod budget;

use anyhow::{Result, bail, ensure};
use budget::Budget;
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{Light, Outlines, RenderError, Renderer, Stream};
use microphong_sim::{render::Format, shader::Shader};
use std::{error::Error, fmt};

/// A board that there is firmware for.
pub(super) struct Board {
    pub(super) name: &'static str,
    methods: &'static [Shader],
    budget: Budget,
    /// How its display stores pixels, but for the order of bytes.
    pub(super) format: Format,
    /// Whether its firmware has fonts.
    has_text: bool,
    /// The linker script that says where streams lie.
    memory: &'static str,
}

const MPS2: Board = Board {
    name: "mps2-an385",
    methods: &Shader::ALL,
    budget: budget::MPS2,
    format: Format::Rgb565,
    has_text: true,
    memory: include_str!("../../../firmware/boards/mps2-an385.x"),
};

/// All of them.
pub(super) const BOARDS: [Board; 4] = [
    Board { name: "pico", budget: budget::PICO, memory: include_str!("../../../memory.x"), ..MPS2 },
    Board {
        name: "lm3s6965evb",
        methods: &Shader::CORE,
        budget: budget::LM3S6965EVB,
        format: Format::Gray4,
        has_text: false,
        memory: include_str!("../../../firmware/boards/lm3s6965evb.x"),
    },
    MPS2,
    Board { name: "mps2-an386", memory: include_str!("../../../firmware/boards/mps2-an386.x"), ..MPS2 },
];

/// A board has no room for a stream, but would take a smaller one.
#[derive(Debug)]
pub(super) struct TooLarge {
    name: &'static str,
    length: usize,
    room: usize,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, length, room } = self;
        write!(f, "the stream has {length} bytes, and {name} has room for {room}")
    }
}

impl Error for TooLarge {}

impl Board {
    /// The board with this name.
    pub(super) fn named(name: &str) -> Option<Self> {
        BOARDS.into_iter().find(|board| board.name == name)
    }

    /// What the firmware has in place of a method that it lacks.
    pub(super) fn lacks(&self, shader: Shader) -> Option<String> {
        let names: Vec<_> = self.methods.iter().map(|shader| shader.name()).collect();
        let is_missing = !self.methods.contains(&shader);
        is_missing.then(|| format!("the firmware of {} has no {}; it has {}", self.name, shader.name(), names.join(", ")))
    }

    /// Refuses a stream that the firmware would refuse, or that does not fit the board.
    pub(super) fn check(&self, stream: &Stream<'_>) -> Result<()> {
        let Self { name, budget: Budget { height, layout }, .. } = self;
        ensure!(self.has_text || stream.labels.is_empty(), "the firmware of {name} has no fonts; remove the labels");
        ensure!(
            !stream.lights.iter().any(Light::has_shape),
            "the firmware of {name} has no lights with a range or a cone, and no light from the sky; remove them, or write a program with the cargo \
             feature light-shapes"
        );
        ensure!(
            Outlines::of(stream.header).is_none(),
            "the firmware of {name} draws no lines along outlines; remove them, or write a program with the cargo feature antialias"
        );
        ensure!(
            stream.corner_colours.is_empty(),
            "the firmware of {name} draws no colours at corners; convert the mesh with --colours none, or write a program with the cargo feature \
             vertex-colours"
        );
        ensure!(
            stream.textures().list.is_empty(),
            "the firmware of {name} draws no textures; convert the mesh with --colours none, or write a program with the cargo feature textures"
        );
        let size = Size::new(layout.width as u32, *height as u32);
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let shader = Shader::of(stream)?;
        let drawn = Renderer::<Rgb565>::with_shader(*stream, size, layout, &mut memory, shader.on())
            .and_then(|mut renderer| renderer.frame(0).next_band(&mut vec![Rgb565::default(); layout.band()]));
        match drawn {
            Ok(_) => {}
            Err(RenderError::TooFewHighlightTables { need }) => bail!(
                "the scene has {need} kinds of highlights, but the firmware of {name} has room for {}; use fewer exponents, or --shader gouraud, \
                 which needs no room for them",
                layout.highlight_tables
            ),
            Err(RenderError::Materials { need }) => bail!(
                "the scene has {need} materials, but the firmware of {name} has room for {}; use fewer materials, or --colour for one",
                layout.materials
            ),
            Err(RenderError::Objects { need }) => {
                bail!("the scene has {need} objects, but the firmware of {name} has room for {}; remove some", layout.objects)
            }
            Err(error) => bail!("the firmware of {name} cannot draw it: {error}"),
        }
        let length = stream.header.length as usize;
        match self.room().filter(|&room| length > room) {
            Some(room) => Err(TooLarge { name, length, room }.into()),
            None => Ok(()),
        }
    }

    /// The share of its memory for streams that a stream takes.
    pub(super) fn load(&self, stream: &Stream<'_>) -> f64 {
        self.room().map_or(0.0, |room| f64::from(stream.header.length) / room as f64)
    }

    /// Size of its picture, and rows of a band.
    pub(super) fn picture(&self) -> ((u32, u32), u32) {
        let Budget { height, layout } = self.budget;
        ((layout.width as u32, height as u32), layout.rows as u32)
    }

    /// Bytes that a stream may have.
    fn room(&self) -> Option<usize> {
        let line = self.memory.lines().find(|line| line.trim_start().starts_with("STREAM"))?;
        let length = line.split("LENGTH =").nth(1)?.trim();
        let unit = match length.chars().last()? {
            'K' => 1 << 10,
            'M' => 1 << 20,
            _ => return None,
        };
        length.get(..length.len() - 1)?.parse::<usize>().ok()?.checked_mul(unit)
    }
}
