//! Attributes of elements in the XML of a 3MF file.
//!
//! Prefixes of names are left out: no two namespaces that are read have elements or attributes of the same name at the same place.

use crate::{fields::quoted, obj::LARGEST};
use anyhow::{Context, Result, anyhow, bail, ensure};
use quick_xml::{escape::unescape, events::BytesStart};
use std::borrow::Cow;

/// The value of an attribute.
pub(super) struct Attribute<'a> {
    name: &'static str,
    /// The name as it is written.
    value: Cow<'a, str>,
}

/// The attributes of these names, in their order. Of several of one name the first counts.
pub(super) fn attributes<'a, const N: usize>(tag: &'a BytesStart<'_>, names: [&'static str; N]) -> Result<[Option<Attribute<'a>>; N]> {
    let mut found = [const { None }; N];
    // The library would compare each name with all names before it, and so take very long for very many.
    for attribute in tag.attributes().with_checks(false) {
        let Ok(attribute) = attribute else {
            bail!("an attribute of <{}> is not written as name=\"value\"; export the model again", quoted(tag.name().as_ref()))
        };
        let name = attribute.key.local_name();
        if let Some(index) = names.iter().position(|&wanted| wanted == name.as_ref())
            && found[index].is_none()
        {
            found[index] = Some(Attribute { name: names[index], value: attribute.value });
        }
    }
    Ok(found)
}

/// An attribute that may not be left out.
pub(super) fn needed<'a>(attribute: Option<Attribute<'a>>, name: &str) -> Result<Attribute<'a>> {
    attribute.with_context(|| format!("{name} is missing"))
}

impl Attribute<'_> {
    /// What is written.
    pub(super) fn value(&self) -> &str {
        &self.value
    }

    /// The text, or what is written if it has a reference to what is unknown.
    pub(super) fn text(&self) -> Cow<'_, str> {
        unescape(&self.value).unwrap_or(Cow::Borrowed(&self.value))
    }

    fn wrong(&self, what: &str) -> anyhow::Error {
        anyhow!("{} is \"{}\", not {what}", self.name, quoted(&self.value))
    }

    /// A number that a coordinate can have.
    pub(super) fn number(&self) -> Result<f64> {
        let number: f64 = self.value.trim().parse().ok().with_context(|| self.wrong("a number"))?;
        ensure!(
            number.is_finite() && number.abs() <= LARGEST,
            "{} is {}; coordinates must be finite and below {LARGEST:e}",
            self.name,
            quoted(&self.value)
        );
        Ok(number)
    }

    /// The number of an element, from 0 on.
    pub(super) fn index(&self) -> Result<u32> {
        self.value.trim().parse().ok().with_context(|| self.wrong("a whole number from 0 on"))
    }

    /// `N` numbers with blanks between them.
    pub(super) fn numbers<const N: usize>(&self) -> Result<[f64; N]> {
        let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite() && number.abs() <= LARGEST);
        let numbers: Option<Vec<f64>> = self.value.split_whitespace().take(N + 1).map(number).collect();
        let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
        numbers.with_context(|| self.wrong(&format!("{N} numbers with blanks between them")))
    }

    /// A colour of sRGB and its opacity, from 0 to 1: `#RRGGBB` or `#RRGGBBAA`.
    pub(super) fn colour(&self) -> Result<([f64; 3], f64)> {
        let wrong = || self.wrong("a colour, which is # and 6 or 8 hexadecimal digits");
        let digits = self.value.trim().strip_prefix('#').filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let digits = digits.filter(|digits| [6, 8].contains(&digits.len())).with_context(wrong)?;
        let channel = |k: usize| u8::from_str_radix(&digits[2 * k..2 * k + 2], 16).map(|c| f64::from(c) / 255.0).ok().with_context(wrong);
        let opacity = if digits.len() == 6 { 1.0 } else { channel(3)? };
        Ok(([channel(0)?, channel(1)?, channel(2)?], opacity))
    }
}
