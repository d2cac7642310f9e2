//! The picture that is shown when there is nothing else to show.

use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_6X10},
    prelude::*,
    text::{Baseline, Text},
};

/// Fills `target` and writes `message` on it, broken into lines between words.
///
/// # Errors
/// Errors of the target.
pub fn error_picture<D: DrawTarget>(target: &mut D, background: D::Color, ink: D::Color, message: &str) -> Result<(), D::Error> {
    target.clear(background)?;
    let style = MonoTextStyle::new(&FONT_6X10, ink);
    let area = target.bounding_box();
    let columns = (area.size.width / FONT_6X10.character_size.width) as usize;
    let mut corner = area.top_left;
    let mut rest = message;
    while !rest.is_empty() {
        let (line, tail) = split_line(rest, columns.max(1));
        Text::with_baseline(line, corner, style, Baseline::Top).draw(target)?;
        corner.y += FONT_6X10.character_size.height as i32;
        rest = tail;
    }
    Ok(())
}

/// Splits off a line of at most `columns` characters, at the last space if there is one.
fn split_line(text: &str, columns: usize) -> (&str, &str) {
    let Some((limit, _)) = text.char_indices().nth(columns) else {
        return (text, "");
    };
    // `split_at` would bring 5 KB of code for its panic.
    let (head, tail) = text.split_at_checked(limit).unwrap_or((text, ""));
    if tail.starts_with(' ') {
        return (head, tail.trim_start());
    }
    match head.rsplit_once(' ') {
        Some((line, _)) => (line, text.get(line.len()..).unwrap_or("").trim_start()),
        None => (head, tail),
    }
}
