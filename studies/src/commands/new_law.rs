//! `voussoir new law` and `voussoir new crate`: write the files of a law, or of a crate with a law, made from an example that
//! is compiled and tested.

use super::error::{CliError, Outcome, Verdict};
use super::print::say;
use std::path::{Path, PathBuf};
use voussoir_core::plugin::{PluginKind, card};

/// The law of `studies/examples/my_law`, its page, its tests, its program and its study. These files are copies, because
/// Cargo leaves nested crates out of a package. A test of the architecture compares them.
const LAW: &str = include_str!("../../templates/keyed.rs");
const PAGE: &str = include_str!("../../templates/keyed.md");
const TEST: &str = include_str!("../../templates/test.rs");
const MAIN: &str = include_str!("../../templates/main.rs");
const STUDY: &str = include_str!("../../templates/keyed.toml");
const STUDY_TEST: &str = include_str!("../../templates/study.rs");
const IGNORED: &str = include_str!("../../templates/gitignore");
const PYTHON: &str = "\"\"\"Plug-ins for Voussoir: `import voussoir` has them.\"\"\"\n";

/// Returns the reason why a word cannot be the tag of a new law.
fn unfit(tag: &str) -> Option<String> {
    let word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !tag.starts_with(|c: char| c.is_ascii_lowercase()) || !tag.chars().all(word) {
        return Some("a tag is the name of a file: small letters, digits and _, a letter first".into());
    }
    let taken = card(PluginKind::InterfaceLaw, tag)?;
    Some(format!("there is such a law already: {}", taken.file))
}

/// Converts `shear_keys` to `ShearKeys`.
fn type_name(tag: &str) -> String {
    let capital =
        |word: &str| word.chars().take(1).flat_map(char::to_uppercase).chain(word.chars().skip(1)).collect::<String>();
    tag.split('_').map(capital).collect()
}

/// Returns a text of the example with the names of another law and crate.
fn renamed(text: &str, tag: &str, package: &str) -> String {
    text.replace("Keyed", &type_name(tag)).replace("keyed", tag).replace("my_law", &package.replace('-', "_"))
}

/// Writes files into a folder and lists them; writes nothing if one of them exists.
fn write(files: &[(String, String)], into: &Path) -> Result<(), CliError> {
    if let Some((there, _)) = files.iter().find(|(file, _)| into.join(file).exists()) {
        let place = into.join(there);
        let why = format_args!("voussoir: {} already exists; nothing was written", place.display());
        return Err(CliError::wrong_input(why));
    }
    for (file, text) in files {
        let place = into.join(file);
        let written =
            std::fs::create_dir_all(place.parent().unwrap_or(into)).and_then(|()| std::fs::write(&place, text));
        written.map_err(|error| CliError::unwritten(&place, error))?;
        say(format!("{}", place.display()));
    }
    Ok(())
}

/// Writes a joint law, its page and its test into a crate; never overwrites a file.
pub fn law(tag: &str, into: &Path) -> Outcome {
    if let Some(why) = unfit(tag) {
        return Err(CliError::wrong_input(format_args!("voussoir new law {tag}: {why}")));
    }
    let manifest = into.join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest)
        .map_err(|error| CliError::of_file(&manifest, format_args!("{error}; --out names the folder of a crate")))?;
    let table: Option<toml::Table> = text.parse().ok();
    let Some(name) = table.as_ref().and_then(|table| table.get("package")?.get("name")?.as_str()) else {
        return Err(CliError::wrong_input(format_args!("{}: names no package", manifest.display())));
    };
    let depends = |on: &str| {
        table.as_ref().is_some_and(|table| table.get("dependencies").is_some_and(|all| all.get(on).is_some()))
    };
    let own = |text: &str| {
        let text = renamed(text, tag, name);
        // Crates of this workspace use the core, which has the same paths.
        let core = depends("voussoir-core") && !depends("voussoir-plug");
        if core { text.replace("voussoir_plug", "voussoir_core") } else { text }
    };
    let mut files = vec![(format!("src/{tag}.rs"), own(LAW)), (format!("src/{tag}.md"), own(PAGE))];
    // In this workspace, the conformance tests find every law.
    if name != "voussoir-laws" {
        files.push((format!("tests/{tag}.rs"), own(TEST)));
    }
    write(&files, into)?;
    say(format!(
        "add `pub mod {tag};` to {}, change the equations, and say `voussoir conform {tag}`",
        into.join("src/lib.rs").display()
    ));
    Ok(Verdict::Proved)
}

/// The options of `voussoir new crate`.
pub struct NewCrate {
    /// Name of the crate, which is also the name of its folder.
    pub name: String,
    /// Tag of its law.
    pub law: Option<String>,
    /// Folder in which the folder of the crate is written.
    pub out: PathBuf,
    /// A copy of the repository, for dependencies by path.
    pub repository: Option<PathBuf>,
}

/// Writes a crate with one law, its study and tests, and a program with the full command line; never overwrites a file.
pub fn new_crate(options: &NewCrate) -> Outcome {
    let NewCrate { name, law, out, repository } = options;
    let wrong = |why: String| CliError::wrong_input(format_args!("voussoir new crate {name}: {why}"));
    let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == '-';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(letter) {
        return Err(wrong("the name of a crate has small letters, digits, - and _, and begins with a letter".into()));
    }
    if name.starts_with("voussoir") {
        return Err(wrong("names that start with voussoir belong to this project; choose another name".into()));
    }
    let tag = law.clone().unwrap_or_else(|| name.replace('-', "_"));
    if let Some(why) = unfit(&tag) {
        return Err(wrong(format!("the law {tag}: {why}")));
    }
    let repository = repository.as_deref().map(|folder| repository_of(folder).map_err(wrong)).transpose()?;
    let own = |text: &str| renamed(text, &tag, name);
    let files = [
        ("Cargo.toml".into(), manifest(name, repository.as_deref())),
        ("pyproject.toml".into(), wheel(name)),
        (".gitignore".into(), IGNORED.to_string()),
        ("README.md".into(), readme(name, &tag)),
        (format!("{tag}.toml"), own(STUDY)),
        (
            "src/lib.rs".into(),
            format!(
                "//! The laws of this crate. The name of a file is the tag of its law.\n\npub mod {tag};\n\n// The Python module.\n#[cfg(feature = \"python\")]\nuse _voussoir as _;\n"
            ),
        ),
        (format!("python/{}/__init__.py", module(name)), PYTHON.to_string()),
        ("src/main.rs".into(), own(MAIN)),
        (format!("src/{tag}.rs"), own(LAW)),
        (format!("src/{tag}.md"), own(PAGE)),
        (format!("tests/{tag}.rs"), own(TEST)),
        ("tests/study.rs".into(), own(STUDY_TEST)),
    ];
    let into = out.join(name);
    write(&files, &into)?;
    say(format!(
        "change the equations in src/{tag}.rs; then, in {}, run `cargo run --release -- conform {tag}`",
        into.display()
    ));
    Ok(Verdict::Proved)
}

/// Returns the absolute path of a copy of the repository, with slashes as Cargo accepts them everywhere.
fn repository_of(folder: &Path) -> Result<String, String> {
    if !folder.join("core/plug/Cargo.toml").is_file() {
        return Err(format!(
            "--repository {}: is no copy of the repository: it has no core/plug/Cargo.toml",
            folder.display()
        ));
    }
    let path = folder.canonicalize().map_err(|error| format!("--repository {}: {error}", folder.display()))?;
    Ok(path.to_string_lossy().trim_start_matches(r"\\?\").replace('\\', "/"))
}

fn manifest(name: &str, repository: Option<&str>) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let source = |folder: &str| match repository {
        Some(root) => format!("{{ path = \"{root}/{folder}\" }}"),
        None => format!("\"{version}\""),
    };
    let patch = match repository {
        Some(_) => String::new(),
        None => "\n# With a copy of the repository instead of published versions:\n# [patch.crates-io]\n\
                 # voussoir = { path = \"/path/to/voussoir/studies\" }\n\
                 # voussoir-plug = { path = \"/path/to/voussoir/core/plug\" }\n\
                 # voussoir-python = { path = \"/path/to/voussoir/studies/python\" }\n"
            .to_string(),
    };
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n[dependencies]\n\
         voussoir = {} # the command line, for src/main.rs and the tests\nvoussoir-plug = {} # all that a law needs\n\
         voussoir-python = {{ {}, optional = true }} # the Python module\n\n[features]\npython = [\"dep:voussoir-python\"]\n\n\
         # The second type is the Python module.\n[lib]\ncrate-type = [\"rlib\", \"cdylib\"]\n{patch}\n\
         [workspace]\n\n[profile.release]\ndebug = 1\n",
        source("studies"),
        source("core/plug"),
        match repository {
            Some(root) => format!("path = \"{root}/studies/python\""),
            None => format!("version = \"{version}\""),
        },
    )
}

/// The name of a crate as a module of Rust and Python.
fn module(name: &str) -> String {
    name.replace('-', "_")
}

/// The description of a Python wheel whose native module contains Voussoir with the laws of the crate.
fn wheel(name: &str) -> String {
    let (module, version) = (module(name), env!("CARGO_PKG_VERSION"));
    format!(
        "# A wheel with the plug-ins of this crate: `pip install voussoir .`; then `import voussoir` has them.\n\
         [build-system]\nrequires = [\"maturin>=1.9.4,<2\"]\nbuild-backend = \"maturin\"\n\n[project]\nname = \"{name}\"\n\
         version = \"0.1.0\"\nrequires-python = \">=3.10\"\ndependencies = [\"voussoir=={version}\"]\n\n\
         [project.entry-points.\"voussoir.native\"]\n{module} = \"{module}._voussoir\"\n\n[project.scripts]\n\
         {name} = \"voussoir.__main__:main\"\n\n[tool.maturin]\nbindings = \"pyo3\"\nfeatures = [\"python\"]\n\
         python-source = \"python\"\nmodule-name = \"{module}._voussoir\"\nstrip = true\n"
    )
}

fn readme(name: &str, tag: &str) -> String {
    format!(
        "# {name}\n\n`src/{tag}.rs` is the law. `src/main.rs` is the program: the command line of Voussoir with this law.\n\n\
         ```sh\ncargo run --release -- conform {tag}\ncargo run --release -- run {tag}.toml\ncargo test --release\n```\n\n\
         `voussoir new law TAG --out .` writes another law with its page and its test. `pip install voussoir .` installs\n\
         a Python wheel with the laws of this crate: `import voussoir` then has them, in notebooks and on the workers of a cluster.\n"
    )
}
