# The programs that several parts run: the command `cobra`, and examples of the package cobra-tests.

programs_are_built=""

# As `cargo test` builds them, so that nothing is built twice: of the whole workspace, because which features
# dependencies have follows from the packages that are named.
build_programs() {
    cargo build --quiet --workspace --locked --bin cobra --bin cobra-firmware-budget \
        --example crowded-template --example object-points --example object-scene \
        --example print-bits --example write-bracket
}

# Not a test: what cannot be built fails those that run it, too.
need_programs() {
    [ -n "$programs_are_built" ] || check "the programs that the tests run" build_programs
    programs_are_built=yes
}

cobra_command() {
    "$target_dir/debug/cobra" "$@"
}

# example NAME ARGUMENT...
example() {
    local name=$1
    shift
    "$target_dir/debug/examples/$name" "$@"
}
