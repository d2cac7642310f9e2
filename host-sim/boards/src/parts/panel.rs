//! The ST7789, as far as its commands (MIPI DCS) reach the picture.

use anyhow::{Result, ensure};

/// Commands that change the picture.
mod command {
    pub(crate) const SOFTWARE_RESET: u8 = 0x01;
    pub(crate) const SLEEP: u8 = 0x10;
    pub(crate) const WAKE: u8 = 0x11;
    pub(crate) const INVERT_OFF: u8 = 0x20;
    pub(crate) const INVERT_ON: u8 = 0x21;
    pub(crate) const OFF: u8 = 0x28;
    pub(crate) const ON: u8 = 0x29;
    pub(crate) const COLUMNS: u8 = 0x2A;
    pub(crate) const ROWS: u8 = 0x2B;
    pub(crate) const WRITE: u8 = 0x2C;
    pub(crate) const ORDER: u8 = 0x36;
    pub(crate) const FORMAT: u8 = 0x3A;
    pub(crate) const WRITE_ON: u8 = 0x3C;
}

/// First and last column or row of the window that is written to.
#[derive(Clone, Copy)]
struct Range {
    first: usize,
    last: usize,
}

/// The controller and its memory.
pub(crate) struct Panel {
    width: usize,
    pixels: Vec<u16>,
    command: u8,
    arguments: Vec<u8>,
    columns: Range,
    rows: Range,
    x: usize,
    y: usize,
    /// First byte of a pixel whose second has not come yet.
    half: Option<u8>,
    awake: bool,
    on: bool,
    inverted: bool,
    /// The format is 16 bits a pixel.
    rgb565: bool,
    /// Rows from the top, columns from the left, red first.
    upright: bool,
    /// Pixels written so far.
    written: u64,
    /// The first action of the firmware that would break a panel or not be shown.
    fault: Option<String>,
}

/// Contents of the memory after power-on, which no scene draws.
const NOISE: u16 = 0xDEAD;

impl Panel {
    pub(crate) fn new((width, height): (u32, u32)) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self {
            width,
            pixels: vec![NOISE; width * height],
            command: 0,
            arguments: Vec::new(),
            columns: Range { first: 0, last: width - 1 },
            rows: Range { first: 0, last: height - 1 },
            x: 0,
            y: 0,
            half: None,
            awake: false,
            on: false,
            inverted: false,
            rgb565: false,
            upright: true,
            written: 0,
            fault: None,
        }
    }

    /// Remembers the first fault; later ones follow from it.
    fn fail(&mut self, fault: impl FnOnce() -> String) {
        self.fault.get_or_insert_with(fault);
    }

    /// Receives a byte, if the panel is selected. The data pin tells whether it is data or a command.
    pub(crate) fn receive(&mut self, selected: bool, data: bool, byte: u8) {
        match (selected, data) {
            (false, _) => self.fail(|| format!("byte {byte:#04x} was sent while the panel was not selected")),
            (true, true) => self.argument(byte),
            (true, false) => self.start(byte),
        }
    }

    fn start(&mut self, command: u8) {
        if self.half.take().is_some() {
            self.fail(|| format!("command {command:#04x} came in the middle of a pixel: an odd number of bytes"));
        }
        self.command = command;
        self.arguments.clear();
        match command {
            command::SOFTWARE_RESET => (self.awake, self.on, self.inverted) = (false, false, false),
            command::WAKE => self.awake = true,
            command::SLEEP => self.awake = false,
            command::INVERT_OFF => self.inverted = false,
            command::INVERT_ON => self.inverted = true,
            command::OFF => self.on = false,
            command::ON => self.on = true,
            command::WRITE => (self.x, self.y) = (self.columns.first, self.rows.first),
            _ => {}
        }
    }

    fn argument(&mut self, byte: u8) {
        match self.command {
            command::COLUMNS | command::ROWS => {
                self.arguments.push(byte);
                if let [a, b, c, d] = self.arguments[..] {
                    let range = Range { first: u16::from_be_bytes([a, b]).into(), last: u16::from_be_bytes([c, d]).into() };
                    *(if self.command == command::COLUMNS { &mut self.columns } else { &mut self.rows }) = range;
                }
            }
            command::ORDER => self.upright = byte & 0xE8 == 0,
            command::FORMAT => self.rgb565 = byte & 7 == 5,
            command::WRITE | command::WRITE_ON => match self.half.take() {
                None => self.half = Some(byte),
                Some(high) => self.pixel(u16::from_be_bytes([high, byte])),
            },
            _ => {}
        }
    }

    fn pixel(&mut self, value: u16) {
        let (x, y) = (self.x, self.y);
        let place = (x < self.width && x <= self.columns.last).then(|| self.pixels.get_mut(y * self.width + x)).flatten();
        match place {
            _ if y > self.rows.last => self.fail(|| format!("pixel {x}, {y} lies below the window: more pixels than it has")),
            Some(pixel) => *pixel = value,
            None => self.fail(|| format!("pixel {x}, {y} lies outside the panel")),
        }
        self.written += 1;
        self.x += 1;
        if self.x > self.columns.last {
            self.x = self.columns.first;
            self.y += 1;
        }
    }

    /// Whether a person would see the picture, complete.
    pub(crate) fn check(&self) -> Result<()> {
        if let Some(fault) = &self.fault {
            anyhow::bail!("the panel was driven wrongly: {fault}");
        }
        ensure!(self.awake && self.on, "the panel shows nothing: it is asleep or off");
        ensure!(self.inverted, "the panel shows the negative: this type wants its inversion on");
        ensure!(self.rgb565 && self.upright, "the panel is set to another pixel format or orientation than 16 bits, upright");
        ensure!(self.half.is_none(), "the last pixel is incomplete: an odd number of bytes");
        ensure!(self.written >= self.pixels.len() as u64, "only {} of {} pixels were sent", self.written, self.pixels.len());
        Ok(())
    }

    /// The contents of the memory, row by row from the top.
    pub(crate) fn picture(&self) -> Vec<u32> {
        self.pixels.iter().map(|&pixel| pixel.into()).collect()
    }
}
