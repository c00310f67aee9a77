//! Measurements of other programs: read from a CSV file, and shown beside the contestants.

use super::measured::{Bench, Other};
use voussoir_study::config::diagnostic::suggest;

/// Columns of the file.
const COLUMNS: [&str; 4] = ["problem", "program", "load_factor [-]", "seconds [s]"];

/// A row of the file.
#[derive(Debug)]
pub struct Row {
    /// Name of the problem.
    problem: String,
    /// Name of the program.
    program: String,
    /// Load factor.
    factor: f64,
    /// Time \[s\].
    seconds: f64,
}

/// Reads the measurements of other programs. `problems` contains the names of the bench's problems. A row whose load
/// factor is no finite number is a run that failed; it is left out.
///
/// # Errors
///
/// The first line with a missing or unknown column, an unknown problem, or a time that is no positive number.
pub fn read_others(text: &str, problems: &[String]) -> Result<Vec<Row>, String> {
    let mut reader = csv::ReaderBuilder::new().from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let place = |name: &&str| {
        let missing = || format!("line 1: column \"{name}\" is missing; the columns are {}", COLUMNS.join(", "));
        header.iter().position(|own| own.trim() == *name).ok_or_else(missing)
    };
    let places = COLUMNS.iter().map(place).collect::<Result<Vec<usize>, String>>()?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |column: usize| record.get(places[column]).unwrap_or("").trim();
        if !problems.iter().any(|name| name == cell(0)) {
            let names: Vec<&str> = problems.iter().map(String::as_str).collect();
            let help = suggest(cell(0), &names, "problems of this bench");
            return Err(format!("line {line}: no problem \"{}\"; {help}", cell(0)));
        }
        let seconds: f64 = cell(3).parse().unwrap_or(f64::NAN);
        if !(seconds > 0.0 && seconds.is_finite()) {
            return Err(format!("line {line}: seconds [s] \"{}\" is no positive number", cell(3)));
        }
        if let Some(factor) = cell(2).parse().ok().filter(|factor: &f64| factor.is_finite()) {
            rows.push(Row { problem: cell(0).into(), program: cell(1).into(), factor, seconds });
        }
    }
    Ok(rows)
}

impl Bench {
    /// Adds measurements of other programs. Their errors are measured from the references of their problems. A problem that
    /// was not measured is left out.
    pub fn beside(&mut self, rows: Vec<Row>) {
        for Row { problem, program, factor, seconds } in rows {
            let Some(problem) = self.problems.iter().position(|own| own.name == problem) else { continue };
            let error = self.problems[problem].reference.as_ref().map(|source| source.error_of(factor));
            self.others.push(Other { problem, program, factor, seconds, error });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::read_others;
    use crate::bench::{Bench, Problem, Source};

    const ROWS: &str = "problem,program,load_factor [-],seconds [s]\nring,other,2.002,0.5\nring,other,nan,0.1\n";

    /// A row gets the error from the reference of its problem; a run that failed is left out.
    #[test]
    fn errors_come_from_the_reference_of_the_problem() {
        let problems = ["wall".to_string(), "ring".to_string()];
        let rows = read_others(ROWS, &problems).expect("two rows");
        let reference = Some(Source { factor: 2.0, from: "given".into(), band: None });
        let problem =
            |name: &String| Problem { name: name.clone(), reference: reference.clone(), ..Problem::default() };
        let mut bench = Bench { problems: problems.iter().map(problem).collect(), ..Bench::default() };
        bench.beside(rows);
        assert_eq!(bench.others.len(), 1);
        assert!(bench.others[0].problem == 1 && (bench.others[0].error.expect("an error") - 1e-3).abs() < 1e-15);
    }

    /// A wrong row is refused with its line and the nearest name.
    #[test]
    fn wrong_rows_are_refused() {
        let problems = ["ring".to_string()];
        let refused = |text: &str| read_others(text, &problems).expect_err("a wrong row");
        let text = ROWS.replace("ring,other,nan", "rign,other,nan");
        assert!(refused(&text).contains("line 3: no problem \"rign\"; did you mean \"ring\""), "{}", refused(&text));
        let text = ROWS.replace("0.5", "-0.5");
        assert!(refused(&text).contains("line 2: seconds [s] \"-0.5\""), "{}", refused(&text));
        assert!(refused("problem,program\n").contains("column \"load_factor [-]\" is missing"));
    }
}
