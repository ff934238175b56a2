//! Help, completions and usage errors.

use crate::run::{run, succeed};

const COMMANDS: [&str; 10] = [
    "demo",
    "train",
    "score",
    "eval",
    "ambiguity",
    "calibrate",
    "experiment",
    "report",
    "inspect",
    "export",
];

#[test]
fn every_commands_help_names_units_and_shows_an_example() {
    for name in COMMANDS {
        let help = succeed([name, "--help"]).stdout;
        assert!(help.contains("Example"), "{name}: {help}");
        assert!(help.contains(&format!("  cobra {name} ")), "{name}: {help}");
        let units = [" mm", "millimetres", "unit"];
        assert!(
            units.iter().any(|unit| help.contains(unit)),
            "{name}: {help}"
        );
    }
}

#[test]
fn the_examples_of_every_help_are_understood() {
    for name in COMMANDS {
        let help = succeed([name, "--help"]).stdout;
        for example in help
            .split_once("Example")
            .unwrap()
            .1
            .split("\n  cobra ")
            .skip(1)
        {
            let words = example.split_whitespace();
            let outcome = run(words.chain(["--help"]));
            assert_eq!(outcome.code, Some(0), "{example}: {outcome:?}");
        }
    }
}

#[test]
fn the_help_says_what_the_exit_codes_mean() {
    let help = succeed(["--help"]).stdout;
    let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    for meaning in ["0 success", "2 wrong usage", "3 bad input"] {
        assert!(words.contains(meaning), "{help}");
    }
    for name in COMMANDS {
        assert!(help.contains(name), "{help}");
    }
}

#[test]
fn there_are_completions_for_the_common_shells() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = succeed(["completions", shell]).stdout;
        assert!(script.contains("cobra"), "{shell}");
        assert!(script.contains("reference-points"), "{shell}");
        assert!(script.contains("export"), "{shell}");
    }
}

#[test]
fn wrong_usage_is_code_2_and_says_what_is_wrong() {
    let cases: [(&[&str], &str); 10] = [
        (&[], "Usage"),
        (&["polish"], "polish"),
        (&["train", "box.obj"], "--output"),
        (
            &["train", "box.obj", "-o", "a.cobra", "--unit", "yd"],
            "--unit",
        ),
        (
            &["train", "box.obj", "-o", "a.cobra", "--points", "0"],
            "--points",
        ),
        (
            &["train", "box.obj", "-o", "a.cobra", "--points", "1e4"],
            "--points",
        ),
        (
            &["train", "box.obj", "-o", "a.cobra", "--seed=-1"],
            "--seed",
        ),
        (
            &["train", "box.obj", "-o", "a.cobra", "--components", "1025"],
            "--components",
        ),
        (&["demo", "--poses", "9"], "--poses"),
        (&["inspect", "a.cobra", "-q", "-v"], "--verbose"),
    ];
    for (arguments, said) in cases {
        let outcome = run(arguments);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "{said}: {outcome:?}");
        assert_eq!(outcome.stdout, "");
    }
}

#[test]
fn lengths_that_make_no_sense_are_code_2() {
    for (option, value) in [
        ("--delta", "0"),
        ("--delta", "-1"),
        ("--delta", "nan"),
        ("--sigma-hat", "inf"),
        ("--sigma-hat", "0"),
        ("--noise", "-0.1"),
        ("--noise", "wide"),
    ] {
        let value = format!("{option}={value}");
        let words = "score a.cobra --camera K.txt --poses p.json --correspondences c";
        let outcome = run(words.split(' ').chain([value.as_str()]));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains("millimetres"), "{outcome:?}");
    }
}
