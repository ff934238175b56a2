//! Prints the demonstration's bracket as an OBJ file, in millimetres.
//!
//! `cargo run --release -p cobra-tests --example write-bracket > bracket.obj`

use cobra_train::demo::mechanical_part;
use std::io::Write;

fn main() -> std::io::Result<()> {
    let mesh = mechanical_part();
    let mut out = std::io::stdout().lock();
    for vertex in mesh.vertices() {
        writeln!(out, "v {} {} {}", vertex.x, vertex.y, vertex.z)?;
    }
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|index| index + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(())
}
