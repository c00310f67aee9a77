//! `voussoir new`: commented studies that can be run unchanged.

use super::error::{CliError, Outcome, Verdict};
use super::print::say;
use std::io::{ErrorKind, Write};

/// The subject of a new study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Template {
    /// An arch under a load above quarter span
    Arch,
    /// A wall that is tilted or shaken
    Wall,
    /// Blocks by their vertices
    Blocks,
    /// An arch bridge with fill under a moving axle
    Bridge,
    /// One law at one point
    Point,
    /// Several laws beside each other
    Compare,
    /// Load factors over the rise of an arch, as in a paper
    Paper,
}

impl Template {
    /// All templates.
    #[cfg(test)]
    const ALL: [Template; 7] = [
        Template::Arch,
        Template::Wall,
        Template::Blocks,
        Template::Bridge,
        Template::Point,
        Template::Compare,
        Template::Paper,
    ];

    /// The name of the template, which is also the name of the study.
    fn word(self) -> &'static str {
        match self {
            Template::Arch => "arch",
            Template::Wall => "wall",
            Template::Blocks => "blocks",
            Template::Bridge => "bridge",
            Template::Point => "point",
            Template::Compare => "compare",
            Template::Paper => "paper",
        }
    }

    /// The study file.
    pub fn text(self) -> &'static str {
        match self {
            Template::Arch => include_str!("new/arch.toml"),
            Template::Wall => include_str!("new/wall.toml"),
            Template::Blocks => include_str!("new/blocks.toml"),
            Template::Bridge => include_str!("new/bridge.toml"),
            Template::Point => include_str!("new/point.toml"),
            Template::Compare => include_str!("new/compare.toml"),
            Template::Paper => include_str!("new/paper.toml"),
        }
    }
}

/// Writes a new study into the current folder; never overwrites a file.
pub fn new(what: Template, name: Option<&str>) -> Outcome {
    let word = what.word();
    let name = name.map_or(word, |name| name.strip_suffix(".toml").unwrap_or(name));
    if name.is_empty() || name.contains(['/', '\\', '"', ':', '*', '?', '<', '>', '|']) || name.starts_with('.') {
        let why = format_args!("voussoir new: \"{name}\" is no name of a study: use letters, digits, blanks, - and _");
        return Err(CliError::wrong_input(why));
    }
    let text = what.text().replacen(&format!("name = \"{word}\""), &format!("name = \"{name}\""), 1);
    let file = format!("{name}.toml");
    let written = std::fs::OpenOptions::new().write(true).create_new(true).open(&file);
    match written.and_then(|mut out| out.write_all(text.as_bytes())) {
        Ok(()) => {
            say(format!("{file} is written; run it with\n  voussoir run {file}"));
            Ok(Verdict::Proved)
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(CliError::wrong_input(format_args!(
            "voussoir new: {file} is there and stays as it is; give another name: voussoir new {word} NAME"
        ))),
        Err(error) => Err(CliError::no_access(format_args!("voussoir new: cannot write {file}: {error}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_report::kinds::read_study;
    use voussoir_study::cases::Unobserved;
    use voussoir_study::kind::RunRequest;

    /// Every template is valid and gives a proved result.
    #[test]
    fn templates_run_as_they_stand() {
        for template in Template::ALL {
            let word = template.word();
            assert!(template.text().starts_with(&format!("name = \"{word}\" ")), "{word}");
            let study = read_study(template.text(), word, &[("output.figures".into(), "false".into())]);
            let study = study.unwrap_or_else(|wrong| panic!("{wrong}"));
            assert!(study.notes().is_empty(), "{word}: {:?}", study.notes());
            let request = RunRequest { wanted: (0..study.count()).collect(), jobs: 1, ..RunRequest::default() };
            assert!(study.run(&request, &Unobserved).certified, "{word}");
        }
    }
}
