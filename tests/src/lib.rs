//! Cross-checks of whole programs; see the files in `tests/`.
