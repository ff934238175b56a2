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
    let Some((_, core)) = BOARDS.iter().find(|(name, _)| *name == board) else {
        let names = BOARDS.map(|(name, _)| name).join(", ");
        return Err(format!("COBRA_BOARD={board}: not one of {names}").into());
    };
    if !target.starts_with(core) {
        return Err(format!("COBRA_BOARD={board} is a board for {core}, not for {target}").into());
    }
    let layout = fs::read(Path::new("memory").join(format!("{board}.x")))?;
    let out = env::var("OUT_DIR")?;
    fs::write(Path::new(&out).join("memory.x"), layout)?;
    println!("cargo::rustc-env=COBRA_BOARD={board}");
    let small = ["microbit", "lm3s6965evb", "mps3-an547"].contains(&board.as_str());
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

/// Boards, and what their targets' names start with.
const BOARDS: [(&str, &str); 6] = [
    ("microbit", "thumbv6m"),
    ("mps2-an385", "thumbv7m"),
    ("lm3s6965evb", "thumbv7m"),
    ("mps2-an386", "thumbv7em"),
    ("mps2-an505", "thumbv8m.main"),
    ("mps3-an547", "thumbv8m.main"),
];

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
