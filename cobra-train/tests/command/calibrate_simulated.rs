//! `cobra calibrate --simulate`: thresholds without labelled estimates.

use crate::run::{command, refuse, run, succeed};
use crate::scene::Scene;
use cobra_infer::Template;
use cobra_infer::template::CalibrationSource;

const SIMULATED: [&str; 6] = [
    "calibrate",
    "@part.cobra",
    "--simulate",
    "100",
    "--false-accept",
    "0.1",
];

#[test]
fn thresholds_from_simulated_estimates_are_stored_with_what_was_simulated() {
    let scene = Scene::charted();
    for (more, provenance) in [
        (&[][..], "own surface, silhouette, 1.5 mm"),
        (
            &[
                "--mesh",
                "@box.obj",
                "--depth-noise",
                "0.5",
                "--masks",
                "simulated",
            ],
            "mesh, mask, 0.5 mm",
        ),
    ] {
        let arguments = [&SIMULATED[..], &["-o", "@out.cobra"], more].concat();
        succeed(scene.arguments(&arguments));
        let after = std::fs::read(scene.path("out.cobra")).unwrap();
        let depth = Template::from_bytes(&after).unwrap().depth().unwrap();
        let calibration = depth.calibration.unwrap();
        assert_eq!(calibration.source, CalibrationSource::Simulated);
        assert_eq!(depth.provenance(), provenance);
        assert!(calibration.false_accepts.share <= 0.1);
        assert!(calibration.wrong + calibration.right <= 100);
        assert!(0.0 < calibration.reject && calibration.reject <= calibration.accept);
    }
}

#[test]
fn a_seed_gives_the_same_thresholds_whatever_the_number_of_threads() {
    let scene = Scene::charted();
    let found = |more: &[&str], threads: &str| {
        let arguments = scene
            .arguments(&[&SIMULATED[..], &["--mesh", "@box.obj", "--json", "-"], more].concat());
        let mut cobra = command();
        cobra.args(arguments).env("RAYON_NUM_THREADS", threads);
        let output = cobra.output().unwrap();
        assert!(output.status.success(), "{output:?}");
        output.stdout
    };
    let one = found(&[], "1");
    assert_eq!(one, found(&["--seed", "0"], "2"));
    assert_ne!(one, found(&["--seed", "1"], "2"));
}

#[test]
fn what_cannot_be_simulated_is_refused_in_a_line() {
    let scene = Scene::charted();
    let words = |more: &[&str]| {
        let words = [
            &["calibrate", "@part.cobra", "--false-accept", "0.001"][..],
            more,
        ]
        .concat();
        scene.arguments(&words)
    };
    refuse(
        words(&["--simulate", "200"]),
        3,
        &[
            "wrong estimates",
            "at least 3838",
            "raise --simulate to about",
        ],
    );
    refuse(
        words(&["--simulate", "200", "--mesh", "@none.ply"]),
        4,
        &["none.ply", "No such file"],
    );
    scene.write("large.obj", scene.read("box.obj").replace(" 85", " 185"));
    refuse(
        words(&["--simulate", "200", "--mesh", "@large.obj"]),
        3,
        &[
            "large.obj",
            "expected the template's object, with a diameter of",
        ],
    );
    for (more, said) in [
        (&["--simulate", "99"][..], "99 is not in 100..=1000000"),
        (
            &["--simulate", "200", "--labelled", "@report.json"],
            "cannot be used with",
        ),
        (&[], "--labelled"),
        (&["--simulate", "200", "--depth-noise=-1"], "-1"),
        (&["--labelled", "@report.json", "--seed", "1"], "--seed"),
        (
            &["--labelled", "@report.json", "--symmetric"],
            "--symmetric",
        ),
        (
            &["--labelled", "@report.json", "--mesh", "@box.obj"],
            "--mesh",
        ),
        (
            &["--labelled", "@report.json", "--masks", "simulated"],
            "--masks",
        ),
        (
            &["--labelled", "@report.json", "--depth-noise", "1"],
            "--depth-noise",
        ),
        (&["--seed", "1"], "--labelled"),
    ] {
        let outcome = run(words(more));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "{outcome:?}");
    }
}
