//! Links as `cortex-m` does. Its memory layout comes along with the dependency; arguments of the
//! linker do not.

fn main() {
    for argument in ["-Tlink.x", "--nmagic"] {
        println!("cargo::rustc-link-arg={argument}");
    }
}
