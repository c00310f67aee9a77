//! Time and fields along a path. Within a load step both are linear in its factor.

use crate::model::Stage;

/// A field in a load step.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldChange {
    /// Name of the field.
    pub name: String,
    /// Value at the start.
    pub from: f64,
    /// Value at the end.
    pub to: f64,
}

/// Duration and fields of a load step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Period {
    /// Duration \[s\]; 0 if no time passes.
    pub duration: f64,
    /// Fields with their values at both ends.
    pub fields: Vec<FieldChange>,
}

impl Period {
    /// Returns the period in which the loads of a stage act: its fields go from the values of the stage before to its
    /// own. Fields that the stage does not set are constant.
    pub fn of_stage(stages: &[Stage], stage: usize) -> Self {
        let mut fields: Vec<FieldChange> = Vec::new();
        for own in &stages[..=stage] {
            fields.iter_mut().for_each(|field| field.from = field.to);
            for (name, value) in &own.fields {
                match fields.iter_mut().find(|field| field.name == *name) {
                    Some(field) => field.to = *value,
                    None => fields.push(FieldChange { name: name.clone(), from: *value, to: *value }),
                }
            }
        }
        Period { duration: stages[stage].duration, fields }
    }

    /// Returns the start of this period: gravity changes in it without duration, with constant fields.
    pub fn start(&self) -> Self {
        let still = |field: &FieldChange| FieldChange { to: field.from, ..field.clone() };
        Period { duration: 0.0, fields: self.fields.iter().map(still).collect() }
    }

    /// Returns true if time passes or a field changes.
    pub fn passes(&self) -> bool {
        self.duration > 0.0 || self.fields.iter().any(|field| field.from != field.to)
    }
}
