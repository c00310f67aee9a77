//! The page of a study of studies: verdicts first, then each study with its text, inputs and results.

use super::claims::{Answer, Verdict};
use super::contents::Contents;
use super::figures::Image;
use super::parts::Parts;
use crate::figures::format::format_seconds;
use crate::figures::plot::svg::{escape, own_ids};
use crate::kinds::kind::{Part, Piece};
use crate::writers::markdown::markdown;
use crate::writers::page;

/// Returns the page as HTML.
pub fn results_page(
    name: &str,
    contents: &Contents,
    parts: &Parts,
    answers: &[Answer],
    (version, date): (&str, Option<&str>),
) -> String {
    let title = contents.title.as_deref().unwrap_or(name);
    let drawn = std::cell::Cell::new(0);
    let text = |words: &str| {
        markdown(words, &|place| {
            drawn.set(drawn.get() + 1);
            image(contents, parts, place).map(|svg| own_ids(&svg, &format!("drawn-{}", drawn.get())))
        })
    };
    let mut body = format!("<h1>{}</h1>\n{}", escape(title), text(&contents.introduction));
    body += &claims(answers, &text);
    for (place, part) in parts.list().iter().enumerate() {
        let words = contents.text.get(place).map_or("", |words| words.trim());
        body += &format!("<section id=\"{}\">\n{}", escape(&part.folder), heading(words, &part.folder));
        body += &text(words);
        body += &answered(parts, place, part);
        body += "</section>\n";
    }
    body += &contents.text.get(parts.list().len()).map(|words| text(words)).unwrap_or_default();
    body += "<h2>Time</h2>\n<p>Time of each study's cases, summed; studies with several jobs take less.</p>\n";
    let header = ["study", "cases", "time"].map(String::from);
    let rows = parts.list().iter().enumerate().map(|(place, part)| {
        vec![part.folder.clone(), parts.cases(place).len().to_string(), format_seconds(parts.seconds(place))]
    });
    body += &page::table(&header, rows);
    let date = date.map_or(String::new(), |date| format!(", {}", escape(date)));
    body += &format!(
        "<footer>Written by Voussoir {}{date}. Each study has a folder beside this page with its results, tables and \
         figures.</footer>\n",
        escape(version)
    );
    page::whole(title, &body, &[])
}

/// Returns the heading of a part: the heading in its text, otherwise the name of its study; empty if the part has no content
/// below it except its results.
fn heading(words: &str, study: &str) -> String {
    if words.is_empty() || words.starts_with('#') { String::new() } else { format!("<h2>{}</h2>\n", escape(study)) }
}

/// Returns the claims with their verdicts first; the tests are in a section that opens.
fn claims(answers: &[Answer], text: &dyn Fn(&str) -> String) -> String {
    if answers.is_empty() {
        return String::new();
    }
    let count = |verdict: Verdict| answers.iter().filter(|answer| answer.verdict == verdict).count();
    let all = [Verdict::Reproduced, Verdict::Refuted, Verdict::DependsOn, Verdict::Undecided];
    let words = |verdict: &Verdict| match verdict {
        Verdict::DependsOn => "depend on what is assumed",
        other => other.words(),
    };
    let some = all.iter().filter(|verdict| count(**verdict) > 0);
    let counted: Vec<String> = some.map(|verdict| format!("{} {}", count(*verdict), words(verdict))).collect();
    let mut body = format!(
        "<h2>Claims</h2>\n<p class=\"summary\">Of {} claims <strong>{}</strong>. Every verdict is computed from the numbers \
         below it.</p>\n",
        answers.len(),
        escape(&counted.join(", "))
    );
    for answer in answers {
        body += &claim(answer, text);
    }
    body
}

fn claim(answer: &Answer, text: &dyn Fn(&str) -> String) -> String {
    let claim = answer.claim;
    let source = if claim.source.is_empty() {
        String::new()
    } else {
        format!(" <span class=\"quiet\">({})</span>", escape(&claim.source))
    };
    let class = match answer.verdict {
        Verdict::Reproduced => "yes",
        Verdict::Refuted => "no",
        Verdict::DependsOn => "partly",
        Verdict::Undecided => "bad",
    };
    let header = ["", "number", "", "condition"].map(String::from);
    let rows = claim.tests.iter().zip(&answer.tests).map(|(test, tested)| {
        let unit = if test.unit.is_empty() || tested.value.number().is_none_or(f64::is_infinite) {
            String::new()
        } else {
            format!(" {}", test.unit)
        };
        let holds = match tested.holds {
            Some(true) => "holds",
            Some(false) => "does not hold",
            None => "undecided",
        };
        vec![
            test.of.clone(),
            format!("{}{unit}", tested.value.describe()),
            holds.into(),
            format!("{} with value = {}", test.holds, test.value),
        ]
    });
    format!(
        "<details class=\"claim\" id=\"claim-{}\"><summary><span class=\"verdict {class}\">{}</span> {}. {}{source}</summary>\n{}{}</details>\n",
        escape(&claim.id),
        escape(&answer.words()),
        escape(&claim.id),
        escape(&claim.claim),
        page::table(&header, rows),
        text(&claim.remark)
    )
}

/// Returns the input and the results of a part.
fn answered(parts: &Parts, place: usize, part: &Part) -> String {
    let statuses = parts.statuses(place);
    let words: Vec<String> =
        statuses.iter().map(|(status, count)| format!("{count} {}", status.replace('_', " "))).collect();
    let failed = parts.uncertified(place);
    let proof = match failed {
        0 => "every answer certified".to_string(),
        count => format!("<strong class=\"bad\">{count} not certified</strong>"),
    };
    let mut body = format!(
        "<p class=\"quiet\"><code>{}</code>, {} cases: {}; {proof}. <a href=\"{}/report.html\">All cases of this study</a>.</p>\n",
        escape(&part.folder),
        parts.cases(place).len(),
        escape(&words.join(", ")),
        escape(&part.folder).replace(' ', "%20")
    );
    if let Some(record) = parts.piece(&part.folder, Piece::Record) {
        body += &format!("<details><summary>Inputs</summary>\n{record}</details>\n");
    }
    body
}

/// Returns the content of an image.
fn image(contents: &Contents, parts: &Parts, place: &str) -> Option<String> {
    match Image::parse(place)? {
        Image::Table(name) => {
            contents.tables.iter().find(|table| table.name == name).map(|table| table.html(&contents.series, parts))
        }
        _ if !parts.figures => Some(String::new()),
        Image::Chart(name) => {
            contents.charts.iter().find(|chart| chart.name == name).map(|chart| chart.svg(&contents.series, parts))
        }
        Image::Study(name) => parts.piece(&name, Piece::Chart),
        Image::Case(what, series, x) => {
            let selection = contents.series.get(&series)?;
            let name = selection.study.as_deref()?;
            let results = parts.json(name)?;
            let chosen = selection.choose(results);
            let case = chosen.iter().find(|chosen| (chosen.x - x).abs() <= 1e-6 * x.abs().max(1e-6))?.entry;
            let id = case["id"].as_u64().or(case["case"].as_u64())? as usize;
            let piece = match what.as_str() {
                "scene" => Piece::Scene(id),
                "mechanism" => Piece::Mechanism(id),
                _ => Piece::Curve(id),
            };
            parts.piece(name, piece)
        }
    }
}
