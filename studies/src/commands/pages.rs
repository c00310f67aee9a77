//! `voussoir completions` and `voussoir man`.

use super::error::{CliError, Outcome, Verdict};
use super::print::print;
use std::io::Write;

/// Prints the completion script of a shell.
pub fn completions(shell: clap_complete::Shell, command: &mut clap::Command) -> Outcome {
    let mut text = Vec::new();
    clap_complete::generate(shell, command, "voussoir", &mut text);
    print(&text);
    Ok(Verdict::Proved)
}

/// Prints the manual page: the program, then each command.
pub fn man(command: clap::Command) -> Outcome {
    let mut text = Vec::new();
    let mut written = clap_mangen::Man::new(command.clone()).render(&mut text);
    for each in command.get_subcommands().filter(|each| !each.is_hide_set()) {
        let page = clap_mangen::Man::new(each.clone().display_name(format!("voussoir {}", each.get_name())));
        written = written.and_then(|()| {
            writeln!(text, ".SH \"COMMAND {}\"", each.get_name().to_uppercase())?;
            page.render_synopsis_section(&mut text)?;
            page.render_description_section(&mut text)?;
            page.render_options_section(&mut text)
        });
    }
    written.map_err(|error| CliError::no_access(format_args!("voussoir man: {error}")))?;
    print(&text);
    Ok(Verdict::Proved)
}
