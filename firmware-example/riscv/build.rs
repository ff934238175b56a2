//! Lays out the memory of QEMU's `virt` machine.

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=COBRA_SET");
    println!("cargo::rerun-if-changed=memory");
    let set = env::var("COBRA_SET").unwrap_or("all".into());
    println!("cargo::rustc-env=COBRA_SET={set}");
    let out = env::var("OUT_DIR")?;
    fs::copy("memory/virt.x", Path::new(&out).join("memory.x"))?;
    println!("cargo::rustc-link-search={out}");
    for argument in ["-Tmemory.x", "-Tlink.x"] {
        println!("cargo::rustc-link-arg={argument}");
    }
    Ok(())
}
