//! Damaged results folders: `verify` ends within seconds, with findings in words and an exit code from 0 to 3, for any
//! content of the folder. The short run uses a few damages of each study; `DAMAGED_FOLDERS=3000` sets the total number.

mod damages;
mod folders;
mod program;

use damages::{Damage, damages};
use folders::{copy_folder, studies, written_folders};
use program::{Ended, ended, voussoir};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Longest time of one check.
const LIMIT: Duration = Duration::from_secs(60);
/// Number of damages in the short run.
const SHORT: usize = 120;

fn place(name: &str) -> PathBuf {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("damaged_{name}"));
    drop(std::fs::remove_dir_all(&place));
    std::fs::create_dir_all(&place).expect("a folder");
    place
}

/// Describes the end of a check if it is wrong.
fn wrong_end(damage: &Damage, end: &Ended) -> Option<String> {
    let code = match end.code {
        None => return Some(format!("no end within {LIMIT:?}")),
        Some(code) => code,
    };
    let panicked = end.text.contains("panicked at") || end.text.contains("a panic ended");
    match code {
        0..=3 if panicked => Some("a panic".into()),
        0 if !damage.may_be_free() => Some("confirmed".into()),
        0..=3 if end.text.trim().is_empty() => Some("no words".into()),
        0..=3 => None,
        _ => Some(format!("exit code {code}")),
    }
}

/// Selects `count` damages of all folders, evenly spread.
fn chosen(folders: &[PathBuf], count: usize) -> Vec<(PathBuf, Damage)> {
    let each = count.div_ceil(folders.len());
    let mut chosen = Vec::new();
    for folder in folders {
        let all = damages(folder);
        let take = each.min(all.len());
        let spread = (0..take).map(|i| i * all.len() / take);
        chosen.extend(spread.map(|i| (folder.clone(), all[i].clone())));
    }
    chosen
}

#[test]
fn damaged_folders_end_with_findings() {
    let count = std::env::var("DAMAGED_FOLDERS").ok().and_then(|text| text.parse().ok()).unwrap_or(SHORT);
    let at = place("folders");
    let folders = written_folders(&at);
    let damaged = chosen(&folders, count);
    let (next, wrong, codes) = (AtomicUsize::new(0), Mutex::new(Vec::new()), Mutex::new([0usize; 5]));
    let slowest = Mutex::new((Duration::ZERO, String::new()));
    let free = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for worker in 0..2 {
            let (at, damaged) = (&at, &damaged);
            let (next, wrong, codes, slowest, free) = (&next, &wrong, &codes, &slowest, &free);
            scope.spawn(move || {
                while let Some((folder, damage)) = damaged.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let copy = at.join(format!("copy-{worker}"));
                    copy_folder(folder, &copy);
                    damage.apply(&copy, &folders_beside(folder));
                    let end = ended(&["verify", copy.to_str().expect("text")], at, LIMIT);
                    let name = format!("{}: {damage}", folder.file_name().unwrap_or_default().to_string_lossy());
                    codes.lock().expect("no panic")[end.code.map_or(4, |code| code.clamp(0, 4) as usize)] += 1;
                    if let Some(why) = wrong_end(damage, &end) {
                        wrong.lock().expect("no panic").push(format!("{name}: {why}\n{}", end.text));
                    } else if end.code == Some(0) {
                        free.lock().expect("no panic").push(name.clone());
                    }
                    let mut slowest = slowest.lock().expect("no panic");
                    if end.time > slowest.0 {
                        *slowest = (end.time, name);
                    }
                }
            });
        }
    });
    let (wrong, free) = (wrong.into_inner().expect("no panic"), free.into_inner().expect("no panic"));
    println!(
        "{} damaged folders, exit codes 0 to 3 and none: {:?}",
        damaged.len(),
        codes.into_inner().expect("no panic")
    );
    println!("slowest: {:?}", slowest.into_inner().expect("no panic"));
    println!("confirmed, because the damage is in a free entry: {}\n  {}", free.len(), free.join("\n  "));
    assert!(wrong.is_empty(), "{} of {} ended wrongly:\n{}", wrong.len(), damaged.len(), wrong.join("\n"));
}

/// Another folder, the source of swapped files.
fn folders_beside(folder: &Path) -> PathBuf {
    let name = if folder.ends_with("limit") { "compare" } else { "limit" };
    folder.with_file_name(name)
}

/// A damaged journal loses only its damaged cases: `--resume` gives the results of an undisturbed run.
#[test]
fn damaged_journals_are_resumed() {
    let at = place("journals");
    let (name, text) = studies().into_iter().find(|(name, _)| *name == "limit").expect("a study");
    std::fs::write(at.join("a.toml"), text).expect("written");
    for shard in ["1/2", "2/2"] {
        assert_eq!(
            voussoir(&["run", "a.toml", "--out", "parts", "--quiet", "--shard", shard], &at).code,
            Some(0),
            "{name}"
        );
    }
    let part = std::fs::read(at.join("parts/shard-1-of-2/cases.jsonl")).expect("a part");
    let count = if std::env::var("DAMAGED_FOLDERS").is_ok() { 60 } else { 6 };
    for step in 0..count {
        let (place, mut bytes) = (step * part.len() / count, part.clone());
        match step % 3 {
            0 => bytes.truncate(place),
            1 => bytes[place] ^= 0x81,
            _ => drop(bytes.drain(place..(place + 7).min(part.len()))),
        }
        drop(std::fs::remove_dir_all(at.join("out")));
        std::fs::create_dir(at.join("out")).expect("a folder");
        std::fs::write(at.join("out/unfinished.jsonl"), &bytes).expect("written");
        let resumed = ended(&["run", "a.toml", "--out", "out", "--resume"], &at, LIMIT);
        assert_eq!(resumed.code, Some(0), "{step}: {}", resumed.text);
        assert_eq!(ended(&["verify", "out", "a.toml"], &at, LIMIT).code, Some(0), "{step}");
        if bytes != part {
            std::fs::write(at.join("parts/shard-1-of-2/cases.jsonl"), &bytes).expect("written");
            let merged = ended(&["merge", "parts", "--out", "merged"], &at, LIMIT);
            assert!(matches!(merged.code, Some(2 | 3)), "{step}: {}", merged.text);
        }
    }
}
