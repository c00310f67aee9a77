//! Wrong study files and their messages, word for word.
//!
//! Each `mistakes/NAME.toml` has a file `NAME.expected`. A first line `# --set KEY=VALUE` replaces options of the
//! command line. `UPDATE_EXPECTED=1` writes the expected files again; read the new messages aloud.

use std::fs;
use std::path::Path;
use voussoir::config::with_source;
use voussoir::kinds::read_study;

fn message_of(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let file = path.file_name().unwrap().to_str().unwrap();
    let sets: Vec<_> = text
        .lines()
        .map_while(|line| line.strip_prefix("# --set "))
        .map(|line| line.split_once('=').map(|(key, value)| (key.to_string(), value.to_string())).unwrap())
        .collect();
    match read_study(&text, file, &sets) {
        Ok(_) => "no mistake was found\n".into(),
        Err(wrong) => {
            let text_of = |name: &str| (name == file).then(|| text.clone());
            wrong.mistakes().iter().map(|mistake| with_source(mistake, &text_of, false) + "\n").collect()
        }
    }
}

#[test]
fn every_wrong_study_is_answered_with_exactly_the_expected_text() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("mistakes");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    assert!(files.len() >= 32, "only {} wrong studies", files.len());
    let mut different = Vec::new();
    for path in files {
        let message = message_of(&path);
        let expected = path.with_extension("expected");
        if std::env::var_os("UPDATE_EXPECTED").is_some() {
            fs::write(&expected, &message).unwrap();
        }
        let wanted = fs::read_to_string(&expected).unwrap_or_default();
        if message != wanted || message.starts_with("no mistake") {
            different.push(format!("{}\nexpected:\n{wanted}found:\n{message}", path.display()));
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
}
