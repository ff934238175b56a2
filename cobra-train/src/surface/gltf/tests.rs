//! What is read of glTF files, and what is refused with which words.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::Point3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use super::super::content::{BadContent, Soup};

/// A triangle of `f32` positions and `u16` indices, in that order.
fn data() -> Vec<u8> {
    let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    let mut bytes: Vec<u8> = positions
        .iter()
        .flatten()
        .flat_map(|c| c.to_le_bytes())
        .collect();
    bytes.extend([0_u16, 1, 2, 0].iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

/// A document with that triangle in `uri`, or in the binary chunk.
fn document(uri: Option<&str>) -> Value {
    let mut buffer = json!({"byteLength": 44});
    if let Some(uri) = uri {
        buffer["uri"] = uri.into();
    }
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 2, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 8}
        ],
        "buffers": [buffer]
    })
}

fn embedded() -> Value {
    let uri = format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(data())
    );
    document(Some(&uri))
}

fn glb(document: &Value, data: &[u8]) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + data.len();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_slice()), (b"BIN\0", data)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

fn parse(bytes: &[u8]) -> Result<Soup, BadContent> {
    super::parse(bytes, "/nowhere".as_ref())
}

fn read(document: &Value) -> Soup {
    parse(document.to_string().as_bytes()).unwrap()
}

fn error(document: &Value) -> BadContent {
    parse(document.to_string().as_bytes()).unwrap_err()
}

fn at<const N: usize>(points: [[f64; 3]; N]) -> Vec<Point3<f64>> {
    points.map(Point3::from).to_vec()
}

const TRIANGLE: [[f64; 3]; 3] = [[0., 0., 0.], [1., 0., 0.], [0., 2., 0.]];

#[test]
fn data_uris_and_binary_files_are_read() {
    let expected = (at(TRIANGLE), vec![[0, 1, 2]]);
    assert_eq!(read(&embedded()), expected);
    let mut binary = glb(&document(None), &data());
    assert_eq!(parse(&binary).unwrap(), expected);
    binary.extend(b"whatever follows");
    assert_eq!(parse(&binary).unwrap(), expected);
}

#[test]
fn files_beside_the_document_are_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("a b")).unwrap();
    std::fs::write(folder.path().join("a b/data.bin"), data()).unwrap();
    for uri in ["a%20b/data.bin", "./a b/data.bin"] {
        let text = document(Some(uri)).to_string();
        let (vertices, _) = super::parse(text.as_bytes(), folder.path()).unwrap();
        assert_eq!(vertices, at(TRIANGLE));
    }
}

#[test]
fn files_elsewhere_or_missing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("inside");
    std::fs::create_dir(&inside).unwrap();
    std::fs::write(folder.path().join("data.bin"), data()).unwrap();
    let absolute = folder.path().join("data.bin");
    for uri in [
        "../data.bin",
        "%2e%2e/data.bin",
        "x/../../data.bin",
        absolute.to_str().unwrap(),
        "file:///data.bin",
        "https://example.org/data.bin",
        "..\\data.bin",
        "",
    ] {
        let text = document(Some(uri)).to_string();
        let bad = super::parse(text.as_bytes(), &inside).unwrap_err();
        assert!(bad.expected.contains("own folder"), "{uri}: {bad:?}");
    }
    for uri in ["data.bin", "."] {
        let text = document(Some(uri)).to_string();
        let bad = super::parse(text.as_bytes(), &inside).unwrap_err();
        assert!(bad.found.starts_with(&format!("`{uri}`: ")), "{bad:?}");
    }
    for uri in ["data:text/plain,abc", "data:;base64,!!!"] {
        assert_eq!(error(&document(Some(uri))).expected, "a data URI in base64");
    }
    let bad = error(&document(None));
    assert_eq!(
        (bad.expected.as_str(), bad.found.as_str()),
        ("44 bytes in buffer 0", "0")
    );
}

#[test]
fn the_transforms_of_all_nodes_above_are_applied() {
    let mut scene = embedded();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    scene["nodes"] = json!([
        {"translation": [10, 0, 0], "children": [1, 2]},
        {"rotation": [0, 0, half, half], "scale": [2, 2, -2], "mesh": 0},
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1], "mesh": 0}
    ]);
    let (vertices, triangles) = read(&scene);
    let expected = at([
        [10., 0., 0.],
        [10., 2., 0.],
        [6., 0., 0.],
        [10., 0., 5.],
        [11., 0., 5.],
        [10., 2., 5.],
    ]);
    for (vertex, expected) in vertices.iter().zip(&expected) {
        assert!((vertex - expected).norm() < 1e-6, "{vertex} {expected}");
    }
    assert_eq!(triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn without_a_scene_all_roots_are_read_and_without_a_default_the_first() {
    let mut scene = embedded();
    scene["nodes"] = json!([{"mesh": 0}, {"children": [0]}, {"mesh": 0}]);
    scene["scenes"] = json!([{"nodes": [2]}, {"nodes": [1]}]);
    assert_eq!(read(&scene).1.len(), 1);
    let fields = scene.as_object_mut().unwrap();
    fields.remove("scene");
    assert_eq!(read(&scene).1.len(), 1);
    scene.as_object_mut().unwrap().remove("scenes");
    assert_eq!(read(&scene).1, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn strips_and_fans_are_turned_into_triangles_and_lines_are_left_out() {
    let mut scene = embedded();
    scene["accessors"][1]["count"] = 4.into();
    for (mode, expected) in [
        (4, vec![[0, 1, 2]]),
        (5, vec![[0, 1, 2], [2, 1, 0]]),
        (6, vec![[0, 1, 2], [0, 2, 0]]),
        (1, vec![]),
    ] {
        scene["meshes"][0]["primitives"][0]["mode"] = mode.into();
        assert_eq!(read(&scene).1, expected, "{mode}");
    }
}

#[test]
fn points_count_where_there_are_no_triangles() {
    let mut scene = embedded();
    let primitives = scene["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"POSITION": 0}, "mode": 0}));
    let (vertices, triangles) = read(&scene);
    assert_eq!((vertices.len(), triangles.len()), (3, 1));
    scene["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .remove(0);
    assert_eq!(read(&scene), (at(TRIANGLE), vec![]));
}

#[test]
fn primitives_that_share_their_vertices_share_them_and_need_no_indices() {
    let mut scene = embedded();
    let primitives = scene["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"POSITION": 0, "_MINE": 0}, "material": 7}));
    let (vertices, triangles) = read(&scene);
    assert_eq!((vertices.len(), triangles), (3, vec![[0, 1, 2], [0, 1, 2]]));
}

#[test]
fn sparse_and_quantized_positions_are_read() {
    let mut scene = embedded();
    // Place 1 of the indices' view is 1; the value is the third position.
    scene["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": 1, "byteOffset": 2, "componentType": 5123},
        "values": {"bufferView": 0, "byteOffset": 24}
    });
    let mut expected = TRIANGLE;
    expected[1] = TRIANGLE[2];
    assert_eq!(read(&scene).0, at(expected));
    scene["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    assert_eq!(read(&scene).0, at([[0.; 3], TRIANGLE[2], [0.; 3]]));

    let mut scene = embedded();
    scene["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_materials_unlit"]);
    scene["accessors"][0] = json!({"bufferView": 0, "componentType": 5120, "count": 3, "type": "VEC3", "normalized": true});
    // The bytes of 0, 0, 0, 1.0: 00 … 00 80 3f.
    scene["bufferViews"][0]["byteOffset"] = 12.into();
    scene["bufferViews"][0]["byteLength"] = 9.into();
    let (vertices, _) = read(&scene);
    assert_eq!(vertices[0], Point3::new(0.0, 0.0, -1.0));
    assert_eq!(vertices[1], Point3::new(63.0 / 127.0, 0.0, 0.0));
}

#[test]
fn required_extensions_that_hide_geometry_are_named() {
    for name in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "MY_own",
    ] {
        let mut scene = embedded();
        scene["extensionsUsed"] = json!([name]);
        assert_eq!(read(&scene).1.len(), 1);
        scene["extensionsRequired"] = json!([name]);
        let bad = error(&scene);
        assert_eq!(bad.found, format!("the required extension `{name}`"));
    }
    let mut scene = embedded();
    scene["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    assert!(error(&scene).found.contains("accessors[0].bufferView"));
}

#[test]
fn documents_that_lie_are_errors_that_name_their_place() {
    let cases: [(&str, Value, &str); 19] = [
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            9.into(),
            "accessor 9",
        ),
        (
            "/meshes/0/primitives/0/indices",
            9.into(),
            "meshes[0].primitives[0].indices",
        ),
        ("/meshes/0/primitives/0/indices", 0.into(), "Vec3 of F32"),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            1.into(),
            "Scalar of U16",
        ),
        ("/meshes/0/primitives/0/mode", 9.into(), "mode"),
        (
            "/accessors/0/count",
            u64::MAX.into(),
            "18446744073709551615",
        ),
        ("/accessors/0/count", 4.into(), "view of 36 bytes"),
        ("/accessors/0/count", 2.into(), "2"),
        ("/accessors/0/componentType", 1.into(), "componentType"),
        (
            "/accessors/0/byteOffset",
            u64::MAX.into(),
            "view of 36 bytes",
        ),
        ("/accessors/1/count", 15_000_000.into(), "view of 8 bytes"),
        ("/accessors/1/count", 30_000_000.into(), "30000000"),
        (
            "/bufferViews/0/byteLength",
            u64::MAX.into(),
            "shorter buffer",
        ),
        (
            "/bufferViews/0/byteOffset",
            u64::MAX.into(),
            "shorter buffer",
        ),
        ("/bufferViews/0/buffer", 3.into(), "bufferViews[0].buffer"),
        ("/buffers/0/byteLength", u64::MAX.into(), "44"),
        ("/scenes/0/nodes/0", 7.into(), "scenes[0].nodes[0]"),
        ("/scene", 7.into(), "scene"),
        ("/nodes/0/mesh", 7.into(), "nodes[0].mesh"),
    ];
    for (pointer, value, said) in cases {
        let mut scene = embedded();
        match scene.pointer_mut(pointer) {
            Some(place) => *place = value,
            None => {
                let (parent, key) = pointer.rsplit_once('/').unwrap();
                scene.pointer_mut(parent).unwrap()[key] = value;
            }
        }
        let bad = error(&scene);
        assert!(bad.found.contains(said), "{pointer}: {bad:?}");
    }
}

#[test]
fn nodes_in_circles_and_multitudes_of_instances_are_refused() {
    let mut scene = embedded();
    for nodes in [
        json!([{"mesh": 0, "children": [0]}]),
        json!([{"children": [1, 1]}, {"mesh": 0}]),
        json!([{"children": [1]}, {"children": [0]}]),
    ] {
        scene["nodes"] = nodes;
        assert_eq!(error(&scene).expected, "nodes that form trees");
    }
    let mut scene = embedded();
    let zeros = "A".repeat(4 * 100_000);
    scene["buffers"][0] = json!({"byteLength": 300_000, "uri": format!("data:;base64,{zeros}")});
    scene["bufferViews"][0]["byteLength"] = 300_000.into();
    scene["accessors"][0]["count"] = 25_000.into();
    scene["nodes"] = (0..2000).map(|_| json!({"mesh": 0})).collect();
    scene["scenes"][0]["nodes"] = (0..2000).collect();
    assert!(error(&scene).expected.contains("20000000 vertices"));
}

#[test]
fn a_deep_tree_costs_no_stack() {
    let mut scene = embedded();
    let mut nodes: Vec<Value> = (1..100_000).map(|i| json!({"children": [i]})).collect();
    nodes.push(json!({"mesh": 0}));
    scene["nodes"] = nodes.into();
    assert_eq!(read(&scene).1, [[0, 1, 2]]);
}

#[test]
fn a_truncated_binary_file_is_an_error_at_every_length() {
    let whole = glb(&document(None), &data());
    for length in 0..whole.len() {
        assert!(parse(&whole[..length]).is_err(), "{length}");
    }
    for (place, length) in [(8, 0_u32), (8, 11), (8, u32::MAX), (4, 1), (12, u32::MAX)] {
        let mut bytes = whole.clone();
        bytes[place..place + 4].copy_from_slice(&length.to_le_bytes());
        assert!(parse(&bytes).is_err(), "{place} {length}");
    }
}

#[test]
fn flipped_bytes_never_panic() {
    let whole = glb(&document(None), &data());
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    for _ in 0..20_000 {
        let mut bytes = whole.clone();
        for _ in 0..rng.random_range(1..4) {
            let place = rng.random_range(0..bytes.len());
            bytes[place] = rng.random();
        }
        if let Ok((vertices, triangles)) = parse(&bytes) {
            let count = vertices.len() as u32;
            assert!(triangles.iter().flatten().all(|&i| i < count));
        }
    }
}
