//! The report: one HTML file with everything in it.

mod antialias;
mod chart;
mod picture;
mod scale;
mod table;

use super::{Comparison, Reference, Window, antialias::Smoothing};
use crate::document::{
    choices::{key, shares},
    document,
};
use anyhow::{Context, Result};
use maud::{Markup, html};
use microphong_render::{output::Output, shader::Shader};
use rayon::prelude::*;
use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

const STYLE: &str = include_str!("style.css");

/// What a page that compares shading methods begins with.
pub const SHADING: &str = "Each method's integer picture against Phong shading in 64-bit floating point: the normal interpolated, normalised and \
    lit at every pixel. Errors are in LSB, steps of which 255 are full level, before an output format rounds.";

/// What a page that judges smooth outlines begins with.
pub const OUTLINES: &str = "Each method's picture with smooth outlines, and its plain picture, against means of 16x16 samples per pixel of the same \
    method in 64-bit floating point. Differences are in LSB, steps of which 255 are full level, in 8 bits per channel.";

/// A page under construction.
#[derive(Debug)]
pub struct Page {
    about: &'static str,
    output: Output,
    scenes: Vec<(String, Markup)>,
}

/// The result of a method on a scene: its figures, or the reason why there are none.
pub type Outcome<'a> = (Shader, Result<&'a Comparison, &'a str>);

impl Page {
    /// Starts `index.html` in `directory`, which is made if it is not there. The page begins with the text `about`.
    ///
    /// # Errors
    /// When the directory cannot be made or written.
    pub fn create(directory: &Path, about: &'static str) -> Result<Self> {
        fs::create_dir_all(directory).with_context(|| format!("cannot create the directory {}", directory.display()))?;
        Ok(Self { about, output: Output::create(&directory.join("index.html"))?, scenes: Vec::new() })
    }

    /// Adds a scene and its methods.
    ///
    /// # Errors
    /// When a picture cannot be encoded.
    pub fn add(&mut self, name: &str, exponent: Option<u16>, reference: &Reference<'_>, outcomes: &[Outcome<'_>]) -> Result<()> {
        let section = section(self.scenes.len(), name, exponent, reference, outcomes)?;
        self.scenes.push((name.to_owned(), section));
        Ok(())
    }

    /// Adds a scene and how smooth its outlines are by some methods.
    ///
    /// # Errors
    /// When a picture cannot be encoded.
    pub fn add_outlines(&mut self, name: &str, size: (u32, u32), smoothings: &[(Shader, Result<&Smoothing, &str>)]) -> Result<()> {
        let section = antialias::section(self.scenes.len(), name, size, smoothings)?;
        self.scenes.push((name.to_owned(), section));
        Ok(())
    }

    /// Writes the page and returns its path.
    ///
    /// # Errors
    /// When the page cannot be written; no part of it stays.
    pub fn finish(mut self) -> Result<PathBuf> {
        let path = self.output.path().to_owned();
        let page = page(self.about, &self.scenes).into_string();
        self.output.write_all(page.as_bytes()).with_context(|| format!("cannot write {}", path.display()))?;
        self.output.finish()?;
        Ok(path)
    }
}

fn page(about: &str, scenes: &[(String, Markup)]) -> Markup {
    let head = html! {
        p { (about) }
        @if scenes.len() > 1 {
            nav aria-label="Scenes" { ul { @for (index, (name, _)) in scenes.iter().enumerate() { li { a href={ "#scene-" (index) } { (name) } } } } }
        }
    };
    document("Shading methods compared", [STYLE, ""], &head, &html! { @for (_, section) in scenes { (section) } })
}

fn section(index: usize, name: &str, exponent: Option<u16>, reference: &Reference<'_>, outcomes: &[Outcome<'_>]) -> Result<Markup> {
    let (width, height) = reference.size();
    let window = reference.window();
    let truth = picture::rgb(window, &window.cut(&reference.picture(), width))?;
    let anchor = |shader: Shader| format!("scene-{index}-{}", shader.name());
    // Encoding pictures takes longer than all else here.
    let entry = |&(shader, result): &Outcome<'_>| result.map_or(Ok(html! {}), |c| entry(&anchor(shader), name, reference, c));
    let entries = outcomes.par_iter().map(entry).collect::<Result<Vec<_>>>()?;
    Ok(html! {
        section.scene id={ "scene-" (index) } {
            h2 { (name) }
            p.facts {
                (width) "×" (height) " pixels, "
                @match exponent { Some(exponent) => { "exponent " (exponent) } None => { "several exponents" } }
            }
            (table::table(name, outcomes, anchor))
            div.key {
                figure.truth {
                    img src=(truth) width=(window.width()) height=(window.height()) alt={ (name) " by Phong shading in floating point" };
                    figcaption { "What all are measured against: Phong shading in floating point" }
                }
                div.legends {
                    figure { (scale::signed(&format!("errors-{index}"))) figcaption { "Signed error, LSB: blue is too dark, red too bright. The scale is logarithmic beyond a quarter LSB." } }
                    figure {
                        (scale::amplified())
                        figcaption { "Amplified difference of 8-bit pixels, LSB: 255 (d/255)" sup { "1/10" } " of each channel (Vlasic 2002). It shows a single step." }
                    }
                    p.note { "Curves run along row " (reference.row()) ", through the highlight." }
                }
            }
            @for entry in &entries { (entry) }
        }
    })
}

fn entry(anchor: &str, scene: &str, reference: &Reference<'_>, comparison: &Comparison) -> Result<Markup> {
    let (width, _) = reference.size();
    let window = reference.window();
    let name = comparison.shader.name();
    let drawn = window.cut(&comparison.picture, width);
    let rendering = picture::rgb(window, &drawn)?;
    let amplified = picture::amplified(window, &drawn, &window.cut(&reference.picture(), width))?;
    let signed = picture::signed(window, &window.cut(&comparison.errors, width))?;
    let panel = |class: &str, source: &str, alt: &str, caption: &str| panel(window, class, source, alt, caption);
    let total = comparison.total;
    Ok(html! {
        article.method id=(anchor) {
            h3 { (name) }
            p.facts { "largest error " (number(total.max)) ", root mean square " (number(total.rmse)) " LSB" }
            @if let Some((budget, choices)) = comparison.budget.zip(comparison.choices) {
                p.facts { "within a budget of " (budget) " LSB: triangles above, their pixels below, by what shades them" }
                (shares(&choices))
                (key())
            }
            div.panels {
                (panel("picture", &rendering, &format!("{scene} by {name}"), "rendering"))
                (panel("amplified", &amplified, &format!("where {name} differs from Phong shading, amplified"), "difference, amplified"))
                (panel("signed", &signed, &format!("error of {name} with its sign"), "error with its sign"))
                figure { (chart::scanline(reference, comparison)) figcaption { "along row " (reference.row()) } }
            }
        }
    })
}

/// A picture and what it shows.
fn panel(window: &Window, class: &str, source: &str, alt: &str, caption: &str) -> Markup {
    html! {
        figure {
            img class=(class) src=(source) width=(window.width()) height=(window.height()) alt=(alt);
            figcaption { (caption) }
        }
    }
}

/// A number with as many places as mean something.
fn number(value: f64) -> String {
    let places = if value.abs() >= 99.95 {
        0
    } else if value.abs() >= 9.995 {
        1
    } else {
        2
    };
    format!("{value:.places$}")
}
