//! What each board's firmware can draw. A build without emulators knows it as well.

// The firmware's own file: the numbers exist once.
#[path = "../../../firmware/src/budget.rs"]
#[expect(unreachable_pub, reason = "it is a module of libraries as well")]
mod budget;

use anyhow::{Result, bail, ensure};
use budget::Budget;
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use microphong::{RenderError, Renderer, Stream};
use microphong_sim::{render::Format, shader::Shader};

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
        methods: &Shader::SMALLEST_BOARD,
        budget: budget::LM3S6965EVB,
        format: Format::Gray4,
        has_text: false,
        memory: include_str!("../../../firmware/boards/lm3s6965evb.x"),
    },
    MPS2,
    Board { name: "mps2-an386", memory: include_str!("../../../firmware/boards/mps2-an386.x"), ..MPS2 },
];

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
        let length = stream.header.length as usize;
        if let Some(room) = self.room().filter(|&room| length > room) {
            bail!("the stream has {length} bytes, but {name} has room for {room}; use --simplify to make it smaller");
        }
        ensure!(self.has_text || stream.labels.is_empty(), "the firmware of {name} has no fonts; remove the labels");
        let size = Size::new(layout.width as u32, *height as u32);
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let shader = Shader::of(stream)?;
        match Renderer::<Rgb565>::with_shader(*stream, size, layout, &mut memory, shader.on()) {
            Ok(_) => Ok(()),
            Err(RenderError::Materials { need }) => bail!(
                "the scene has {need} materials, but the firmware of {name} has room for {}; use fewer materials, or --colour for one",
                layout.materials
            ),
            Err(RenderError::Objects { need }) => {
                bail!("the scene has {need} objects, but the firmware of {name} has room for {}; remove some", layout.objects)
            }
            Err(error) => bail!("the firmware of {name} cannot draw it: {error}"),
        }
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
