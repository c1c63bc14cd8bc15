//! LAMMPS scripts against a host whose points fly freely.

mod host;

mod smoke {
    use super::host::run;
    use peridyne_io::lammps::Options;

    #[test]
    fn dev() {
        let path = std::env::var("DEV_SCRIPT").unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let out = std::env::var("DEV_OUT").unwrap_or_default();
        let variables = std::env::var("DEV_VARS")
            .unwrap_or_default()
            .split_whitespace()
            .map(|v| {
                let (a, b) = v.split_once('=').unwrap();
                (a.to_string(), vec![b.to_string()])
            })
            .collect();
        let ran = run(
            &path,
            &text,
            &Options {
                variables,
                output: out.into(),
            },
        );
        for l in &ran.lines {
            println!("{l}");
        }
        match ran.outcome {
            Err(e) => println!("{:?}", miette::Report::new(*e)),
            Ok(o) => println!("ok {}", o.steps),
        }
    }
}
