//! Our figures beside theirs.

use super::{Frame, PEERS};
use crate::{Measurement, Processor};
use anyhow::{Context, Result, bail};
use microphong_boards::budget::PICO;
use microphong_models::scene::PEER;

/// A renderer's method.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Renderer and method.
    pub name: String,
    /// Instructions per pixel on each processor; `None` where nobody has measured.
    pub figures: Vec<Option<f64>>,
    /// A remark on these figures.
    pub note: String,
}

/// Instructions per pixel of all renderers, for one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The scene's name.
    pub scene: String,
    /// The columns.
    pub processors: Vec<Processor>,
    /// Rows: first our methods, then renderers of crates.io, then figures that were measured once.
    pub rows: Vec<Row>,
}

impl Table {
    /// Whatever has been measured of a scene on these processors, and what was measured once.
    ///
    /// # Errors
    /// When the file of earlier figures is damaged.
    pub fn new(scene: &str, ours: &[Measurement], peers: &[Frame], processors: &[Processor]) -> Result<Self> {
        let ours: Vec<_> = ours.iter().filter(|m| m.scene == scene).collect();
        let mut methods: Vec<&str> = Vec::new();
        for m in &ours {
            if !methods.contains(&m.shader) {
                methods.push(m.shader);
            }
        }
        let own = methods.into_iter().map(|method| {
            let find = |&cpu: &Processor| ours.iter().find(|m| m.board == cpu && m.shader == method).map(|m| m.instr_per_pixel);
            Row { name: format!("microphong {method}"), figures: processors.iter().map(find).collect(), note: String::new() }
        });
        let theirs = PEERS.iter().map(|peer| {
            let frames: Vec<_> = peers.iter().filter(|p| p.scene == scene && p.shader == peer.name).collect();
            let find = |cpu: &Processor| frames.iter().find(|p| p.cpu == cpu.name()).map(|p| p.instr_per_pixel);
            let lacks: Vec<_> = frames.iter().take(1).flat_map(|frame| &frame.lacks).map(ToString::to_string).collect();
            let note = if lacks.is_empty() { String::new() } else { format!("without {}", lacks.join(", ")) };
            Row { name: peer.name.to_owned(), figures: processors.iter().map(find).collect(), note }
        });
        let earlier = if scene == PEER { earlier(processors)? } else { Vec::new() };
        Ok(Self { scene: scene.to_owned(), processors: processors.to_vec(), rows: own.chain(theirs).chain(earlier).collect() })
    }

    /// A remark on the columns.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let rows = PICO.layout.rows;
        self.processors
            .contains(&Processor::CortexM0Plus)
            .then(|| format!("cortex-m0plus: ours on the Pico in bands of {rows} rows, theirs as ARMv6-M code on a Cortex-M3 in one band"))
    }
}

/// Figures that were measured once, on some processors.
fn earlier(processors: &[Processor]) -> Result<Vec<Row>> {
    let mut lines =
        include_str!("earlier.csv").lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().context("no head in the file of earlier figures")?;
    lines
        .map(|fields| {
            let [renderer, language, method, ..] = fields[..] else { bail!("{fields:?} in the file of earlier figures") };
            let figure = |processor: &Processor| {
                let Some(column) = head.iter().position(|name| *name == processor.name()) else { return Ok(None) };
                let field = fields.get(column).with_context(|| format!("{renderer} has no column {}", processor.name()))?;
                if field.is_empty() { Ok(None) } else { Ok(Some(field.parse()?)) }
            };
            let figures = processors.iter().map(figure).collect::<Result<_>>()?;
            Ok(Row { name: format!("{renderer} ({language}) {method}"), figures, note: "measured once, not by this command".to_owned() })
        })
        .collect()
}

/// A figure with three digits.
#[must_use]
pub fn short(figure: f64) -> String {
    if figure < 99.95 { format!("{figure:.1}") } else { format!("{figure:.0}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_figures_can_be_read() {
        let measured = [Processor::CortexM3, Processor::CortexM4F, Processor::CortexM0Plus, Processor::X86_64];
        let rows = earlier(&measured).expect("figures");
        assert_eq!(rows.len(), 8);
        let tgx = rows.iter().find(|row| row.name == "TGX 1.1.4 (C++) gouraud").expect("a row");
        assert_eq!(tgx.figures, [204.0, 41.9, 476.0, 38.2].map(Some));
        assert!(rows.iter().all(|row| row.figures[3].is_some()));
        let others: Vec<_> = Processor::ALL.into_iter().filter(|processor| !measured.contains(processor)).collect();
        assert!(earlier(&others).expect("figures").iter().all(|row| row.figures.iter().all(Option::is_none)));
    }
}
