//! Links in the documents lead to files that are there.

use crate::golden::root;
use std::fs;

const DOCUMENTS: [&str; 8] = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "docs/design.md",
    "docs/proofs.md",
    "examples/README.md",
    "tests/meshes/README.md",
    "tests/scenes/README.md",
];

#[test]
fn links_lead_to_files() {
    let (mut links, mut broken) = (0, Vec::new());
    for document in DOCUMENTS {
        let path = root().join("..").join(document);
        let text = fs::read_to_string(&path).expect("a document");
        let folder = path.parent().expect("a folder");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target) {
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty() && !file.contains("://") {
                links += 1;
                if !folder.join(file).exists() {
                    broken.push(format!("{document}: {target}"));
                }
            }
        }
    }
    assert!(links > 100, "{links} links");
    assert!(broken.is_empty(), "{broken:#?}");
}
