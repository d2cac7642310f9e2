//! Lines and names of text files, as many programs write them.

use std::collections::HashMap;

/// The text of a file: UTF-8, and where a line is not, each byte a character of its own. So names in another encoding stay different from one another,
/// and the same name is the same text in every file. A text that begins with the mark of UTF-16 is read as that, as every reader of XML has to.
pub(crate) fn decoded(bytes: &[u8]) -> String {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = bytes.as_chunks().0.iter().map(|&pair| unit(pair));
        char::decode_utf16(units).map(|char| char.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    match bytes {
        [0xFF, 0xFE, text @ ..] => return wide(text, u16::from_le_bytes),
        [0xFE, 0xFF, text @ ..] => return wide(text, u16::from_be_bytes),
        _ => {}
    }
    if let Ok(text) = str::from_utf8(bytes) {
        return text.to_owned();
    }
    let line = |line: &[u8]| str::from_utf8(line).map_or_else(|_| line.iter().copied().map(char::from).collect(), str::to_owned);
    bytes.split_inclusive(|&byte| byte == b'\n' || byte == b'\r').map(line).collect()
}

/// The text with LF at the ends of its lines, no byte order mark, and neither padding nor the mark by which old programs ended a text.
pub(crate) fn plain(text: &str) -> String {
    text.strip_prefix('\u{FEFF}').unwrap_or(text).trim_end_matches(['\0', '\u{1A}']).replace("\r\n", "\n").replace('\r', "\n")
}

/// The part of a line after its first word.
pub(crate) fn rest(line: &str) -> String {
    line.trim().split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim()).to_owned()
}

/// The first word of a line in small letters: some programs write statements in capitals.
pub(crate) fn keyword(line: &str) -> String {
    line.split_whitespace().next().unwrap_or_default().to_ascii_lowercase()
}

/// Whether a statement is followed by a name, in which `#` and `\` are characters as others.
fn takes_a_name(keyword: &str) -> bool {
    ["o", "g", "usemtl", "newmtl", "mtllib", "usemap", "maplib"].contains(&keyword) || keyword.starts_with("map_")
}

/// The lines of a text, with their numbers; a backslash at the end joins the next line. Comments are left out, but not behind names, where
/// [`without_comment`] does it.
pub(crate) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let has_name = takes_a_name(&keyword(first));
        let content = |line: &str| if has_name { line.trim_end().to_owned() } else { without_numbers_comment(line).to_owned() };
        let mut line = content(first);
        // In some encodings a character of a name ends with the byte of a backslash.
        while line.ends_with('\\') && (!has_name || line.ends_with(" \\") || line.ends_with("\t\\")) {
            line.pop();
            line.push(' ');
            line.push_str(&lines.next().map_or(String::new(), |(_, next)| content(next)));
        }
        Some((index + 1, line))
    })
}

/// A line of numbers up to its comment. In `1.#QNAN`, which is not a number in the way of Windows, `#` begins none.
fn without_numbers_comment(line: &str) -> &str {
    let comment = line.match_indices('#').find(|(at, _)| !line[..*at].ends_with("1."));
    line[..comment.map_or(line.len(), |(at, _)| at)].trim_end()
}

/// A name up to its comment, which begins with `#` between blanks. `Material__#25` and `Material #112` are names.
pub(crate) fn without_comment(name: &str) -> &str {
    let is_blank = |c: Option<char>| c.is_none_or(char::is_whitespace);
    let comment =
        name.match_indices('#').find(|(at, _)| is_blank(name[..*at].chars().next_back()) && is_blank(name[at + 1..].chars().next()));
    name[..comment.map_or(name.len(), |(at, _)| at)].trim_end()
}

/// Names without comments. If names would become equal that differ behind `#`, this was no comment, and they keep it.
pub(crate) fn without_comments(names: &[&str]) -> Vec<String> {
    // Of the names that become one, one that has a comment, and whether there are others.
    let mut commented: HashMap<&str, (&str, bool)> = HashMap::new();
    for &name in names {
        let short = without_comment(name);
        if short != name {
            let (first, has_others) = commented.entry(short).or_insert((name, false));
            *has_others |= *first != name;
        }
    }
    let keeps = |name: &str| {
        let short = without_comment(name);
        short.is_empty() || short != name && commented.get(short).is_some_and(|&(_, has_others)| has_others)
    };
    names.iter().map(|&name| if keeps(name) { name } else { without_comment(name) }.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_in_any_encoding_keeps_names_apart() {
        // Latin-1, Shift JIS, and UTF-8 in one file.
        let text = decoded(b"usemtl Rot\xE4\nusemtl Rot\xF6\r\nusemtl \x95\x5C\nusemtl \x90\x5C\nusemtl Rot\xC3\xA4");
        let lines: Vec<_> = logical_lines(&plain(&text)).map(|(_, line)| rest(&line)).collect();
        assert_eq!(lines, ["Rotä", "Rotö", "\u{95}\\", "\u{90}\\", "Rotä"]);
    }

    #[test]
    fn text_of_wide_characters_is_read_by_its_mark() {
        let text = "<a name=\"Würfel 🎲\"/>";
        let bytes =
            |bytes_of: fn(u16) -> [u8; 2]| "\u{FEFF}".encode_utf16().chain(text.encode_utf16()).flat_map(bytes_of).collect::<Vec<_>>();
        for mut wide in [bytes(u16::to_le_bytes), bytes(u16::to_be_bytes)] {
            assert_eq!(decoded(&wide), text);
            wide.truncate(wide.len() - 1);
            assert_eq!(decoded(&wide), text.strip_suffix('>').unwrap());
        }
    }

    #[test]
    fn comments_begin_where_no_name_or_number_goes_on() {
        let lines = |text: &str| logical_lines(text).map(|(_, line)| line).collect::<Vec<_>>();
        assert_eq!(lines("v 1 2#x\nv 1 1.#QNAN -1.#IND # y\n# z\nf 1 2\\\n 3"), ["v 1 2", "v 1 1.#QNAN -1.#IND", "", "f 1 2  3"]);
        assert_eq!(lines("G a \\\nb\nusemtl a\\\nv 1"), ["G a  b", "usemtl a\\", "v 1"]);
        for (name, short) in [
            ("Material__#25", "Material__#25"),
            ("Material #112", "Material #112"),
            ("red paint # dry", "red paint"),
            ("red #", "red"),
            ("#1", "#1"),
            ("# 1", ""),
            ("a # b # c", "a"),
        ] {
            assert_eq!(without_comment(name), short, "{name}");
        }
        let names = ["Material # 1", "Material # 2", "red # dry", "red", "blue # 3", "# 4"];
        assert_eq!(without_comments(&names), ["Material # 1", "Material # 2", "red", "red", "blue", "# 4"]);
    }
}
