//! Tables of highlights. Materials with equal highlights share one: in three channels, and under several lights, these are all materials of one exponent.
//! Materials without highlights need none, except greys whose table holds levels.

use crate::{lighting::reflectance::Reflectance, math::highlight_lut::HighlightLut};

/// Gives material number `index`, which has no table, the table of another material with equal highlights. If there is none, it gets a table that no
/// material has, which is filled.
pub(crate) fn assign(materials: &mut [Reflectance], index: usize, tables: &mut [HighlightLut]) {
    let Some(&Reflectance { highlights: curve, .. }) = materials.get(index) else { return };
    if let Some(matt) = materials.get_mut(index).filter(|material| material.is_matt()) {
        // What its entries say does not matter: they are multiplied by 0.
        matt.table = 1;
        return;
    }
    let shared = materials.iter().find(|other| other.table != 0 && !other.is_matt() && other.highlights == curve).map(|other| other.table);
    let table = shared.or_else(|| {
        let is_free = |&table: &u16| materials.iter().all(|material| material.is_matt() || material.table != table);
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
    let glossy = || materials.iter().enumerate().filter(|(_, material)| !material.is_matt());
    let is_first = |&(index, material): &(usize, &Reflectance)| {
        glossy().take_while(|&(other, _)| other < index).all(|(_, other)| other.highlights != material.highlights)
    };
    let is_lacking = materials.iter().any(|material| material.table == 0);
    if is_lacking { glossy().filter(is_first).count() } else { 0 }
}
