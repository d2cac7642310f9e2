//! Tables of highlights. Materials with equal highlights share one: in three channels, and under several lights, these are all materials of one exponent.

use crate::{lighting::reflectance::Reflectance, math::highlight_lut::HighlightLut};

/// Gives material number `index`, which has no table, the table of another material with equal highlights. If there is none, it gets a table that no
/// material has, which is filled.
pub(crate) fn assign(materials: &mut [Reflectance], index: usize, tables: &mut [HighlightLut]) {
    let Some(curve) = materials.get(index).map(|material| material.highlights) else { return };
    let shared = materials.iter().find(|other| other.table != 0 && other.highlights == curve).map(|other| other.table);
    let table = shared.or_else(|| {
        let is_free = |&table: &u16| materials.iter().all(|material| material.table != table);
        let (number, table) = (1..).zip(tables).find(|(number, _)| is_free(number))?;
        table.fill(&curve);
        Some(number)
    });
    if let (Some(material), Some(table)) = (materials.get_mut(index), table) {
        material.table = table;
    }
}

/// The number of tables that all `materials` need; 0 if each has one.
pub(crate) fn lacking(materials: &[Reflectance]) -> usize {
    let is_first =
        |&(index, material): &(usize, &Reflectance)| materials.iter().take(index).all(|other| other.highlights != material.highlights);
    let is_lacking = materials.iter().any(|material| material.table == 0);
    if is_lacking { materials.iter().enumerate().filter(is_first).count() } else { 0 }
}
