//! The part of a page about the outlines of a scene.

use super::{number, panel, picture, scale};
use crate::{
    Window,
    antialias::{Differences, Smoothing},
};
use anyhow::Result;
use maud::{Markup, html};
use microphong_render::shader::Shader;

/// The section of a scene: pictures and differences of each method, or the reason why there are none.
pub(super) fn section(
    index: usize,
    name: &str,
    (width, height): (u32, u32),
    smoothings: &[(Shader, Result<&Smoothing, &str>)],
) -> Result<Markup> {
    let window = Window { columns: 0..width, rows: 0..height };
    let entry = |&(shader, result): &(Shader, Result<&Smoothing, &str>)| match result {
        Ok(smoothing) => entry(&window, name, shader, smoothing),
        Err(reason) => Ok(html! { article.method { h3 { (shader.name()) } p.facts { (reason) } } }),
    };
    let entries = smoothings.iter().map(entry).collect::<Result<Vec<_>>>()?;
    Ok(html! {
        section.scene id={ "scene-" (index) } {
            h2 { (name) }
            p.facts { (width) "×" (height) " pixels" }
            figure {
                (scale::amplified())
                figcaption { "Amplified difference, LSB: 255 (d/255)" sup { "1/10" } " of each channel. It shows a single step." }
            }
            @for entry in &entries { (entry) }
        }
    })
}

fn entry(window: &Window, scene: &str, shader: Shader, smoothing: &Smoothing) -> Result<Markup> {
    let Smoothing { edges, smooth, plain, means, pictures } = smoothing;
    let means: Vec<_> = means.iter().map(|mean| mean.levels.map(|level| level.round() as u8)).collect();
    let name = shader.name();
    let facts = |Differences { edges_rmse, max, at: [x, y], .. }: &Differences| {
        format!("{} on edges, at most {} at ({x}, {y})", number(*edges_rmse), number(*max))
    };
    let [smooth_picture, plain_picture] = pictures;
    let shown = picture::rgb(window, smooth_picture)?;
    let exact = picture::rgb(window, &means)?;
    let [smooth_off, plain_off] = [picture::amplified(window, smooth_picture, &means)?, picture::amplified(window, plain_picture, &means)?];
    Ok(html! {
        article.method {
            h3 { (name) }
            p.facts { (edges) " pixels contain an edge; root mean square of differences there, LSB: smooth " (facts(smooth)) "; plain " (facts(plain)) }
            div.panels {
                (panel(window, "picture", &shown, &format!("{scene} by {name} with smooth outlines"), "smooth outlines"))
                (panel(window, "picture", &exact, &format!("{scene} by {name}, means of samples"), "means of 16×16 samples"))
                (panel(window, "amplified", &smooth_off, "where smooth outlines differ from the means, amplified", "difference of smooth outlines"))
                (panel(window, "amplified", &plain_off, "where plain outlines differ from the means, amplified", "difference of the plain picture"))
            }
        }
    })
}
