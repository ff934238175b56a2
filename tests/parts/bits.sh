# The same bits on other processors as on this one: every likelihood, confidence, threshold and
# decision of the agreement vectors and of the golden templates.

# In release mode, because that is what ships, and the optimiser is part of what must not change
# a bit. The host's tests compare the same without it.
comparison="--quiet --package cobra-agreement --features golden --bin agreement --release --locked"

# The names of the agreement vectors.
agreement_sets() {
    local file
    for file in tests/golden/agreement/*.cobra; do
        basename "$file" .cobra
    done
}

# same_bits WHERE COMMAND...: one test.
same_bits() {
    local name="the same bits $1"
    shift
    step "$name"
    if "$@"; then
        pass
    else
        fail "$name"
    fi
}

on_this_processor() {
    # shellcheck disable=SC2086 # a list of words
    cargo run $comparison
}

# With all that this very processor has, wider vectors and fused multiplication above all.
# A folder of its own: other flags would have everything else built anew.
with_every_instruction() {
    # shellcheck disable=SC2086 # a list of words
    RUSTFLAGS="${RUSTFLAGS-} -C target-cpu=native" \
        cargo run $comparison --target-dir "$target_dir/native"
}

# qemu-user under either of its names; newer packages have static builds without the suffix.
find_emulator() {
    local name
    for name in "qemu-$1-static" "qemu-$1"; do
        if command -v "$name" >/dev/null; then
            emulator=$name
            return
        fi
    done
    return 1
}

need_emulator() {
    find_emulator "$1" || { apt_install qemu-user-static && find_emulator "$1"; }
}

# A compiler may be there without the C library that it is to link.
links_statically() {
    command -v "$1" >/dev/null && [ -f "$("$1" -print-file-name=libc.a)" ]
}

need_linker() {
    local linker=$1
    shift
    links_statically "$linker" || { apt_install "$@" && links_statically "$linker"; }
}

# Static, so that the emulator need not be told where another processor's libraries lie.
under_emulator() (
    local target=$1 linker=$2 variable
    variable=CARGO_TARGET_$(printf '%s' "$target" | tr 'a-z-' 'A-Z_')
    export "${variable}_LINKER=$linker" "${variable}_RUNNER=$emulator"
    export RUSTFLAGS="${RUSTFLAGS-} -C target-feature=+crt-static"
    # shellcheck disable=SC2086 # a list of words
    cross "$target" std run $comparison
)

# on_linux ARCHITECTURE DEBIAN_ARCHITECTURE
on_linux() {
    local target=$1-unknown-linux-gnu linker=$1-linux-gnu-gcc
    if [ "$target" = "$(host_target)" ]; then
        return
    fi
    if ! need_emulator "$1"; then
        skip "the same bits on $target: no qemu-$1"
    elif ! need_linker "$linker" "gcc-$1-linux-gnu" "libc6-dev-$2-cross"; then
        skip "the same bits on $target: no $linker with a static C library"
    elif ! need_cross "$target"; then
        skip "the same bits on $target: no \`std\` for it"
    else
        same_bits "on $target" under_emulator "$target" "$linker"
    fi
}

# Debian calls the package nodejs, and the command node.
need_node() {
    command -v node >/dev/null || { apt_install nodejs && command -v node >/dev/null; }
}

# Sets `wasm_linker`.
find_wasm_linker() {
    wasm_linker=$(rustup_linkers)/rust-lld
    [ -x "$wasm_linker" ] || wasm_linker=$(command -v wasm-ld)
}

# rustup's is lent where `std` is built by Debian's toolchain, which has none.
need_wasm_linker() {
    find_wasm_linker || { apt_install lld && find_wasm_linker; }
}

in_node() (
    local target=$1
    export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$wasm_linker
    cross "$target" std,panic_abort build --quiet --package cobra-agreement-wasm --release --locked &&
        node tests/agreement-wasm/run.mjs "$cross_dir/$target/release/cobra_agreement_wasm.wasm"
)

in_webassembly() {
    local target=wasm32-unknown-unknown
    if ! need_node; then
        skip "the same bits in WebAssembly: no node"
    elif ! need_cross "$target"; then
        skip "the same bits in WebAssembly: no \`std\` for $target"
    elif ! need_wasm_linker; then
        skip "the same bits in WebAssembly: no rust-lld and no wasm-ld"
    else
        same_bits "in WebAssembly" in_node "$target"
    fi
}

compare_bits() {
    local host
    host=$(host_target)
    same_bits "on $host" on_this_processor
    same_bits "on $host with target-cpu=native" with_every_instruction
    on_linux aarch64 arm64
    # Big-endian.
    on_linux s390x s390x
    in_webassembly
}
