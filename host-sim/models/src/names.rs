//! Names of objects: what a file has becomes what a stream can keep, and a program can tell apart.

use crate::fields::quoted;
use microphong::stream::MAX_NAME;
use std::collections::{HashMap, HashSet};

/// Makes names different, not empty and not too long, and adds a remark on each change. An empty list stays empty.
pub(crate) fn distinct(names: Vec<String>, remarks: &mut Vec<String>) -> Vec<String> {
    if matches!(&names[..], [name] if name.is_empty()) {
        return Vec::new();
    }
    let (mut taken, mut last) = (HashSet::new(), HashMap::new());
    let (mut cut, mut numbered) = (Vec::new(), Vec::new());
    let mut distinct = Vec::new();
    for (index, name) in names.into_iter().enumerate() {
        let name = if name.is_empty() { format!("object {index}") } else { name };
        if name.len() > MAX_NAME {
            cut.push(name.clone());
        }
        let mut unique = with_number(&name, "");
        if taken.contains(&unique) {
            let number = last.entry(unique).or_insert(1);
            unique = loop {
                *number += 1;
                let candidate = with_number(&name, &format!(" {number}"));
                if !taken.contains(&candidate) {
                    break candidate;
                }
            };
            numbered.push(unique.clone());
        }
        taken.insert(unique.clone());
        distinct.push(unique);
    }
    let mut remark = |what: &str, names: &[String]| {
        if let [first, rest @ ..] = names {
            let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
            remarks.push(format!("{what}: \"{}\"{more}", quoted(first)));
        }
    };
    remark(&format!("names of objects are cut to {MAX_NAME} bytes"), &cut);
    remark("objects of the same name have numbers", &numbered);
    distinct
}

/// The name with this ending, cut between characters so that both fit.
fn with_number(name: &str, ending: &str) -> String {
    format!("{}{ending}", &name[..name.floor_char_boundary(MAX_NAME - ending.len())])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_different_short_and_not_empty() {
        let long = "é".repeat(200);
        let names = ["needle", "", "needle", "needle 2", "needle", &long, &long].map(str::to_owned).to_vec();
        let mut remarks = Vec::new();
        let distinct = distinct(names, &mut remarks);
        assert_eq!(distinct[..5], ["needle", "object 1", "needle 2", "needle 2 2", "needle 3"]);
        assert_eq!([distinct[5].clone(), distinct[6].clone()], ["é".repeat(127), format!("{} 2", "é".repeat(126))]);
        let [cut, numbered] = &remarks[..] else { panic!("{remarks:?}") };
        assert!(cut.starts_with("names of objects are cut to 255 bytes: \"éé") && cut.ends_with("…\" and 1 more"), "{cut}");
        assert_eq!(numbered, "objects of the same name have numbers: \"needle 2\" and 3 more");
    }

    #[test]
    fn a_file_without_names_has_none() {
        for names in [vec![], vec![String::new()]] {
            let mut remarks = Vec::new();
            assert!(distinct(names, &mut remarks).is_empty() && remarks.is_empty());
        }
    }
}
