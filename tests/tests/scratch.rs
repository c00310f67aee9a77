use voussoir_tests::answered;
#[test]
fn scratch() {
    let Ok(files) = std::env::var("FILES") else { return };
    for file in files.split(' ') {
        let text = std::fs::read_to_string(file).unwrap();
        let r = answered(&text);
        eprintln!(
            "{file} {:?} {:?} {:?} {:?} steps {:?} it {:?} {:?} {:.1} s",
            r.status,
            r.load_factor,
            r.notes,
            r.certificate.failures,
            r.counters.get("steps"),
            r.counters.get("newton_iterations"),
            r.counters.get("cutbacks"),
            r.seconds
        );
        if std::env::var("CURVE").is_ok() {
            eprintln!("{:?}", r.curve);
        }
    }
}
