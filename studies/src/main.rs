//! The command line of Voussoir.

mod commands;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// How masonry made of blocks stands and collapses.
#[derive(Parser)]
#[command(name = "voussoir", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Answer studies and write results, figures and a report
    Run {
        /// Study files (TOML)
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Where results go; with several studies, a folder each inside \[default: results/NAME\]
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set joints.dry.friction=0.5
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Cases worked on side by side
        #[arg(long, default_value_t = 1)]
        jobs: usize,
        /// Answer only the case with this id
        #[arg(long)]
        case: Option<usize>,
        /// Go on from the finished cases of an interrupted run
        #[arg(long)]
        resume: bool,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Check a study file without computing anything
    Check {
        /// Study files (TOML)
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Override a key of the study
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
    },
    /// LoadStep one law at one point through a path of strains and stresses
    Point {
        /// Study files (TOML) with kind = "point"
        #[arg(required = true)]
        studies: Vec<PathBuf>,
        /// Where results go; with several studies, a folder each inside \[default: results/NAME\]
        #[arg(long)]
        out: Option<PathBuf>,
        /// Override a key of the study, e.g. --set point.length=0.1
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Explain a plug-in, or how a study will be solved
    Explain {
        /// Tag of a plug-in, or a study file
        what: String,
    },
    /// List plug-ins
    List {
        /// laws, materials, scenes, solvers, kinds or writers
        kind: Option<String>,
    },
    /// Print the JSON Schema of study files
    Schema,
    /// Check results against the study they answer
    Verify {
        /// Folder written by `run`
        dir: PathBuf,
    },
}

fn main() -> ExitCode {
    let wrong = voussoir::core::plugin::audit();
    if !wrong.is_empty() {
        wrong.iter().for_each(|why| eprintln!("voussoir: registry: {why}"));
        return ExitCode::from(3);
    }
    let code = match Cli::parse().command {
        Command::Run { studies, out, set, jobs, case, resume, quiet } => {
            let options = commands::run::Options { out, set, jobs, case, resume, quiet };
            commands::run::run(&studies, &options)
        }
        Command::Check { studies, set } => commands::check::check(&studies, &set),
        Command::Point { studies, out, set, quiet } => commands::point::point(&studies, out.as_deref(), &set, quiet),
        Command::Explain { what } => commands::explain::explain(&what),
        Command::List { kind } => commands::explain::list(kind.as_deref()),
        Command::Schema => commands::explain::schema(),
        Command::Verify { dir } => commands::verify::verify(&dir),
    };
    ExitCode::from(code)
}
