//! Fields of a TOML text. Each is taken by its name and checked. An error has a place: a line and a name.

use anyhow::{Error, Result, anyhow, ensure};
use std::{
    fmt,
    ops::{Bound, Range, RangeBounds, RangeInclusive},
};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// Most characters of a text that an error quotes.
const QUOTED: usize = 80;

/// A text as errors quote it: in one line, and not all of a long one.
pub(crate) fn quoted(text: &str) -> String {
    let printed: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(QUOTED + 1).collect();
    match printed.char_indices().nth(QUOTED) {
        Some(_) => printed.chars().take(QUOTED - 1).chain(['…']).collect(),
        None => printed,
    }
}

/// A place in a text.
#[derive(Clone)]
pub(crate) struct Place<'a> {
    text: &'a str,
    span: Range<usize>,
    /// Name of the place, such as `object 2: at`; empty for the whole text.
    name: String,
}

impl<'a> Place<'a> {
    /// A part of this place.
    fn part(&self, name: impl fmt::Display, span: Range<usize>) -> Self {
        let name = if self.name.is_empty() { name.to_string() } else { format!("{}: {name}", self.name) };
        Self { name, span, ..*self }
    }

    /// An error at this place.
    pub(crate) fn error(&self, what: impl fmt::Display) -> Error {
        anyhow!("{self}: {what}")
    }

    /// The text at this place.
    fn source(&self) -> String {
        quoted(self.text.get(self.span.clone()).unwrap_or_default())
    }
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = 1 + self.text.bytes().take(self.span.start).filter(|&byte| byte == b'\n').count();
        let colon = if self.name.is_empty() { "" } else { ": " };
        write!(f, "line {line}{colon}{}", self.name)
    }
}

/// Fields by their names.
pub(crate) struct Table<'a> {
    pub(crate) place: Place<'a>,
    values: DeTable<'a>,
    /// Fields that were asked for, and the places of fields that exist.
    known: Vec<(&'static str, Option<Range<usize>>)>,
}

impl<'a> Table<'a> {
    /// The fields of a whole text.
    pub(crate) fn parse(text: &'a str) -> Result<Self> {
        let place = Place { text, span: 0..0, name: String::new() };
        let values = DeTable::parse(text).map_err(|error| {
            let here = Place { span: error.span().unwrap_or(text.len()..text.len()), ..place.clone() };
            let before = &text[..text.floor_char_boundary(here.span.start)];
            let start = before.rfind('\n').map_or(0, |end| end + 1);
            // What comes before the fault may be long.
            let start = before[start..].char_indices().rev().nth(QUOTED / 2).map_or(start, |(skipped, _)| start + skipped);
            let line = quoted(text[start..].lines().next().unwrap_or_default());
            here.error(format!("{}: `{line}`", quoted(error.message())))
        })?;
        Ok(Self { place, values: values.into_inner(), known: Vec::new() })
    }

    /// A field that may be left out.
    pub(crate) fn get<T>(&mut self, name: &'static str, read: impl FnOnce(Field<'a>) -> Result<T>) -> Result<Option<T>> {
        let value = self.values.remove(name);
        self.known.push((name, value.as_ref().map(Spanned::span)));
        value.map(|value| read(Field::new(&self.place, name, value))).transpose()
    }

    /// A field that may not be left out.
    pub(crate) fn need<T>(&mut self, name: &'static str, read: impl FnOnce(Field<'a>) -> Result<T>) -> Result<T> {
        self.get(name, read)?.ok_or_else(|| self.place.error(format!("`{name}` is missing")))
    }

    /// A list of tables, which may be left out. Errors call each by the name `one` and its number.
    pub(crate) fn list(&mut self, name: &'static str, one: &str, most: usize) -> Result<Vec<Table<'a>>> {
        let place = self.place.clone();
        let tables = self.get(name, |field| {
            let Field { place: all, value: DeValue::Array(array) } = field else { return Err(field.wrong("a list of tables")) };
            let count = array.len();
            ensure!(count <= most, all.error(format!("there are {count}; at most {most} are possible")));
            let table = |(i, value)| Field::new(&place, format_args!("{one} {}", i + 1), value).table();
            array.into_iter().enumerate().map(table).collect()
        })?;
        Ok(tables.unwrap_or_default())
    }

    /// The place of a field that was asked for, or the place of the table if the field was left out.
    pub(crate) fn place_of(&self, name: &'static str) -> Place<'a> {
        self.place_of_any(&[name])
    }

    /// The place of the first of these fields that exists.
    pub(crate) fn place_of_any(&self, names: &[&'static str]) -> Place<'a> {
        let stands = |name| self.known.iter().find_map(|(known, span)| if *known == name { span.clone() } else { None });
        match names.iter().find_map(|&name| Some((name, stands(name)?))) {
            Some((name, span)) => self.place.part(name, span),
            None => self.place.part(names[0], self.place.span.clone()),
        }
    }

    /// No other fields are there.
    pub(crate) fn end(&self) -> Result<()> {
        let Some((key, _)) = self.values.iter().min_by_key(|(key, _)| key.span().start) else { return Ok(()) };
        let names: Vec<_> = self.known.iter().map(|(name, _)| *name).collect();
        let place = Place { span: key.span(), ..self.place.clone() };
        Err(place.error(format!("unknown field `{}`; there are {}", quoted(key.get_ref()), names.join(", "))))
    }
}

/// A value, and where it stands.
pub(crate) struct Field<'a> {
    pub(crate) place: Place<'a>,
    value: DeValue<'a>,
}

impl<'a> Field<'a> {
    fn new(parent: &Place<'a>, name: impl fmt::Display, value: Spanned<DeValue<'a>>) -> Self {
        Self { place: parent.part(name, value.span()), value: value.into_inner() }
    }

    /// The error that the value is not what is `wanted`.
    fn wrong(&self, wanted: impl fmt::Display) -> Error {
        self.place.error(format!("{} is not possible; it must be {wanted}", self.place.source()))
    }

    /// A number in a range.
    pub(crate) fn number(self, range: &impl RangeBounds<f64>) -> Result<f64> {
        let number = match &self.value {
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        number.filter(|number| range.contains(number)).ok_or_else(|| self.wrong(format!("a number {}", allowed(range))))
    }

    /// A whole number in a range.
    pub(crate) fn integer(self, range: &RangeInclusive<u32>) -> Result<u32> {
        let integer = match &self.value {
            DeValue::Integer(integer) => u32::from_str_radix(integer.as_str(), integer.radix()).ok(),
            _ => None,
        };
        integer.filter(|integer| range.contains(integer)).ok_or_else(|| self.wrong(format!("a whole number {}", allowed(range))))
    }

    /// `N` values. Each has the name of all, and its own line.
    pub(crate) fn array<T, const N: usize>(self, each: impl Fn(Field<'a>) -> Result<T>) -> Result<[T; N]> {
        let wrong = |field: &Self| field.wrong(format!("a list of {N} numbers"));
        if !matches!(&self.value, DeValue::Array(array) if array.len() == N) {
            return Err(wrong(&self));
        }
        let Self { place, value: DeValue::Array(array) } = self else { unreachable!("a list") };
        let each =
            |value: Spanned<DeValue<'a>>| each(Field { place: Place { span: value.span(), ..place.clone() }, value: value.into_inner() });
        let values = array.into_iter().map(each).collect::<Result<Vec<_>>>()?;
        values.try_into().map_err(|_| unreachable!("{N} values"))
    }

    /// `N` numbers in a range.
    pub(crate) fn numbers<const N: usize>(self, range: &impl RangeBounds<f64>) -> Result<[f64; N]> {
        self.array(|number| number.number(range))
    }

    /// A text.
    pub(crate) fn text(self) -> Result<String> {
        match self.value {
            DeValue::String(text) => Ok(text.into_owned()),
            _ => Err(self.wrong("a text in quotes")),
        }
    }

    /// `true` or `false`.
    pub(crate) fn flag(self) -> Result<bool> {
        match self.value {
            DeValue::Boolean(flag) => Ok(flag),
            _ => Err(self.wrong("true or false")),
        }
    }

    /// Whether the value has fields of its own.
    pub(crate) fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// Whether the value is a text.
    pub(crate) fn is_text(&self) -> bool {
        self.value.is_str()
    }

    /// Fields of its own.
    pub(crate) fn table(self) -> Result<Table<'a>> {
        match self.value {
            DeValue::Table(values) => Ok(Table { place: self.place, values, known: Vec::new() }),
            _ => Err(self.wrong("a table of fields")),
        }
    }
}

/// A range in words; it has a beginning.
fn allowed<T: fmt::Display>(range: &impl RangeBounds<T>) -> String {
    let from = match range.start_bound() {
        Bound::Included(from) | Bound::Excluded(from) => from.to_string(),
        Bound::Unbounded => String::new(),
    };
    match range.end_bound() {
        Bound::Included(to) => format!("from {from} to {to}"),
        Bound::Excluded(to) => format!("from {from} to less than {to}"),
        Bound::Unbounded => format!("from {from} on"),
    }
}
