//! Outputs of plug-ins: quantities that laws and solvers declare on their cards.

use serde::{Deserialize, Serialize};
use voussoir_core::plugin::{Card, Output, OutputOf, PluginKind};

/// The values of one output in a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutputEntry {
    /// Tag of the plug-in.
    pub plugin: String,
    /// Its kind: `interface_law`, `bulk_material`, `limit_solver` or `path_solver`.
    pub kind: String,
    /// Name of the output.
    pub name: String,
    /// Its SI unit; `-` for a pure number.
    pub unit: String,
    /// The things that it has one value for.
    pub of: OutputOf,
    /// Index of the joint or of the block of each value; empty for the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<usize>,
    /// For points: position of each value in the undeformed scene \[m\].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub positions: Vec<[f64; 2]>,
    /// The values; `null` if a value is not finite.
    pub values: Vec<Option<f64>>,
}

/// Returns the word for a kind of plug-in in results.
pub fn kind_name(kind: PluginKind) -> String {
    kind.describe().replace(' ', "_")
}

impl OutputEntry {
    /// Creates an entry without values.
    pub fn new(card: &Card, output: &Output) -> Self {
        OutputEntry {
            plugin: card.tag.into(),
            kind: kind_name(card.kind),
            name: output.name.into(),
            unit: output.unit.into(),
            of: output.of,
            places: Vec::new(),
            positions: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Returns true if the output is of a law of joints or of a material: it follows from the stored state.
    pub fn is_of_law(&self) -> bool {
        [PluginKind::InterfaceLaw, PluginKind::BulkMaterial].map(kind_name).contains(&self.kind)
    }

    /// Returns true if its places are blocks.
    pub fn is_of_blocks(&self) -> bool {
        self.kind == kind_name(PluginKind::BulkMaterial)
    }

    /// Returns the index of the greatest value.
    pub fn greatest(&self) -> Option<usize> {
        let known = self.values.iter().enumerate().filter_map(|(index, value)| Some((index, (*value)?)));
        known.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|(index, _)| index)
    }

    /// Returns the declaration on the card of its plug-in.
    pub fn declaration(&self) -> Option<&'static Output> {
        let cards = voussoir_core::plugin::cards().iter();
        let mut own = cards.filter(|card| card.tag == self.plugin && kind_name(card.kind) == self.kind);
        own.next()?.outputs.iter().find(|output| output.name == self.name)
    }

    /// Returns the name with the unit, for headers of files.
    pub fn header(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }

    /// Returns a note if values are not finite.
    pub fn note(&self) -> Option<String> {
        let missing = self.values.iter().filter(|value| value.is_none()).count();
        (missing > 0).then(|| {
            format!(
                "{}: {missing} of {} values of the output \"{}\" are not finite; null is stored",
                self.plugin,
                self.values.len(),
                self.name
            )
        })
    }
}

/// An output of a study that tables have a column for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputColumn {
    /// Tag of the plug-in.
    pub plugin: String,
    /// Kind of the plug-in.
    pub kind: String,
    /// Name of the output.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The things that it has one value for.
    pub of: OutputOf,
}

impl OutputColumn {
    /// The column of an entry.
    pub fn of(entry: &OutputEntry) -> Self {
        let OutputEntry { plugin, kind, name, unit, of, .. } = entry.clone();
        OutputColumn { plugin, kind, name, unit, of }
    }

    /// Returns the value among the outputs of a case at a joint or a block, or the value of the case.
    pub fn value(&self, outputs: &[OutputEntry], place: Option<usize>) -> Option<f64> {
        let entry = outputs.iter().find(|entry| OutputColumn::of(entry) == *self)?;
        let index = place.map_or(Some(0), |place| entry.places.iter().position(|own| *own == place))?;
        *entry.values.get(index)?
    }

    /// Returns its name among all columns: with the tag of the plug-in if two plug-ins have an output of this name.
    pub fn name_among(&self, all: &[OutputColumn]) -> String {
        let alike = all.iter().filter(|other| other.of == self.of && other.name == self.name).count();
        if alike > 1 { format!("{}.{}", self.plugin, self.name) } else { self.name.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: Output = Output::point("damage", "-", "damage");

    fn entry(values: &[Option<f64>]) -> OutputEntry {
        let card = Card { kind: PluginKind::BulkMaterial, tag: "own", ..Card::BLANK };
        OutputEntry { values: values.to_vec(), ..OutputEntry::new(&card, &OUTPUT) }
    }

    #[test]
    fn the_greatest_value_and_the_missing_ones_are_found() {
        let found = entry(&[Some(-2.0), None, Some(3.0), Some(3.0)]);
        assert_eq!(found.greatest(), Some(2));
        let note = "own: 1 of 4 values of the output \"damage\" are not finite; null is stored";
        assert_eq!(found.note().as_deref(), Some(note));
        assert_eq!((entry(&[None]).greatest(), entry(&[Some(1.0)]).note()), (None, None));
        assert_eq!((found.header().as_str(), found.kind.as_str()), ("damage [-]", "bulk_material"));
    }
}
