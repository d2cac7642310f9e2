//! Our figures beside theirs.

use super::{Frame, PEERS, SCENE};
use crate::{Measurement, Processor};
use anyhow::{Context, Result, bail};
use microphong_boards::budget::PICO;

/// Where a row's figures come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// microphong, measured now.
    Ours,
    /// Another renderer, measured now.
    Peer,
    /// Measured once.
    Earlier,
}

impl Source {
    /// What has to be known of such figures.
    #[must_use]
    pub const fn note(self) -> &'static str {
        match self {
            Self::Ours | Self::Peer => "",
            Self::Earlier => "measured once, not by this command",
        }
    }
}

/// A renderer's method.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Where its figures come from.
    pub source: Source,
    /// Renderer and method.
    pub name: String,
    /// Instructions per covered pixel on each processor; `None` where nobody has measured.
    pub figures: Vec<Option<f64>>,
}

/// Instructions per covered pixel of all renderers.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The columns.
    pub processors: Vec<Processor>,
    /// Ours, those of crates.io, those measured once.
    pub rows: Vec<Row>,
}

impl Table {
    /// Whatever has been measured on these processors, and what was measured once.
    ///
    /// # Errors
    /// When the file of earlier figures is damaged.
    pub fn new(ours: &[Measurement], peers: &[Frame], processors: &[Processor]) -> Result<Self> {
        let ours: Vec<_> = ours.iter().filter(|m| m.scene == SCENE).collect();
        let mut methods: Vec<&str> = Vec::new();
        for m in &ours {
            if !methods.contains(&m.shader) {
                methods.push(m.shader);
            }
        }
        let own = methods.into_iter().map(|method| {
            let find = |&cpu: &Processor| ours.iter().find(|m| m.board == cpu && m.shader == method).map(|m| m.instr_per_pixel);
            Row { source: Source::Ours, name: format!("microphong {method}"), figures: processors.iter().map(find).collect() }
        });
        let theirs = PEERS.into_iter().map(|peer| {
            let find = |cpu: &Processor| peers.iter().find(|p| p.cpu == cpu.name() && p.shader == peer).map(|p| p.instr_per_pixel);
            Row { source: Source::Peer, name: peer.to_owned(), figures: processors.iter().map(find).collect() }
        });
        Ok(Self { processors: processors.to_vec(), rows: own.chain(theirs).chain(earlier(processors)?).collect() })
    }

    /// What has to be known of its columns.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let rows = PICO.layout.rows;
        self.processors
            .contains(&Processor::CortexM0Plus)
            .then(|| format!("cortex-m0plus: ours on the Pico in bands of {rows} rows, theirs as ARMv6-M code on a Cortex-M3 in one band"))
    }
}

/// Figures that were measured once.
fn earlier(processors: &[Processor]) -> Result<Vec<Row>> {
    let mut lines =
        include_str!("earlier.csv").lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().context("no head in the file of earlier figures")?;
    lines
        .map(|fields| {
            let [renderer, language, method, ..] = fields[..] else { bail!("{fields:?} in the file of earlier figures") };
            let figure = |processor: &Processor| {
                let column = head.iter().position(|name| *name == processor.name()).context("a processor without a column")?;
                let field = fields.get(column).with_context(|| format!("{renderer} has no column {}", processor.name()))?;
                if field.is_empty() { Ok(None) } else { Ok(Some(field.parse()?)) }
            };
            let figures = processors.iter().map(figure).collect::<Result<_>>()?;
            Ok(Row { source: Source::Earlier, name: format!("{renderer} ({language}) {method}"), figures })
        })
        .collect()
}

/// To three digits.
#[must_use]
pub fn short(figure: f64) -> String {
    if figure < 99.95 { format!("{figure:.1}") } else { format!("{figure:.0}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_figures_can_be_read() {
        let rows = earlier(&Processor::ALL).expect("figures");
        assert_eq!(rows.len(), 8);
        let tgx = rows.iter().find(|row| row.name == "TGX 1.1.4 (C++) gouraud").expect("a row");
        assert_eq!(tgx.figures, [204.0, 41.9, 476.0, 38.2].map(Some));
        assert!(rows.iter().all(|row| row.figures[3].is_some()));
    }
}
