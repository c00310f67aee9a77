//! From finished cases to files. The cases are read twice; only those that readers see are kept in memory.

use crate::output::{StudyOutput, drawn};
use crate::writers::comparison::comparison_table;
use crate::writers::files::Files;
use crate::writers::optima_csv::optima_table;
use crate::writers::path_proofs::PathProofs;
use crate::writers::results_json::add_cases;
use crate::writers::results_text::{ResultsHead, ResultsText};
use crate::writers::seismic::seismic_sentence;
use crate::writers::table::results_table;
use crate::writers::{tables, use_fields, written};
use std::borrow::Cow;
use std::io;
use voussoir_study::kind::RESULTS;
use voussoir_study::kind::{OwnResults, RunRequest};
use voussoir_study::results::format::{format_number, snap_words, status_word};
use voussoir_study::results::{CaseResult, FinishedCases, StudyResults, Totals, WorstEntry};
use voussoir_study::side_by_side::side_by_side;
use voussoir_study::study::{Case, Drawn, Study, SweptKeys};

/// The files made from finished cases.
#[derive(Debug, Clone)]
pub struct Made {
    /// Names of the files beside results.json, sorted.
    pub names: Vec<String>,
    /// The table for the terminal.
    pub table: String,
    /// Counts over all cases.
    pub totals: Totals,
}

/// Data of all cases after the first reading.
struct Gathered {
    totals: Totals,
    own: OwnResults,
}

/// Reads all cases once.
fn gathered(study: &Study, finished: &(impl FinishedCases + ?Sized)) -> io::Result<Gathered> {
    let (mut totals, mut brief) = (Totals::default(), Vec::new());
    // Kinds without additions need no list.
    let adds = study.kind != "run";
    finished.each(&mut |cases| {
        cases.iter().for_each(|case| totals.add(case));
        brief.extend(cases.iter().filter(|_| adds).map(|case| study.needed(case)));
        Ok(())
    })?;
    let own = study.own_results(&brief);
    Ok(Gathered { totals, own })
}

/// Returns the results that readers see, with everything that is drawn.
fn shown(
    study: &Study,
    request: &RunRequest,
    gathered: &Gathered,
    finished: &(impl FinishedCases + ?Sized),
) -> io::Result<StudyResults> {
    let mut ids = gathered.totals.shown();
    let optima = gathered.own.entries.optima.iter().flatten();
    ids.extend(optima.flat_map(|own| [own.case, own.best_finite.as_ref().map(|best| best.case)]).flatten());
    ids.extend(gathered.own.entries.worsts.iter().flatten().map(|own| own.place.case));
    let mut cases = Vec::with_capacity(ids.len());
    finished.each_of(&ids, &mut |few| {
        cases.extend(few.iter().map(CaseResult::without_drawings));
        Ok(())
    })?;
    let mut results = StudyResults {
        date: request.date.clone(),
        cases,
        ..study.results_without_cases(&request.version, &gathered.totals, &gathered.own)
    };
    // Meshes, moving loads and some writers show every case, other figures only the drawn cases.
    let named = use_fields(study.output.writers.as_deref().unwrap_or_default());
    let all = named || study.output.vtu || study.output.animation || study.output.figures == Drawn::All;
    let whole = if all { ids } else { drawn(study.output.figures, &results).unwrap_or_default() };
    finished.each_of(&whole, &mut |few| {
        for case in few {
            let place = results.cases.binary_search_by_key(&case.label.id, |own| own.label.id);
            place.into_iter().for_each(|place| results.cases[place] = case.clone());
        }
        Ok(())
    })?;
    Ok(results)
}

/// Writes results.json and all other files of finished cases, which are in order of id. `names` gets the names of the other
/// files before any file is written.
///
/// # Errors
/// Cases cannot be read, files cannot be written, or `names` returns an error.
pub fn write_files(
    study: &Study,
    request: &RunRequest,
    finished: &(impl FinishedCases + ?Sized),
    files: &dyn Files,
    names: &mut dyn FnMut(&[String]) -> io::Result<()>,
) -> io::Result<Made> {
    let gathered = gathered(study, finished)?;
    let results = shown(study, request, &gathered, finished)?;
    let (names, table) = write_shown(study, request, (&gathered.totals, &results), finished, files, names)?;
    Ok(Made { names, table, totals: gathered.totals })
}

/// Writes results.json and all other files. Returns the names of the others, sorted, and the table for the terminal.
fn write_shown(
    study: &Study,
    request: &RunRequest,
    (totals, results): (&Totals, &StudyResults),
    finished: &(impl FinishedCases + ?Sized),
    files: &dyn Files,
    names: &mut dyn FnMut(&[String]) -> io::Result<()>,
) -> io::Result<(Vec<String>, String)> {
    let cases: Vec<Cow<Case>> = results.cases.iter().filter_map(|case| study.case_of(&case.label)).collect();
    let output = StudyOutput::new(study, results, totals, &cases);
    let made = side_by_side(request.jobs, || written(&output));
    let mut tables = tables(&output);
    if totals.stored_paths {
        tables.push(Box::new(PathProofs));
    }
    let mut listed: Vec<String> = made.iter().map(|(name, _)| name.clone()).collect();
    listed.extend(tables.iter().map(|table| table.name()));
    listed.sort();
    names(&listed)?;
    let head = ResultsHead {
        study: results.study.clone(),
        version: results.version.clone(),
        origin: results.origin.clone(),
        date: results.date.clone(),
        only_cases: results.only_cases.clone(),
        files: listed.clone(),
    };
    // The most important file is first, because a disk may be full.
    let mut json = match files.begin(RESULTS)? {
        Some(out) => Some(ResultsText::begin(out, &head)?),
        None => None,
    };
    let mut begun = Vec::new();
    for table in &mut tables {
        if let Some(mut out) = files.begin(&table.name())? {
            table.begin(&mut out)?;
            begun.push((table, out));
        }
    }
    if json.is_some() || !begun.is_empty() {
        finished.each(&mut |cases| {
            json.as_mut().map_or(Ok(()), |json| add_cases(json, cases))?;
            let mut add = |case| begun.iter_mut().try_for_each(|(table, out)| table.add(case, out));
            cases.iter().try_for_each(&mut add)
        })?;
    }
    if let Some(json) = json {
        json.finish(results.comparison.as_ref(), &results.own)?.done()?;
    }
    for (table, mut out) in begun {
        table.end(&mut out)?;
        out.done()?;
    }
    made.iter().try_for_each(|(name, bytes)| files.write(name, bytes))?;
    let table = if request.quiet { String::new() } else { table(&output) };
    Ok((listed, table))
}

/// Returns the table for the terminal, with the additions of the study's kind.
fn table(output: &StudyOutput) -> String {
    if let Some(optima) = optima_table(output) {
        return optima;
    }
    let mut table = seismic_sentence(output).map_or(String::new(), |sentence| format!("{sentence}\n\n"));
    table += &results_table(output);
    if let Some(comparison) = &output.results.comparison {
        table += "\n";
        table += &comparison_table(comparison, &output.keys);
    }
    table + &found(output.results.own.worsts.as_deref().unwrap_or_default(), &output.keys)
}

/// Returns the results of an envelope, one line each.
fn found(worsts: &[WorstEntry], keys: &SweptKeys) -> String {
    let line = |WorstEntry { place, parameter: key, .. }: &WorstEntry| {
        let words = place.names().map(|name| format!(", {name}"));
        let number = |x: f64| format_number(x, 6);
        let snaps = snap_words(place.result, place.first_limit_point, number);
        format!(
            "\nworst: {} ({}) at {key} = {}{}{} (case {})\n",
            snaps.unwrap_or_else(|| place.result.map_or("-".into(), number)),
            status_word(place.status),
            number(place.value),
            keys.unit(key).map_or(String::new(), |unit| format!(" {unit}")),
            words.collect::<String>(),
            place.case
        )
    };
    worsts.iter().map(line).collect()
}
