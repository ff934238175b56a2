//! Chooses the board: `COBRA_BOARD`, or the target's usual one. `memory/` says which there are. And
//! the agreement vectors: `COBRA_SET`, or as many as the board's flash holds.

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=COBRA_BOARD");
    println!("cargo::rerun-if-env-changed=COBRA_SET");
    println!("cargo::rerun-if-changed=memory");
    let target = env::var("TARGET")?;
    let board = match env::var("COBRA_BOARD") {
        Ok(board) => board,
        Err(_) => usual(&target).to_owned(),
    };
    let memory = Path::new("memory").join(format!("{board}.x"));
    let layout = fs::read(&memory)
        .map_err(|error| format!("COBRA_BOARD={board}: {}: {error}", memory.display()))?;
    let out = env::var("OUT_DIR")?;
    fs::write(Path::new(&out).join("memory.x"), layout)?;
    println!("cargo::rustc-env=COBRA_BOARD={board}");
    let small = ["microbit", "lm3s6965evb"].contains(&board.as_str());
    let set = env::var("COBRA_SET");
    let set = set
        .as_deref()
        .unwrap_or(if small { "k-means" } else { "all" });
    println!("cargo::rustc-env=COBRA_SET={set}");
    println!("cargo::rustc-link-search={out}");
    for argument in ["-Tlink.x", "--nmagic"] {
        println!("cargo::rustc-link-arg={argument}");
    }
    Ok(())
}

fn usual(target: &str) -> &'static str {
    if target.starts_with("thumbv6m") {
        "microbit"
    } else if target.starts_with("thumbv7m") {
        "mps2-an385"
    } else if target.starts_with("thumbv8m") {
        "mps2-an505"
    } else {
        "mps2-an386"
    }
}
