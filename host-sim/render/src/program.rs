//! Whole programs with one method and one pixel format, and what they take, as it was measured and recorded.

use crate::{
    chip::{Chip, Core},
    render::Format,
    shader::Shader,
};
use anyhow::{Context, Result, bail, ensure};
use microphong::{Layout, Stream, features::Feature};
use std::fmt;

/// Methods that there are programs with.
pub const SHADERS: [Shader; 4] = [Shader::GOURAUD, Shader::AUTO_LINEAR, Shader::PHONG, Shader::AUTO];
/// Pixel formats that there are programs with.
pub const FORMATS: [Format; 2] = [Format::Rgb565, Format::Binary];

/// The names of an entry's figures, which is the first line of the record.
pub const HEAD: &str = "core,features,format,shader,flash_bytes,ram_bytes,stack_bytes";

/// The cargo features of the core in a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Features {
    /// The default features.
    Default,
    /// No features: one directional light, an infinitely far viewer, materials of one colour, one object and no movements but an orbit.
    None,
}

impl Features {
    /// All choices that there are programs with.
    pub const ALL: [Self; 2] = [Self::Default, Self::None];

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::None => "none",
        }
    }

    /// The least features with which a program can draw `stream` in this format.
    #[must_use]
    pub fn needed_by(stream: &Stream<'_>, format: Format) -> Self {
        if needs(stream, format).is_empty() { Self::None } else { Self::Default }
    }
}

/// The cargo features of the core that a program needs to draw `stream` in this format.
#[must_use]
pub fn needs(stream: &Stream<'_>, format: Format) -> Vec<Feature> {
    let channels = format.channels();
    Feature::ALL.into_iter().filter(|feature| feature.is_needed_by(stream, &channels)).collect()
}

/// A layout as a program has it.
#[must_use]
pub fn layout_text(layout: &Layout) -> String {
    let Layout { width, rows, vertices, triangles, materials, objects, active_triangles, highlight_tables, antialias, edges, .. } = layout;
    let several = if *objects > 1 { format!(".objects({objects})") } else { String::new() };
    let text = format!("Layout::new({width}, {rows}).vertices({vertices}).triangles({triangles}).materials({materials}){several}");
    let tables = if *highlight_tables > 0 { "" } else { ".without_highlight_tables()" };
    let smooth = if *antialias { format!(".antialias(true).edges({edges})") } else { String::new() };
    format!("{text}.active_triangles({active_triangles}){tables}{smooth}")
}

/// A program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// The processor that it is compiled for.
    pub core: Core,
    /// Its cargo features.
    pub features: Features,
    /// Method of the program.
    pub shader: Shader,
    /// Pixel format of the program.
    pub format: Format,
}

impl Program {
    /// All programs for these processors, features, methods and formats.
    #[must_use]
    pub fn all(cores: &[Core], features: &[Features], shaders: &[Shader], formats: &[Format]) -> Vec<Self> {
        let mut all = Vec::new();
        for &core in cores {
            for &features in features {
                let of = |&format| shaders.iter().map(move |&shader| Self { core, features, shader, format });
                all.extend(formats.iter().flat_map(of));
            }
        }
        all
    }

    /// The name of its file.
    #[must_use]
    pub fn name(self) -> String {
        format!("{}-{}", self.shader.name(), self.format.name())
    }

    /// The recorded program that takes what this one takes, or more: `auto` is the largest method, and `Rgb565` the larger format.
    #[must_use]
    pub fn recorded(self) -> Self {
        let shader = if SHADERS.contains(&self.shader) { self.shader } else { Shader::AUTO };
        let format = if FORMATS.contains(&self.format) { self.format } else { Format::Rgb565 };
        Self { shader, format, ..self }
    }
}

/// A line of the record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The program.
    pub program: Program,
    /// Bytes of flash, without the mesh.
    pub flash: u64,
    /// Bytes of static variables, with room for the teapot.
    pub ram: u64,
    /// Bytes of stack.
    pub stack: u64,
}

impl Entry {
    fn parse(line: &str) -> Result<Self> {
        let words: Vec<_> = line.split(',').map(str::trim).collect();
        let [core, features, format, shader, flash, ram, stack] = words[..] else {
            bail!("{} words instead of those of `{HEAD}`", words.len());
        };
        let number = |word: &str| word.parse::<u64>().with_context(|| format!("`{word}` is no number"));
        let core = Core::ALL.into_iter().find(|other| other.name() == core).with_context(|| format!("no processor {core}"))?;
        let features =
            Features::ALL.into_iter().find(|other| other.name() == features).with_context(|| format!("no features {features}"))?;
        let format = FORMATS.into_iter().find(|other| other.name() == format).with_context(|| format!("no pixel format {format}"))?;
        let shader = SHADERS.into_iter().find(|other| other.name() == shader).with_context(|| format!("no method {shader}"))?;
        let program = Program { core, features, shader, format };
        Ok(Self { program, flash: number(flash)?, ram: number(ram)?, stack: number(stack)? })
    }

    /// Reads a record.
    ///
    /// # Errors
    /// Names the line.
    pub fn all(text: &str) -> Result<Vec<Self>> {
        let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && *line != HEAD);
        let entries = lines.map(|(number, line)| Self::parse(line).with_context(|| format!("line {number}")));
        let entries = entries.collect::<Result<Vec<_>>>()?;
        ensure!(!entries.is_empty(), "it has no line: `{HEAD}` and a program in each line are needed");
        Ok(entries)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { program: Program { core, features, shader, format }, flash, ram, stack } = self;
        write!(f, "{},{},{},{},{flash},{ram},{stack}", core.name(), features.name(), format.name(), shader.name())
    }
}

/// The recorded sizes of this version.
///
/// # Errors
/// When the record is damaged.
pub fn recorded() -> Result<Vec<Entry>> {
    Entry::all(include_str!("../../../tests/baselines/sizes.csv"))
}

/// The common chips, and the share of flash or RAM, whichever is larger, that a program takes of each. The program has this method, this format and
/// these features. The mesh takes so many bytes of flash, and the renderer's memory and a band take so many bytes of RAM. The rest is taken from the
/// record of this version.
///
/// # Errors
/// When the record is damaged.
pub fn loads(features: Features, shader: Shader, format: Format, [mesh, memory]: [usize; 2]) -> Result<Vec<(Chip, f64)>> {
    let recorded = recorded()?;
    let load = |chip: Chip| {
        let program = Program { core: chip.core, features, shader, format }.recorded();
        let entry = recorded.iter().find(|entry| entry.program == program).with_context(|| format!("no size of {program:?}"))?;
        Ok((chip, chip.load(entry.flash + mesh as u64, memory as u64 + entry.stack)))
    };
    Chip::ALL.into_iter().map(load).collect()
}
