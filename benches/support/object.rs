//! The objects that are measured.

use cobra_train::demo::mechanical_part;
use cobra_train::surface::{Mesh, read_mesh};
use std::path::{Path, PathBuf};

/// A mesh and what to call it.
pub(crate) struct Object {
    /// The name in tables and criterion's groups.
    pub(crate) name: &'static str,
    /// The mesh, in millimetres.
    pub(crate) mesh: Mesh,
}

/// The demonstration's part, and the paper's screwdriver where the shared data is.
///
/// The part is made by code, so that everybody measures at least one and the same object.
pub(crate) fn objects() -> Vec<Object> {
    let part = Object {
        name: "part",
        mesh: mechanical_part(),
    };
    let mut objects = vec![part];
    let path = shared().join("data/screwdriver/model.ply");
    match read_mesh(&path) {
        Ok(mesh) => objects.push(Object {
            name: "screwdriver",
            mesh,
        }),
        Err(error) => eprintln!("without the screwdriver (COBRA_SHARED names its folder): {error}"),
    }
    for Object { name, mesh } in &objects {
        eprintln!("object: {name}, {} triangles", mesh.triangles().len());
    }
    objects
}

fn shared() -> PathBuf {
    std::env::var_os("COBRA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    )
}
