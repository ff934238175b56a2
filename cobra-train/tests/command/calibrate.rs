//! `cobra calibrate`: thresholds from labelled estimates, in the template and on paper.

use crate::run::{json, refuse, run, succeed};
use crate::scene::Scene;
use cobra_infer::Template;
use cobra_infer::template::{CalibrationSource, DepthRecord};
use serde_json::{Value, json};

/// 100 wrong estimates from 0 to 0.495 of object 5, 100 right ones from 0.4 to 0.895 of object 6, and a
/// few that say nothing.
fn report() -> Value {
    let estimate = |row: usize, object: u32, confidence: Value, right: Option<bool>| {
        let truth =
            right.map(|right| json!({"error_mm": 3.5, "diameter_mm": 90.0, "right": right}));
        json!({
            "row": row, "scene_id": 2, "im_id": 3, "obj_id": object, "own_score": 0.5,
            "confidence": confidence, "valid_pixels": 200, "truth": truth,
        })
    };
    let mut estimates: Vec<Value> = (0..100)
        .map(|i| estimate(2 + i, 5, json!(f64::from(i as u32) / 200.0), Some(false)))
        .collect();
    estimates.extend((0..100).map(|i| {
        let confidence = 0.4 + f64::from(i as u32) / 200.0;
        estimate(102 + i, 6, json!(confidence), Some(true))
    }));
    estimates.push(estimate(202, 6, Value::Null, Some(true)));
    estimates.push(estimate(203, 6, json!(0.1), None));
    estimates.push(estimate(204, 6, json!(0.1), Some(true)));
    estimates[202]["valid_pixels"] = json!(9);
    // A row of the results file that was no estimate.
    estimates.push(json!({"row": 205, "obj_id": null, "confidence": null, "truth": null}));
    json!({"dataset": {"name": "made up"}, "estimates": estimates})
}

fn scene() -> Scene {
    let scene = Scene::trained();
    scene.write("report.json", report().to_string());
    scene
}

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let words = ["calibrate", "@part.cobra", "--labelled", "@report.json"];
    [&words[..], &["--false-accept", "0.05"], more].concat()
}

#[test]
fn the_thresholds_are_stored_in_the_template_and_nothing_else_changes() {
    let scene = scene();
    let before = std::fs::read(scene.path("part.cobra")).unwrap();
    succeed(scene.arguments(&words(&["-o", "@out.cobra"])));
    assert_eq!(std::fs::read(scene.path("part.cobra")).unwrap(), before);
    let after = std::fs::read(scene.path("out.cobra")).unwrap();
    let depth = Template::from_bytes(&after).unwrap().depth().unwrap();
    let calibration = depth.calibration.unwrap();
    // Five of a hundred wrong ones reach 0.475, and five right ones lie below 0.425.
    assert_eq!(calibration.accept, 0.47_f32.next_up());
    assert_eq!(calibration.reject, 0.425);
    assert_eq!((calibration.wrong, calibration.right), (100, 100));
    assert_eq!((calibration.minimum_points, calibration.target), (10, 0.05));
    assert_eq!(calibration.source, CalibrationSource::Labelled);
    let measured = calibration.false_accepts;
    assert_eq!(measured.share, 0.05);
    assert!(measured.low < 0.03 && 0.1 < measured.high);
    assert_eq!(depth.provenance(), "made up");
    assert_eq!(depth.noise_share, DepthRecord::NOISE_SHARE);
    // Behind the header, what was there stands unchanged.
    assert_eq!(after[16..before.len()], before[16..]);

    succeed(scene.arguments(&words(&[])));
    assert_eq!(std::fs::read(scene.path("part.cobra")).unwrap(), after);
    // And again: what was stored is replaced.
    succeed(scene.arguments(&words(&["--provenance", "once more"])));
    let again = std::fs::read(scene.path("part.cobra")).unwrap();
    assert_eq!(again.len(), after.len() + 2);
}

#[test]
fn the_table_and_the_json_tell_the_same_and_what_was_left_out() {
    let scene = scene();
    let outcome = succeed(scene.arguments(&words(&["--json", "@out.json"])));
    let document: Value = serde_json::from_str(&scene.read("out.json")).unwrap();
    let table = &outcome.stdout;
    assert!(table.contains("at least 0.4700"), "{table}");
    assert!(table.contains("below 0.4250"), "{table}");
    assert!(table.contains("85.00 %"), "{table}");
    assert_eq!(document["wrong"]["accepted"]["count"], 5);
    assert_eq!(document["right"]["accepted"]["share"], 0.85);
    assert_eq!(document["right"]["rejected"]["count"], 5);
    assert_eq!(document["provenance"], "made up");
    let area = document["area_under_roc"].as_f64().unwrap();
    assert!(
        table.contains(&format!("{area:.4} under the roc")),
        "{table}"
    );
    let left_out = &document["left_out"];
    for (key, said) in [
        ("not_scored", "1 estimate without a score left out"),
        ("without_truth", "2 estimates without truth left out"),
        (
            "too_few_pixels",
            "1 estimate with too few valid pixels left out",
        ),
    ] {
        let count = said.split(' ').next().unwrap();
        assert_eq!(left_out[key].to_string(), count, "{left_out}");
        assert!(outcome.stderr.contains(said), "{outcome:?}");
    }
    let alone = succeed(scene.arguments(&words(&["--json", "-"])));
    assert_eq!(json(&alone), document);
}

#[test]
fn fewer_pixels_than_the_report_was_scored_with_are_refused_since_its_confidences_are_zero_there() {
    let scene = scene();
    let mut strict = report();
    for estimate in strict["estimates"].as_array_mut().unwrap() {
        estimate["minimum_points"] = json!(30);
    }
    strict["estimates"][7]["minimum_points"] = json!(40);
    scene.write("report.json", strict.to_string());
    for points in [&[][..], &["--min-points", "39"]] {
        let said = [
            "report.json: row 9 was scored with a least of 40",
            "expected --min-points 40 or more",
        ];
        refuse(scene.arguments(&words(points)), 3, &said);
    }
    succeed(scene.arguments(&words(&["--min-points", "40"])));
    // Row 9 is of object 5: of object 6 alone 30 are enough, and too few are wrong.
    let alone = words(&["--object", "6", "--min-points", "30"]);
    refuse(scene.arguments(&alone), 3, &["0 wrong estimates"]);
}

#[test]
fn the_curves_are_svg_with_the_threshold_in_them() {
    let scene = scene();
    succeed(scene.arguments(&words(&["--curves", "@curves/of/part"])));
    for (name, said) in [
        ("roc.svg", "accepted from 0.470 on:"),
        ("precision-recall.svg", "accepted from 0.470 on:"),
        ("reliability.svg", "accepted from 0.470"),
    ] {
        let svg = scene.read(&format!("curves/of/part/{name}"));
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains(said), "{name}: {svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    }
}

#[test]
fn the_same_report_gives_the_same_bytes() {
    let scene = scene();
    let written = || {
        succeed(scene.arguments(&words(&[
            "-o",
            "@out.cobra",
            "--curves",
            "@c",
            "--json",
            "@j",
        ])));
        [
            "out.cobra",
            "c/roc.svg",
            "c/reliability.svg",
            "c/precision-recall.svg",
            "j",
        ]
        .map(|name| std::fs::read(scene.path(name)).unwrap())
    };
    assert_eq!(written(), written());
}

#[test]
fn inspect_shows_what_was_stored() {
    let scene = scene();
    let bare = json(&succeed(scene.arguments(&[
        "inspect",
        "@part.cobra",
        "--json",
        "-",
    ])));
    assert_eq!(bare["depth"], Value::Null);
    succeed(scene.arguments(&words(&[])));
    let table = succeed(scene.arguments(&["inspect", "@part.cobra"])).stdout;
    for said in [
        "depth mode  sigma_m 6.00 % of the diameter; accepted from 0.4700 on",
        "calibrated  5.00 % of wrong estimates accepted (2.15 to 11.18 %, aimed at 5.00 %), on 100 wrong \
         and 100 right ones (labelled: made up)",
        "\nsize        ",
    ] {
        assert!(table.contains(said), "{said}: {table}");
    }
    let document = json(&succeed(scene.arguments(&[
        "inspect",
        "@part.cobra",
        "--json",
        "-",
    ])));
    let calibration = &document["depth"]["calibration"];
    assert_eq!(calibration["source"], "labelled");
    assert_eq!(calibration["wrong"], 100);
    let accept = calibration["accept"].as_f64().unwrap();
    assert!((accept - 0.47).abs() < 1e-6);
}

#[test]
fn what_gives_no_thresholds_is_refused_in_a_line_and_nothing_is_written() {
    let scene = scene();
    let before = std::fs::read(scene.path("part.cobra")).unwrap();
    let refused = |more: &[&str], code: i32, said: &[&str]| {
        refuse(scene.arguments(&words(more)), code, said);
    };
    // Object 5 has wrong estimates alone.
    refused(
        &["--object", "5"],
        3,
        &["report.json", "0 right estimates", "at least 73"],
    );
    refused(
        &["--object", "7"],
        3,
        &["report.json", "no estimate is of object 7"],
    );
    refused(
        &["--reject-right", "0.001"],
        3,
        &["100 right estimates", "at least 3838"],
    );
    refused(&["--provenance", &"x".repeat(49)], 2, &["49 bytes", "48"]);
    refused(
        &["-o", "@report.json"],
        2,
        &["report.json is both an input and an output"],
    );
    refused(&["--json", "@part.cobra"], 2, &["part.cobra is both"]);
    for share in ["0", "1", "-0.1", "5 %", "nan"] {
        let words = ["calibrate", "@part.cobra", "--labelled", "@report.json"];
        let option = format!("--false-accept={share}");
        let outcome = run(scene.arguments(&[&words[..], &[&option]].concat()));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains("such as 0.01"), "{outcome:?}");
    }

    let mut without_truth = report();
    for estimate in without_truth["estimates"].as_array_mut().unwrap() {
        estimate["truth"] = Value::Null;
    }
    scene.write("report.json", without_truth.to_string());
    refused(&[], 3, &["report.json", "no estimate has a truth"]);
    scene.write("report.json", r#"{"estimates": []}"#);
    refused(&[], 3, &["report.json", "holds no estimate"]);
    scene.write("report.json", r#"{"estimates": [{"row": 2}]}"#);
    refused(&[], 3, &["report.json", "estimates[0].obj_id"]);
    scene.write("report.json", "{");
    refused(&[], 3, &["report.json", "not valid JSON"]);
    std::fs::remove_file(scene.path("report.json")).unwrap();
    refused(&[], 4, &["report.json", "No such file"]);
    assert_eq!(std::fs::read(scene.path("part.cobra")).unwrap(), before);
}
