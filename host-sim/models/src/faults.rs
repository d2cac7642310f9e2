//! Wrong elements of a file that do not matter to the rest of it: counted by their kind, so that the user is told what was left out.

use crate::number::grouped;
use std::fmt;

/// A kind of wrong elements: what is said of one element, and of several.
pub(crate) type Kind = [&'static str; 2];

/// The wrong elements of a file, by their kinds, in the order in which they were found.
#[derive(Clone, Debug, Default)]
pub struct Faults(Vec<Fault>);

/// The wrong elements of one kind.
#[derive(Clone, Debug)]
struct Fault {
    kind: Kind,
    count: usize,
    /// The place of the first of them.
    first: String,
}

impl Faults {
    /// Counts an element, and keeps the place of the first one of its kind.
    pub(crate) fn add(&mut self, kind: Kind, place: impl FnOnce() -> String) {
        self.add_several(kind, 1, place);
    }

    /// Counts elements of one kind.
    pub(crate) fn add_several(&mut self, kind: Kind, count: usize, first: impl FnOnce() -> String) {
        match self.0.iter_mut().find(|fault| fault.kind == kind) {
            Some(fault) => fault.count += count,
            None if count > 0 => self.0.push(Fault { kind, count, first: first() }),
            None => {}
        }
    }

    /// The number of elements of a kind.
    pub(crate) fn count(&self, kind: Kind) -> usize {
        self.0.iter().find(|fault| fault.kind == kind).map_or(0, |fault| fault.count)
    }

    /// Says each kind in a sentence.
    pub fn sentences(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(Fault::to_string)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind: [one, several], count, first } = self;
        match count {
            1 => write!(f, "1 {one}: {first}"),
            count => write!(f, "{} {several}; the first: {first}", grouped(*count)),
        }
    }
}

/// A face that is no polygon.
pub(crate) const FEW_CORNERS: Kind =
    ["face has fewer than three corners and is left out", "faces have fewer than three corners and are left out"];
/// A position that no face needs.
pub(crate) const UNUSED_POSITION: Kind = [
    "vertex is not three finite numbers and is left out, because no face uses it",
    "vertices are not three finite numbers and are left out, because no face uses them",
];
/// A normal that no face needs.
pub(crate) const UNUSED_NORMAL: Kind = [
    "normal is not three finite numbers and is left out, because no face uses it",
    "normals are not three finite numbers and are left out, because no face uses them",
];
/// A normal in whose place one is computed.
pub(crate) const COMPUTED_NORMAL: Kind = [
    "corner has a normal without a direction; it is computed, and the others are those of the file",
    "corners have normals without a direction; they are computed, and the others are those of the file",
];
/// A face that was turned.
pub(crate) const TURNED: Kind = [
    "face was wound against its neighbours, or its closed part was inside out, and is turned",
    "faces were wound against their neighbours, or their closed parts were inside out, and are turned",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_counted_and_the_first_place_is_said() {
        let mut faults = Faults::default();
        faults.add_several(UNUSED_NORMAL, 0, || unreachable!("there are none"));
        for line in [7, 9] {
            faults.add(FEW_CORNERS, || format!("line {line}"));
        }
        faults.add(UNUSED_POSITION, || "line 8".to_owned());
        assert_eq!((faults.count(FEW_CORNERS), faults.count(UNUSED_NORMAL)), (2, 0));
        let said: Vec<_> = faults.sentences().collect();
        assert_eq!(
            said,
            [
                "2 faces have fewer than three corners and are left out; the first: line 7",
                "1 vertex is not three finite numbers and is left out, because no face uses it: line 8"
            ]
        );
    }
}
