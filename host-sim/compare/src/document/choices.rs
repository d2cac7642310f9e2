//! Bars of the ways that the method `auto` chooses.

use maud::{Markup, html};
use microphong_render::choices::{Choices, Way};

/// Two bars, of triangles and of pixels, each divided as the ways to shade share it; the numbers are shown where one points.
#[must_use]
pub fn shares(choices: &Choices) -> Markup {
    let bar = |name: &str, of: usize| {
        let parts = Way::ALL.map(|way| (way, choices.percent(way)[of])).into_iter().filter(|&(_, percent)| percent > 0.0);
        let text: Vec<_> = parts.clone().map(|(way, percent)| format!("{} {percent:.1} %", way.name())).collect();
        let text = format!("{name}: {}", text.join(", "));
        html! {
            span.shares role="img" aria-label=(text) title=(text) {
                @for (way, percent) in parts { span style={ "width:" (format!("{percent:.2}")) "%;background:" (colour(way)) } {} }
            }
        }
    };
    html! { (bar("triangles", 0)) (bar("pixels", 1)) }
}

/// The colours of the bars.
#[must_use]
pub fn key() -> Markup {
    html! {
        ul.ways { @for way in Way::ALL { li { span.dot style={ "background:" (colour(way)) } {} (way.name()) } } }
    }
}

fn colour(way: Way) -> String {
    let [r, g, b] = way.colour();
    format!("#{r:02x}{g:02x}{b:02x}")
}
