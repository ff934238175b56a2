//! Says which way to the square root the target has, as `--cfg way="…"`.
//!
//! Here and not by `cfg` in the code, because the compiler names neither Arm's nor RISC-V's
//! floating-point features on its stable channel: the one shows in the target's ABI, the other in
//! its name.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!(r#"cargo::rustc-check-cfg=cfg(way, values("std", "arm", "riscv", "libm"))"#);
    println!("cargo::rustc-cfg=way=\"{}\"", way());
}

fn way() -> &'static str {
    let variable = |name: &str| env::var(name).unwrap_or_default();
    let (arch, os) = (
        variable("CARGO_CFG_TARGET_ARCH"),
        variable("CARGO_CFG_TARGET_OS"),
    );
    let bare = os == "none";
    if has_std(&os, &arch) {
        "std"
    } else if bare && arch == "arm" && variable("CARGO_CFG_TARGET_ABI") == "eabihf" {
        "arm"
    } else if bare && arch.starts_with("riscv") && has_riscv_f(&variable("TARGET")) {
        "riscv"
    } else {
        "libm"
    }
}

fn has_std(os: &str, arch: &str) -> bool {
    let family = |name: &str| env::var_os(name).is_some();
    family("CARGO_CFG_UNIX") || family("CARGO_CFG_WINDOWS") || (arch == "wasm32" && os == "unknown")
}

/// Whether the extensions in a target's name, such as `riscv32imafc-unknown-none-elf`, have F.
fn has_riscv_f(target: &str) -> bool {
    let isa = target.split('-').next().unwrap_or_default();
    let extensions = isa
        .strip_prefix("riscv32")
        .or_else(|| isa.strip_prefix("riscv64"));
    // What follows an underscore or z are names of several letters.
    let single = extensions.and_then(|names| names.split(['_', 'z']).next());
    single.is_some_and(|letters| letters.contains(['f', 'g', 'd']))
}
