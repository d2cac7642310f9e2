//! A scene that is open, and what the page asks of it.

use crate::{
    catalogue::Catalogue,
    choices::{Choices, Material, Reading},
    command::{self, Source},
    edit, measure,
    message::{failed, packed, unpacked},
    pixels, program,
};
use anyhow::{Context, Result};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb888};
use microphong::{Stats, Stream, renderer::check};
use microphong_models::{
    bytes::StreamBytes,
    convert::Steps,
    files::Files,
    scene::{self, Scene},
};
use microphong_render::{
    choices as ways,
    render::{Picture, Settings, Style},
    shader::Shader,
};
use serde::{Deserialize, Serialize};
use std::{cell::RefCell, path::Path};

/// What the page asks for. Bytes of files follow `open` in the order of its list.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "camelCase", rename_all_fields = "camelCase", deny_unknown_fields)]
enum Request {
    /// All lists of the page.
    Catalogue,
    /// A built-in scene, or the first of these files that is one.
    Open { scene: Option<String>, files: Vec<FileEntry>, reading: Reading },
    /// A picture.
    Draw { choices: Choices, view: View },
    /// Errors against Phong shading, and what the scene takes.
    Measure { choices: Choices },
    /// A file to take away.
    Take { choices: Choices, what: File },
}

/// A file that a user has dropped.
#[derive(Deserialize)]
struct FileEntry {
    name: String,
    length: usize,
}

/// What a picture shows.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
enum View {
    /// The picture of the display.
    Picture,
    /// The ways that `auto` has chosen, in colours.
    Ways,
    /// The errors against Phong shading.
    Errors,
}

/// A file that a user can take away.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
enum File {
    /// The stream.
    Stream,
    /// The program that draws it.
    Program,
}

/// A scene that has been opened.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Opened<'a> {
    name: &'a str,
    size: (u32, u32),
    is_file: bool,
    frames: u16,
    objects: usize,
    triangles: usize,
    vertices: usize,
    bytes: usize,
    method: &'static str,
    has_smooth_outlines: bool,
    remarks: &'a [String],
}

/// A picture that has been drawn; its pixels follow.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Drawn {
    size: (u32, u32),
    crc: String,
    triangles: u32,
    drawn: u32,
    pixels: u32,
    /// The command that draws it.
    command: String,
    /// The command that writes the stream, where there is one. Without it the command above reads the stream that the page offers, if anything is changed.
    convert: Option<String>,
    needs_stream: bool,
}

/// A file to take away; its bytes follow.
#[derive(Serialize)]
struct Taken {
    name: String,
}

/// An open scene.
struct Open {
    source: Source,
    reading: Reading,
    scene: Scene,
    /// The stream with the neighbours of its triangles; `None` if it is too large for smooth outlines.
    smooth: Option<StreamBytes>,
    remarks: Vec<String>,
    /// The last painted stream, and the choices that it is painted by.
    painted: RefCell<Option<(Choices, StreamBytes)>>,
}

/// A session of the page: it has at most one open scene.
#[derive(Default)]
pub struct Session(Option<Open>);

impl Session {
    /// Answers a message by a message. An answer to a request that fails says why in the field `error`.
    #[must_use]
    pub fn answer(&mut self, message: &[u8]) -> Vec<u8> {
        self.try_answer(message).unwrap_or_else(|error| failed(&format!("{error:#}")))
    }

    fn try_answer(&mut self, message: &[u8]) -> Result<Vec<u8>> {
        let (request, bytes) = unpacked::<Request>(message)?;
        match request {
            Request::Catalogue => {
                let mut catalogue = serde_json::to_value(Catalogue::new())?;
                catalogue["material"] = Material::usual();
                packed(&catalogue, &[])
            }
            Request::Open { scene, files, reading } => {
                // What was open stays open if this fails.
                let open = Open::new(scene, &files, bytes, reading)?;
                let answer = open.opened()?;
                self.0 = Some(open);
                Ok(answer)
            }
            Request::Draw { choices, view } => self.open()?.draw(&choices, view),
            Request::Measure { choices } => self.open()?.measure(&choices),
            Request::Take { choices, what } => self.open()?.take(&choices, what),
        }
    }

    fn open(&self) -> Result<&Open> {
        self.0.as_ref().context("no scene is open")
    }
}

/// Remarks that a user should see.
#[derive(Default)]
struct Remarks(RefCell<Vec<String>>);

impl Steps for Remarks {
    fn begin(&self, _: &'static str, _: usize) {}
    fn step(&self) {}
    fn warn(&self, what: &str) {
        self.0.borrow_mut().push(what.to_owned());
    }
}

/// Endings of files that a scene is read from, the ones that name others first.
const ENDINGS: [&str; 8] = ["toml", "gltf", "obj", "glb", "stl", "ply", "3mf", "tri"];

/// The dropped file that is the scene: the others are files that it names.
fn main_file(files: &[FileEntry]) -> Option<&FileEntry> {
    let has = |file: &&FileEntry, ending: &str| Path::new(&file.name).extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    ENDINGS.iter().find_map(|ending| files.iter().find(|file| has(file, ending))).or(files.first())
}

impl Open {
    fn new(name: Option<String>, files: &[FileEntry], mut bytes: &[u8], reading: Reading) -> Result<Self> {
        let remarks = Remarks::default();
        let (source, scene) = match name {
            Some(name) => (Source::BuiltIn(name.clone()), scene::load(&name)?),
            None => {
                let main = main_file(files).context("no file was dropped")?.name.clone();
                let mut read = Vec::new();
                for FileEntry { name, length } in files {
                    let (file, rest) = bytes.split_at_checked(*length).context("a file is shorter than it says")?;
                    read.push((name.clone(), file.to_vec()));
                    bytes = rest;
                }
                let scene = scene::load_from(&Files::in_memory(read), &main, &reading.options()?, false, &remarks)?;
                (Source::File(main), scene)
            }
        };
        let smooth = scene.smooth()?;
        Ok(Self { source, reading, scene, smooth, remarks: remarks.0.into_inner(), painted: RefCell::default() })
    }

    fn opened(&self) -> Result<Vec<u8>> {
        let stream = self.scene.stream.view()?;
        let opened = Opened {
            name: &self.scene.name,
            size: self.scene.size,
            is_file: matches!(self.source, Source::File(_)),
            frames: stream.header.frames,
            objects: stream.instances.len().max(1),
            triangles: stream.triangles.len(),
            vertices: stream.vertices.len(),
            bytes: self.scene.stream.as_bytes().len(),
            method: Shader::of(&stream)?.name(),
            has_smooth_outlines: self.smooth.is_some(),
            remarks: &self.remarks,
        };
        packed(&opened, &[])
    }

    fn size(&self, choices: &Choices) -> (u32, u32) {
        choices.size.unwrap_or(self.scene.size)
    }

    /// The stream to draw: with neighbours if outlines are smooth.
    fn stream(&self, choices: &Choices) -> Result<StreamBytes> {
        let key = Choices { turn: [0.0; 2], zoom: 1.0, frame: 0, ..choices.clone() };
        let mut painted = self.painted.borrow_mut();
        let known = painted.take().filter(|(known, _)| *known == key);
        let (_, stream) = match known {
            Some(known) => painted.insert(known),
            None => {
                let smooth = self.smooth.as_ref().filter(|_| choices.antialias);
                let stream = edit::painted(smooth.unwrap_or(&self.scene.stream).clone(), choices)?;
                painted.insert((key, stream))
            }
        };
        Ok(edit::viewed(stream.clone(), choices))
    }

    /// The stream to measure. It states the budget of the pixel format, because errors and choices are those of light that has no format.
    fn budgeted(&self, choices: &Choices) -> Result<StreamBytes> {
        Ok(self.stream(choices)?.or_budget(choices.format()?.budget()))
    }

    /// The settings of the picture, which are those of `microphong render`.
    fn settings(&self, choices: &Choices, stream: &Stream<'_>) -> Result<Settings> {
        let (width, height) = self.size(choices);
        let usual = Settings::usual(Shader::of(stream)?, Size::new(width, height), choices.format()?);
        let style = Style {
            antialias: choices.antialias && self.smooth.is_some(),
            dither: usual.style.dither && choices.dither,
            srgb: choices.srgb,
            ..usual.style
        };
        Ok(Settings { style, ..usual })
    }

    fn draw(&self, choices: &Choices, view: View) -> Result<Vec<u8>> {
        let bytes = if view != View::Picture { self.budgeted(choices)? } else { self.stream(choices)? };
        let stream = bytes.view()?;
        let settings = self.settings(choices, &stream)?;
        check(&stream, settings.style.shader.facts(), settings.style.perspective_correct)?;
        let Picture { rgb, crc, stats } = match view {
            View::Picture => pixels::picture(stream, &settings, choices.frame)?,
            View::Ways => ways::painted_as::<Rgb888>(stream, &settings, choices.frame)?.0,
            View::Errors => measure::error_picture(&stream, &settings, choices.frame)?,
        };
        let Stats { triangles, drawn, pixels, .. } = stats;
        let size = self.size(choices);
        let command = command::render(&self.source, &self.reading, choices, &self.scene.name, size)?;
        let convert = command::convert(&self.source, &self.reading, choices, &self.scene.name);
        let needs_stream = edit::is_changed(choices);
        let answer = Drawn { size, crc: format!("{crc:08x}"), triangles, drawn, pixels, command, convert, needs_stream };
        let rgba: Vec<u8> = rgb.as_chunks::<3>().0.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
        packed(&answer, &rgba)
    }

    fn measure(&self, choices: &Choices) -> Result<Vec<u8>> {
        let bytes = self.budgeted(choices)?;
        let stream = bytes.view()?;
        let settings = self.settings(choices, &stream)?;
        packed(&measure::measured(&stream, &settings, choices.frame)?, &[])
    }

    fn take(&self, choices: &Choices, what: File) -> Result<Vec<u8>> {
        let bytes = self.stream(choices)?;
        let name = format!("{}.tri", self.scene.name);
        match what {
            File::Stream => packed(&Taken { name }, bytes.as_bytes()),
            File::Program => {
                let stream = bytes.view()?;
                let text = program::text(&stream, &self.settings(choices, &stream)?, choices.frame, &name)?;
                packed(&Taken { name: "main.rs".to_owned() }, text.as_bytes())
            }
        }
    }
}
