# What the machine has, and how what is missing is installed.

# A download that hangs must not hang the run, and macOS has no `timeout`.
limited() {
    local seconds=$1
    shift
    if command -v timeout >/dev/null; then
        timeout "$seconds" "$@" </dev/null
    else
        perl -e 'alarm shift; exec @ARGV or exit 127' "$seconds" "$@" </dev/null
    fi
}

apt_get() {
    local as_root=""
    if [ "$(id -u)" -ne 0 ]; then
        as_root="sudo -n"
    fi
    # --no-remove: a test run must not trade away packages somebody chose. The time
    # limits are apt's own, because killing it can leave packages half installed.
    # shellcheck disable=SC2086 # empty must vanish, not become an argument
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends \
        --no-remove -o DPkg::Lock::Timeout=120 -o Acquire::http::Timeout=30 \
        -o Acquire::https::Timeout=30 "$@" </dev/null >/dev/null
}

apt_install() {
    command -v apt-get >/dev/null || return 1
    [ "$(id -u)" -eq 0 ] || sudo -n true 2>/dev/null || return 1
    step "apt-get install $*"
    # A fresh container has no package lists, or stale ones.
    apt_get install "$@" 2>/dev/null || { apt_get update && apt_get install "$@"; }
}

# apt_unpack FOLDER PREFIX PACKAGE...: for packages that apt would install only in exchange for others, as
# Debian's QEMU for disk tools of a later release. Those whose names begin with PREFIX are unpacked into
# the folder and change nothing on the machine; what else they take is installed.
apt_unpack() {
    local folder=$1 prefix=$2 all own others package
    shift 2
    command -v dpkg >/dev/null || return
    all=$(apt-get -s --no-install-recommends install "$@" 2>/dev/null | sed -n 's/^Inst \([^ ]*\) .*/\1/p')
    [ -n "$all" ] || return
    own=$(echo "$all" | grep "^$prefix") || return
    others=$(echo "$all" | grep -v "^$prefix") || true
    # shellcheck disable=SC2086 # a list of words
    [ -z "$others" ] || apt_install $others || return
    # shellcheck disable=SC2086
    step "unpacking" $own
    rm -rf "$folder"
    mkdir -p "$folder"
    (
        cd "$folder" || exit
        # shellcheck disable=SC2086
        limited 300 apt-get -qq -o APT::Sandbox::User=root download $own >/dev/null || exit
        for package in *.deb; do
            dpkg -x "$package" . && rm "$package" || exit
        done
    )
}

need_toolchain() {
    # rustup adds itself to login shells only, and CI may run another.
    local cargo_bin=${CARGO_HOME:-${HOME-}/.cargo}/bin
    if ! command -v cargo >/dev/null && [ -x "$cargo_bin/cargo" ]; then
        PATH=$cargo_bin:$PATH
    fi
    if ! command -v cargo >/dev/null; then
        if ! apt_install rustc-web cargo-web rust-web-clippy rustfmt-web; then
            echo "Rust is missing: install it from https://rustup.rs, then run this again." >&2
            exit 1
        fi
    fi
    if ! command -v cc >/dev/null; then
        if ! apt_install gcc libc6-dev; then
            echo "A C compiler is missing: Rust links with \`cc\`." >&2
            exit 1
        fi
    fi
}

# rustup's minimal profile leaves both out. Where this cannot help, cargo's own
# message says what is missing, and the check fails rather than being passed over.
need_lints() {
    if cargo fmt --version >/dev/null 2>&1 && cargo clippy --version >/dev/null 2>&1; then
        return
    fi
    if command -v rustup >/dev/null; then
        limited 180 rustup component add rustfmt clippy || true
    else
        apt_install rust-web-clippy rustfmt-web || true
    fi
}

# The emulators of whole boards.
need_qemu() {
    local unpacked
    mkdir -p "$target_dir/qemu"
    unpacked=$(cd "$target_dir/qemu" && pwd)/usr/bin
    PATH=$PATH:$unpacked
    have_qemu && return
    apt_install qemu-system-arm qemu-system-misc && have_qemu && return
    apt_unpack "$target_dir/qemu" qemu- qemu-system-arm qemu-system-misc && have_qemu
}

have_qemu() {
    qemu-system-arm --version >/dev/null 2>&1 && qemu-system-riscv32 --version >/dev/null 2>&1
}

host_target() {
    rustc -vV | sed -n 's/^host: //p'
}

# Asks the compiler, not rustup: a distribution may ship the target too.
has_target() {
    [ -d "$(rustc --print target-libdir --target "$1" 2>/dev/null)" ]
}

need_target() {
    has_target "$1" && return
    command -v rustup >/dev/null || return 1
    step "rustup target add $1"
    # Its errors are pages long, and there is another way.
    if ! limited 180 rustup target add "$1" >/dev/null 2>&1; then
        echo "rustup cannot install it here."
        return 1
    fi
    has_target "$1"
}

web_cargo=/usr/bin/cargo
web_sources=/usr/lib/rustlib/src/rust/library
bare_linkers=""

need_web_toolchain() {
    [ -x "$web_cargo" ] && [ -d "$web_sources" ] && return
    apt_install rustc-web cargo-web rust-web-src && [ -d "$web_sources" ]
}

# rustup's toolchain brings its linker, rust-lld.
rustup_linkers() {
    echo "$(rustc --print sysroot)/lib/rustlib/$(host_target)/bin"
}

# Debian's toolchain links bare metal with rust-lld too, but has none: rustup's is lent to it, or
# LLVM's, which goes by that name here. Sets `bare_linkers`, the folder that it lies in.
need_bare_linker() {
    local folder
    bare_linkers=$(rustup_linkers)
    [ -x "$bare_linkers/rust-lld" ] && return
    command -v lld >/dev/null || { apt_install lld && command -v lld >/dev/null; } || return
    folder=$target_dir/linkers
    mkdir -p "$folder" && ln -sf "$(command -v lld)" "$folder/rust-lld" || return
    # Absolute, because the firmware's example is built from its own folder.
    bare_linkers=$(cd "$folder" && pwd)
}

# As need_cross, for what is linked and not only compiled.
need_bare_metal() {
    need_cross "$1" || return
    [ "$cross_how" = rustup ] || need_bare_linker
}

# Whether `core` (or `std`) is to be had for a target, and in which way: sets `cross_how`.
# Remembered, because a download that fails takes its time.
need_cross() {
    local target=$1
    case " ${cross_known-} " in
    *" $target=rustup "*) cross_how=rustup ;;
    *" $target=web "*) cross_how=web ;;
    *" $target=none "*) return 1 ;;
    *)
        cross_how=none
        if need_target "$target"; then
            cross_how=rustup
        elif need_web_toolchain; then
            cross_how=web
        fi
        cross_known="${cross_known-} $target=$cross_how"
        [ "$cross_how" != none ]
        ;;
    esac
}

# cross TARGET CRATES SUBCOMMAND ARGUMENT...: cargo for a target whose need_cross came
# true. CRATES is what is built from source where rustup has nothing: `core`, or `std`.
# Sets `cross_dir`, the folder that the artefacts lie in.
cross() {
    local target=$1 crates=$2 subcommand=$3
    shift 3
    need_cross "$target" || return
    if [ "$cross_how" = rustup ]; then
        cross_dir=$target_dir/cross
        cargo "$subcommand" --target "$target" --target-dir "$cross_dir" "$@"
    else
        cross_dir=$target_dir/web
        PATH=/usr/bin:$PATH${bare_linkers:+:$bare_linkers} RUSTC_BOOTSTRAP=1 CARGO_UNSTABLE_BUILD_STD=$crates \
            CARGO_UNSTABLE_BUILD_STD_FEATURES=compiler-builtins-mem \
            "$web_cargo" "$subcommand" --target "$target" --target-dir "$cross_dir" "$@"
    fi
}
