//! The SSD1306 behind a glass of 128x64 pixels, as the usual modules have it: on the I2C bus, with a charge pump for the voltage of the pixels.

use anyhow::{Result, bail, ensure};
use std::ops::RangeInclusive;

/// The address of the usual modules.
const ADDRESS: u32 = 0x3C;

const WIDTH: usize = 128;
const PAGES: usize = 8;

/// The contents of a byte of memory after power-on, which no picture consists of.
const NOISE: u8 = 0xA5;

/// What the bytes of a message are. The first byte says it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Message {
    Commands,
    Pixels,
}

/// The controller and its memory.
pub(crate) struct Oled {
    /// Columns from the left, rows from the top, eight rows in a byte.
    memory: [[u8; WIDTH]; PAGES],
    message: Option<Message>,
    /// Bytes of a command that is not complete yet.
    command: Vec<u8>,
    columns: RangeInclusive<usize>,
    pages: RangeInclusive<usize>,
    column: usize,
    page: usize,
    /// Bytes that the window still has room for.
    room: usize,
    /// Commands were sent that a picture needs.
    settings: Settings,
    /// The first byte that the controller or the glass does not understand.
    fault: Option<String>,
}

/// Settings that the picture depends on.
#[derive(Default)]
struct Settings {
    on: bool,
    pumps: bool,
    inverted: bool,
    /// All pixels are lit, whatever the memory contains.
    all: bool,
    /// Bytes are written along rows, from page to page.
    horizontal: bool,
    /// The glass is mounted such that its columns and rows count down.
    columns_turned: bool,
    rows_turned: bool,
    /// Rows, and how the glass connects them.
    multiplexed: bool,
    connected: bool,
}

impl Oled {
    pub(crate) fn new() -> Self {
        Self {
            memory: [[NOISE; WIDTH]; PAGES],
            message: None,
            command: Vec::new(),
            columns: 0..=WIDTH - 1,
            pages: 0..=PAGES - 1,
            column: 0,
            page: 0,
            room: 0,
            settings: Settings::default(),
            fault: None,
        }
    }

    /// Remembers the first fault; later ones follow from it.
    fn fail(&mut self, fault: impl FnOnce() -> String) {
        self.fault.get_or_insert_with(fault);
    }

    /// A message begins. Whether it is for this display.
    pub(crate) fn start(&mut self, address: u32) -> bool {
        self.message = None;
        address == ADDRESS
    }

    /// Receives a byte of a message.
    pub(crate) fn receive(&mut self, byte: u8) {
        match self.message {
            Some(Message::Commands) => {
                self.command.push(byte);
                self.execute();
            }
            Some(Message::Pixels) => self.pixels(byte),
            None => match byte {
                0x00 => self.message = Some(Message::Commands),
                0x40 => self.message = Some(Message::Pixels),
                _ => self.fail(|| format!("the control byte {byte:#04x} announces neither commands (0x00) nor pixels (0x40)")),
            },
        }
    }

    /// A message ends.
    pub(crate) fn stop(&mut self) {
        if !self.command.is_empty() {
            let command = std::mem::take(&mut self.command);
            self.fail(|| format!("a message ends in the middle of the command {command:02x?}"));
        }
    }

    /// Executes the command that has been received, if it is complete.
    fn execute(&mut self) {
        let settings = &mut self.settings;
        match self.command[..] {
            // Settings that change brightness and timing, but no pixel.
            [0x81 | 0xD5 | 0xD9 | 0xDB, _] | [0xE3] => {}
            // The picture begins in row 0, and does not scroll.
            [0x40 | 0x2E] | [0xD3, 0] => {}
            [0x20, mode @ 0..=2] => settings.horizontal = mode == 0,
            [0x21, first, last] if first <= last && last < 128 => self.columns = first.into()..=last.into(),
            [0x22, first, last] if first <= last && last < 8 => self.pages = first.into()..=last.into(),
            [0x8D, mode @ (0x10 | 0x14)] => settings.pumps = mode == 0x14,
            [turned @ 0xA0..=0xA1] => settings.columns_turned = turned == 0xA1,
            [turned @ (0xC0 | 0xC8)] => settings.rows_turned = turned == 0xC8,
            [all @ 0xA4..=0xA5] => settings.all = all == 0xA5,
            [inverted @ 0xA6..=0xA7] => settings.inverted = inverted == 0xA7,
            [0xA8, rows] => settings.multiplexed = rows == 63,
            [0xDA, pins @ (0x02 | 0x12 | 0x22 | 0x32)] => settings.connected = pins == 0x12,
            [on @ 0xAE..=0xAF] => settings.on = on == 0xAF,
            // They have arguments that have not come yet.
            [0x20 | 0x21 | 0x22 | 0x81 | 0x8D | 0xA8 | 0xD3 | 0xD5 | 0xD9 | 0xDA | 0xDB] | [0x21 | 0x22, _] => return,
            _ => {
                let command = self.command.clone();
                self.fail(|| format!("the command {command:02x?} is unknown, or not for this glass"));
            }
        }
        if matches!(self.command[0], 0x21 | 0x22) {
            (self.column, self.page) = (*self.columns.start(), *self.pages.start());
            self.room = self.columns.clone().count() * self.pages.clone().count();
        }
        self.command.clear();
    }

    /// Receives eight pixels, the topmost in the lowest bit.
    fn pixels(&mut self, byte: u8) {
        if !self.settings.horizontal {
            self.fail(|| "pixels are sent in another order than along rows, which is not modelled".to_owned());
        }
        if self.room == 0 {
            self.fail(|| "more pixels are sent than the window has".to_owned());
            return;
        }
        self.room -= 1;
        // The order of columns applies to what is written, that of rows to what is shown.
        let column = if self.settings.columns_turned { self.column } else { WIDTH - 1 - self.column };
        self.memory[self.page][column] = byte;
        self.column += 1;
        if self.column > *self.columns.end() {
            (self.column, self.page) = (*self.columns.start(), self.page + 1);
        }
    }

    /// Whether a person would see the picture, complete.
    pub(crate) fn check(&self) -> Result<()> {
        if let Some(fault) = &self.fault {
            bail!("the display was driven wrongly: {fault}");
        }
        let Settings { on, pumps, all, multiplexed, connected, .. } = self.settings;
        ensure!(on && pumps, "the display shows nothing: it is off, or its charge pump is");
        ensure!(!all, "all pixels are lit, whatever was drawn");
        ensure!(multiplexed && connected, "the display is set to another glass than one of 128x64 pixels with alternating rows");
        ensure!(self.room == 0, "the window still has room for {} bytes of pixels", self.room);
        Ok(())
    }

    /// The visible picture, row by row from the top: 1 where there is light.
    pub(crate) fn picture(&self) -> Vec<u32> {
        let rows = 8 * PAGES;
        let pixel = |x: usize, y: usize| {
            let row = if self.settings.rows_turned { y } else { rows - 1 - y };
            u32::from(self.memory[row / 8][x] >> (row % 8) & 1) ^ u32::from(self.settings.inverted)
        };
        (0..rows).flat_map(|y| (0..WIDTH).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The commands that the driver `ssd1306` starts a display with.
    const BEGIN: &[u8] = &[
        0x00, 0xAE, 0xD5, 0x80, 0xA8, 0x3F, 0xD3, 0x00, 0x40, 0x8D, 0x14, 0x20, 0x00, 0xDA, 0x12, 0xA1, 0xC8, 0xD9, 0x21, 0x81, 0x5F, 0xDB,
        0x40, 0xA4, 0xA6, 0x2E, 0xAF,
    ];

    fn send(display: &mut Oled, message: &[u8]) {
        assert!(display.start(ADDRESS));
        message.iter().for_each(|&byte| display.receive(byte));
        display.stop();
    }

    fn fault(display: &Oled) -> String {
        display.check().expect_err("a fault").to_string()
    }

    #[test]
    fn shows_what_is_sent_into_a_window() {
        let mut display = Oled::new();
        send(&mut display, BEGIN);
        send(&mut display, &[0x00, 0x21, 2, 3, 0x22, 1, 2]);
        send(&mut display, &[0x40, 0x01, 0x80, 0x00]);
        assert!(fault(&display).contains("room for 1 bytes"));
        send(&mut display, &[0x40, 0xFF]);
        display.check().expect("a picture");
        let picture = display.picture();
        let column = |x: usize| (8..24).map(|y| picture[y * WIDTH + x]).collect::<Vec<_>>();
        assert_eq!(column(2), [[1, 0, 0, 0, 0, 0, 0, 0], [0; 8]].concat());
        assert_eq!(column(3), [[0, 0, 0, 0, 0, 0, 0, 1], [1; 8]].concat());
        send(&mut display, &[0x00, 0xA7]);
        assert!(display.picture().iter().zip(&picture).all(|(a, b)| a ^ b == 1));
        // The driver says how the glass is mounted; otherwise the picture stands on its head.
        send(&mut display, &[0x00, 0xA6, 0xC0]);
        assert!(display.picture().chunks(WIDTH).rev().flatten().eq(&picture));
    }

    #[test]
    fn wrong_bytes_are_told() {
        for (message, told) in [
            (&[0x01][..], "control byte 0x01"),
            (&[0x00, 0xFF], "[ff] is unknown"),
            (&[0x00, 0x21, 0, 128], "[21, 00, 80] is unknown"),
            (&[0x00, 0x41], "[41] is unknown"),
            (&[0x00, 0x8D], "in the middle of the command [8d]"),
            (&[0x00, 0xA5], "all pixels"),
            (&[0x00, 0xAE], "it is off"),
            (&[0x00, 0x8D, 0x10], "charge pump"),
            (&[0x00, 0xA8, 31], "another glass"),
            (&[0x40, 0x00], "more pixels"),
            (&[0x00, 0x20, 2], "another order"),
        ] {
            let mut display = Oled::new();
            send(&mut display, BEGIN);
            display.check().expect("all is well");
            send(&mut display, message);
            if told == "another order" {
                send(&mut display, &[0x40, 0x00]);
            }
            assert!(fault(&display).contains(told), "{message:02x?}: {}", fault(&display));
        }
    }
}
