//! `cobra report`: the page, as far as its text tells. What a browser makes of it: `tests/run browser`.

use crate::run::{command, refuse, run, succeed};
use crate::scene::Scene;
use serde_json::Value;

const FEW: [&str; 2] = ["--points", "2000"];

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["report", "@part.cobra"], &FEW[..], more].concat()
}

/// The page on standard output.
fn page(scene: &Scene, more: &[&str]) -> String {
    let more = [more, &["-o", "-"]].concat();
    succeed(scene.arguments(&words(&more))).stdout
}

/// The figures that are in it, for programs.
fn figures(page: &str) -> Value {
    let data = page.split_once("id=\"report-data\">").unwrap().1;
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

/// What a reader sees: neither scripts nor styles.
fn text(page: &str) -> String {
    let mut rest = page;
    let mut text = String::new();
    while let Some((before, element)) = rest.split_once('<') {
        text += before;
        let end = ["script", "style"]
            .into_iter()
            .find(|name| element.starts_with(name));
        rest = match end {
            Some(name) => element.split_once(&format!("</{name}>")).unwrap().1,
            None => element.split_once('>').unwrap().1,
        };
    }
    text
}

#[test]
fn the_page_lies_beside_the_template_under_its_name() {
    let scene = Scene::charted();
    let outcome = succeed(scene.arguments(&words(&[])));
    assert_eq!(outcome.stdout, "");
    assert!(outcome.stderr.contains("part.html: "), "{outcome:?}");
    assert!(scene.read("part.html").starts_with("<!DOCTYPE html>"));
    succeed(scene.arguments(&words(&["-o", "@other.html", "--quiet"])));
    assert!(scene.read("other.html").ends_with("</html>\n"));
}

#[test]
fn with_a_mesh_the_page_says_what_is_covered_and_without_what_is_not_known() {
    let scene = Scene::charted();
    let measured = page(&scene, &["--mesh", "@box.obj"]);
    let found = figures(&measured);
    let covered = found["coverage"]["covered"].as_f64().unwrap();
    assert!(covered > 90.0, "{covered}");
    assert_eq!(found["coverage"]["own"]["points"], 2000);
    assert_eq!(found["view"]["measured"], true);
    assert_eq!(found["view"]["surface"], true);
    // A box of twelve triangles, in parts that show where it is not covered.
    assert!(
        found["view"]["triangles"].as_u64().unwrap() > 5_000,
        "{}",
        found["view"]
    );
    let shares = found["content"]["components"].as_array().unwrap().iter();
    let sum: f64 = shares.map(|one| one["spoken"].as_f64().unwrap()).sum();
    assert!((sum - covered).abs() < 1e-9, "{sum} of {covered}");
    let said = text(&measured);
    assert!(said.contains("points that training did not see"), "{said}");
    assert!(said.contains("wrongly accepted"), "{said}");

    let alone = page(&scene, &[]);
    let found = figures(&alone);
    assert_eq!(found["coverage"]["own"], Value::Null);
    assert_eq!(found["view"]["measured"], false);
    assert!(alone.contains("value=\"residual\" disabled"));
    assert!(text(&alone).contains("Measured when it was trained"));
}

#[test]
fn the_parts_of_the_size_and_the_boards_are_on_the_page() {
    let scene = Scene::charted();
    let found = figures(&page(&scene, &["--mesh", "@box.obj"]));
    let bytes = &found["content"]["bytes"];
    let size = std::fs::metadata(scene.path("part.cobra")).unwrap().len();
    assert_eq!(bytes["total"], size);
    let components = found["content"]["components"].as_array().unwrap();
    let terms: u64 = components
        .iter()
        .map(|one| one["bytes"].as_u64().unwrap())
        .sum();
    assert_eq!(bytes["terms"], terms);
    for board in found["budget"].as_array().unwrap() {
        let of = &board["instructions"];
        let [mean, most] = ["mean", "most"].map(|key| of[key].as_f64().unwrap());
        assert!(
            board["point"].as_f64().unwrap() < mean && mean <= most,
            "{board}"
        );
    }
}

#[test]
fn templates_of_every_kind_have_a_page() {
    for more in [
        &["--mean", "map"][..],
        &["--budget", "none"],
        &["--kernel", "matern32", "--unit", "cm"],
    ] {
        let scene = Scene::new();
        scene.train_charts(more);
        let found = figures(&page(&scene, &["--mesh", "@box.obj"]));
        assert!(
            found["coverage"]["covered"].as_f64().unwrap() > 80.0,
            "{more:?}"
        );
        let measured = more == ["--budget", "none"];
        assert_eq!(
            found["budget"][0]["instructions"].is_null(),
            !measured,
            "{more:?}"
        );
    }
    // Without validity too, where the own surface is what is nearest to each reference point.
    let scene = Scene::trained();
    let found = figures(&page(&scene, &[]));
    assert!(
        found["view"]["places"].as_u64().unwrap() > 1_000,
        "{}",
        found["view"]
    );
    assert_eq!(found["coverage"]["covered"], Value::Null);
}

#[test]
fn nothing_on_the_page_is_loaded_from_elsewhere() {
    let scene = Scene::charted();
    let page = page(&scene, &["--mesh", "@box.obj"]);
    assert!(page.contains("content=\"default-src 'none'; script-src 'unsafe-inline'"));
    for loads in [
        "src=\"http",
        "src=\"//",
        "href=",
        "url(",
        "@import",
        "<link",
        "<iframe",
    ] {
        let markup = page.split_once("<script>").unwrap().0;
        assert!(!markup.contains(loads), "{loads}");
    }
}

#[test]
fn a_name_is_text_whatever_it_holds() {
    let scene = Scene::new();
    let name = "</script><b>&\"'";
    scene.train_charts(&["--name", name]);
    let page = page(&scene, &["--mesh", "@box.obj"]);
    assert!(!page.contains(name) && !page.contains("<b>"));
    assert!(page.contains("&lt;/script&gt;&lt;b&gt;&amp;"));
    assert_eq!(figures(&page)["content"]["name"], name);
}

#[test]
fn the_command_stands_on_the_page_as_it_was_typed() {
    let scene = Scene::charted();
    scene.write("my box.obj", scene.read("box.obj"));
    let mut cobra = command();
    cobra.current_dir(scene.folder());
    cobra.args([
        "report",
        "part.cobra",
        "--mesh",
        "my box.obj",
        "--seed",
        "3",
        "-o",
        "-",
    ]);
    let page = String::from_utf8(cobra.output().unwrap().stdout).unwrap();
    let typed = "cobra report part.cobra --mesh 'my box.obj' --seed 3 -o -";
    assert_eq!(figures(&page)["made"]["command"], typed);
    let folder = scene.folder().to_str().unwrap();
    assert!(!page.contains(folder), "a path that nobody typed");
    assert!(page.contains("cobra report part.cobra --mesh 'my box.obj'"));
}

#[test]
fn the_same_input_gives_the_same_page_on_any_number_of_threads() {
    let scene = Scene::charted();
    let made = |threads: &str| {
        let mut cobra = command();
        cobra.env("RAYON_NUM_THREADS", threads);
        cobra.args(scene.arguments(&words(&["--mesh", "@box.obj", "-o", "-"])));
        cobra.output().unwrap().stdout
    };
    let one = made("1");
    assert!(one.len() > 500_000);
    assert!(one == made("2"), "pages differ");
}

#[test]
fn curves_and_ambiguities_come_from_the_commands_that_find_them() {
    let scene = Scene::charted();
    let calibrate = [
        "calibrate",
        "@part.cobra",
        "--simulate",
        "200",
        "--false-accept",
        "0.1",
    ];
    let stored = ["-o", "@stored.cobra", "--curves", "@curves"];
    succeed(scene.arguments(&[&calibrate[..], &stored].concat()));
    let ambiguity = [
        "ambiguity",
        "@stored.cobra",
        "--mesh",
        "@box.obj",
        "--views",
        "2",
    ];
    let few = ["--candidates", "100", "--json", "@ambiguity.json"];
    succeed(scene.arguments(&[&ambiguity[..], &few].concat()));
    let report = ["report", "@stored.cobra", "-o", "-"];
    let given = ["--curves", "@curves", "--ambiguity", "@ambiguity.json"];
    let page = succeed(scene.arguments(&[&report[..], &given].concat())).stdout;
    assert_eq!(page.matches("src=\"data:image/svg+xml;base64,").count(), 3);
    let said = text(&page);
    assert!(said.contains("own surface, silhouette"), "{said}");
    assert!(said.contains("turn by 180 degrees about"), "{said}");
    assert!(
        said.contains("accepted by the template's threshold"),
        "{said}"
    );
    assert!(
        said.contains("right poses have a confidence of 0."),
        "{said}"
    );

    // Of other thresholds, of none, and of another object.
    let page = ["report", "@part.cobra", "-o", "-", "--curves", "@curves"];
    refuse(
        scene.arguments(&page),
        3,
        &["no thresholds", "cobra calibrate"],
    );
    let roc = scene.read("curves/roc.svg");
    for (from, to) in [
        ("right and", "right or"),
        ("accepted from 0.", "accepted from 1."),
    ] {
        assert!(roc.contains(from), "{from}");
        scene.write("curves/roc.svg", roc.replace(from, to));
        refuse(
            scene.arguments(&[&report[..], &given].concat()),
            3,
            &["roc.svg", "wrong estimates", "these are of others"],
        );
    }
    let found = scene.read("ambiguity.json");
    assert!(found.contains("The threshold accepts these too"), "{found}");
    for (from, to, said) in [
        ("\"box\"", "\"ball\"", ["`box`", "`ball`"]),
        (
            "\"calibrated\": true",
            "\"calibrated\": false",
            ["with the threshold 0.", "without a threshold"],
        ),
        (
            "\"accepted_from\": 0.",
            "\"accepted_from\": 0.0",
            ["with the threshold 0.0", "run cobra ambiguity again"],
        ),
    ] {
        assert!(found.contains(from), "{from}: {found}");
        scene.write("ambiguity.json", found.replace(from, to));
        refuse(
            scene.arguments(&[&report[..], &["--ambiguity", "@ambiguity.json"]].concat()),
            3,
            &["ambiguity.json", said[0], said[1]],
        );
    }

    // Before the template had a threshold they are those that score like the right pose.
    let before = found.replace("\"calibrated\": true", "\"calibrated\": false");
    scene.write("ambiguity.json", before);
    let page = ["report", "@part.cobra", "-o", "-"];
    let given = ["--ambiguity", "@ambiguity.json"];
    let page = succeed(scene.arguments(&[&page[..], &given].concat())).stdout;
    assert!(text(&page).contains("nearly as well as the right one"));
}

#[test]
fn what_is_no_input_is_refused_by_name() {
    let scene = Scene::charted();
    scene.write("broken.json", "{}");
    for (more, code, said) in [
        (&["--mesh", "@none.obj"][..], 4, "none.obj"),
        (&["--mesh", "@K.txt"], 3, "K.txt"),
        (&["--curves", "@none"], 3, "no thresholds"),
        (&["--ambiguity", "@none.json"], 4, "none.json"),
        (&["--ambiguity", "@broken.json"], 3, "broken.json"),
    ] {
        refuse(scene.arguments(&words(more)), code, &[said]);
    }
    refuse(
        scene.arguments(&["report", "@none.cobra"]),
        4,
        &["none.cobra"],
    );
    refuse(scene.arguments(&["report", "@box.obj"]), 3, &["box.obj"]);
    assert_eq!(run(["report"]).code, Some(2));
    assert_eq!(
        run(scene.arguments(&words(&["--unit-sphere"]))).code,
        Some(2)
    );
    assert!(!scene.names().contains(&"part.html".to_owned()));
}

#[test]
fn another_objects_mesh_is_refused() {
    let scene = Scene::charted();
    let larger = Scene::scaled(10.0).read("box.obj");
    scene.write("larger.obj", larger);
    refuse(
        scene.arguments(&words(&["--mesh", "@larger.obj"])),
        3,
        &[
            "larger.obj",
            "expected the template's object",
            "found one of 1077",
        ],
    );
}

#[test]
fn a_page_replaces_no_input_and_is_whole_or_not_there() {
    let scene = Scene::charted();
    let before = scene.names();
    for (path, name) in [("@part.cobra", "part.cobra"), ("@box.obj", "box.obj")] {
        let more = ["--mesh", "@box.obj", "-o", path];
        refuse(
            scene.arguments(&words(&more)),
            2,
            &[name, "is both an input"],
        );
    }
    for path in [
        "@K.txt/out.html",
        "@none/out.html",
        "@correspondences",
        "/proc/out",
    ] {
        refuse(scene.arguments(&words(&["-o", path])), 4, &["cannot write"]);
    }
    assert_eq!(scene.names(), before);
}
