//! The frame of all reports: one HTML file with its style and its scripts inside.

pub mod choices;

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The colours of reports, for drawings outside of pages as well.
pub const COLOURS: &str = include_str!("colours.css");
const STYLE: &str = include_str!("style.css");
const SORT: &str = include_str!("sort.js");

/// A page with a style and a script of its own, besides the common ones. `head` stands under the title.
#[must_use]
pub fn document(title: &str, [style, script]: [&str; 2], head: &Markup, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(COLOURS)) (PreEscaped(STYLE)) (PreEscaped(style)) }
            }
            body {
                header { h1 { (title) } (head) }
                main { (body) }
                script { (PreEscaped(SORT)) (PreEscaped(script)) }
            }
        }
    }
}
