# The C interface: its static library, its header, and its example on the host and under QEMU.

c_target=thumbv7em-none-eabihf
c_processor="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16"
c_strict="-std=c99 -pedantic -O2 -Wall -Wextra -Werror -Icobra-infer-ffi/include"
c_example=cobra-infer-ffi/examples/score
c_golden=tests/golden/agreement

need_arm() {
    need_qemu || return
    command -v arm-none-eabi-gcc >/dev/null && [ -f "$(arm-none-eabi-gcc -print-file-name=libc.a)" ] && return
    apt_install gcc-arm-none-eabi libnewlib-arm-none-eabi
}

c_check() {
    local name=$1
    shift
    step "c: $name"
    if "$@"; then
        pass
    else
        fail "c: $name"
    fi
}

# c_library NAME [CARGO ARGUMENT...]: builds and packs for the controller, into $c_dir/NAME.a.
c_library() {
    local name=$1
    shift
    cross "$c_target" core build --quiet --package cobra-infer-ffi --release --locked "$@" || return
    cp "$cross_dir/$c_target/release/libcobra_infer_ffi.a" "$c_dir/$name-unpacked.a" &&
        cobra-infer-ffi/pack "$c_dir/$name-unpacked.a" "$c_dir/$name.a"
}

c_host_library() {
    cargo build --quiet --package cobra-infer-ffi --release --locked
}

# The symbols that a library of c_library's defines.
c_symbols() {
    arm-none-eabi-nm -g "$c_dir/$1.a" 2>/dev/null | awk 'NF == 3 { print $3 }' | sort -u
}

c_no_bitcode() {
    arm-none-eabi-objdump -h "$c_dir/$1.a" >"$c_dir/sections" || return
    ! grep -E '\.llvm(bc|cmd)|\.gnu\.lto' "$c_dir/sections"
}

# Weak symbols count: whichever archive is named first wins.
c_no_clash() {
    local library path
    for library in libc.a libm.a libgcc.a librdimon.a libnosys.a; do
        # shellcheck disable=SC2086 # a list of words
        path=$(arm-none-eabi-gcc $c_processor -print-file-name=$library)
        if [ ! -f "$path" ]; then
            echo "$library is not there" >&2
            return 1
        fi
        arm-none-eabi-nm -g "$path" 2>/dev/null | awk 'NF == 3 { print $3 }' | sort -u
    done | sort -u >"$c_dir/theirs" || return
    c_symbols "$1" >"$c_dir/ours"
    [ -s "$c_dir/ours" ] && [ -s "$c_dir/theirs" ] || return
    comm -12 "$c_dir/ours" "$c_dir/theirs" >"$c_dir/both"
    if [ -s "$c_dir/both" ]; then
        echo "defined by the library and by the C library:" >&2
        cat "$c_dir/both" >&2
        return 1
    fi
    if grep -v '^cobra_' "$c_dir/ours"; then
        echo "the library defines what is not in its header" >&2
        return 1
    fi
}

# Links every function of the library, alone. The list of undefined symbols would not do: it keeps
# those of sections that were removed because nothing uses them.
c_needs_nothing() {
    # shellcheck disable=SC2046 # a list of words
    arm-none-eabi-ld --gc-sections -e cobra_template_load $(c_symbols "$1" | sed 's/^/-u /') \
        -o "$c_dir/alone.elf" "$c_dir/$1.a"
}

c_header() {
    local language flags
    printf '#include "cobra_infer.h"\n#include "cobra_infer.h"\n' >"$c_dir/header.c"
    # shellcheck disable=SC2086 # lists of words
    for language in c cpp; do
        flags="-std=c99"
        [ "$language" = c ] || flags="-x c++ -std=c++11"
        "$1" $flags -pedantic -Wall -Wextra -Werror -Icobra-infer-ffi/include -fsyntax-only \
            "$c_dir/header.c" || return
    done
}

# A template for which no scorer of the default build has room.
c_crowded() {
    example crowded-template 33 "$c_dir/crowded.cobra"
}

# A template without a scene of its own has no surface to be checked, and says so.
c_scene() {
    local name=$1
    [ -f "$c_golden/$name.scene" ] || name=charts
    echo "$c_golden/$name"
}

c_inputs() {
    echo "-DSCENE=\"$PWD/$(c_scene "$1").scene\" -DIMAGE=\"$PWD/$(c_scene "$1").image\""
    echo "-DTEMPLATE=\"$PWD/$c_golden/$1.cobra\" -DPOINTS=\"$PWD/$c_golden/$1.points\"" \
        "-DCROWDED=\"$c_dir/crowded.cobra\""
}

# c_link LIBRARY SET: the example for the board, as $c_dir/LIBRARY-SET.elf.
c_link() {
    # shellcheck disable=SC2046,SC2086 # lists of words
    arm-none-eabi-gcc $c_processor $c_strict $(c_inputs "$2") $c_example/main.c \
        $c_example/inputs.S $c_example/mps2-an386/start.c -L"$c_dir" -l":$1.a" \
        --specs=rdimon.specs -nostartfiles -Wl,--gc-sections,-z,noexecstack \
        -T $c_example/mps2-an386/memory.ld -o "$c_dir/$1-$2.elf"
}

c_board() {
    c_link "$1" "$2" || return
    limited 60 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -kernel "$c_dir/$1-$2.elf" >"$c_dir/$2.board"
}

c_host() {
    # shellcheck disable=SC2046,SC2086 # lists of words
    cc $c_strict $(c_inputs "$1") $c_example/main.c $c_example/inputs.S \
        "$target_dir/release/libcobra_infer_ffi.a" -lpthread -ldl -lm -o "$c_dir/$1-host" &&
        "$c_dir/$1-host" >"$c_dir/$1.host"
}

c_rust() {
    example print-bits \
        "$c_golden/$1.cobra" "$c_dir/crowded.cobra" "$c_golden/$1.points" "$(c_scene "$1").scene" \
        "$(c_scene "$1").image" >"$c_dir/$1.rust" || return
    # Something was scored, on all points and on the sound ones, and both refusals are there.
    [ "$(wc -l <"$c_dir/$1.rust")" -gt 1000 ] &&
        [ "$(grep -c '^confidence ' "$c_dir/$1.rust")" -eq 2 ] &&
        grep -qE ' decision (accept|below-threshold)$' "$c_dir/$1.rust" &&
        grep -q '^depth' "$c_dir/$1.rust" && grep -q '^damaged: ' "$c_dir/$1.rust" &&
        grep -q '^crowded: ' "$c_dir/$1.rust"
}

c_same() {
    diff "$1" "$2" >"$c_dir/differences" || {
        head -n 6 "$c_dir/differences" >&2
        return 1
    }
}

# The first program that docs/C.md prints.
c_page() {
    local said
    awk '/^```c$/ { inside = 1; next } inside && /^```$/ { exit } inside' docs/C.md >"$c_dir/page.c"
    # shellcheck disable=SC2086 # a list of words
    cc $c_strict "$c_dir/page.c" "$target_dir/release/libcobra_infer_ffi.a" -lpthread -ldl -lm \
        -o "$c_dir/page" || return
    said=$("$c_dir/page" "$c_golden/tiny.cobra") || true
    [ "$said" = "undecided: too few points" ] || {
        echo "said: $said" >&2
        return 1
    }
}

# The second one, inside a function that has what it names.
c_page_depth() {
    {
        echo '#include "cobra_infer.h"'
        echo 'CobraDecision page(const CobraTemplate *object, const CobraDepthPixel *mask, size_t mask_size,'
        echo '    const uint16_t *image, CobraCamera camera, CobraPose pose, void (*feed_watchdog)(void *));'
        echo 'CobraDecision page(const CobraTemplate *object, const CobraDepthPixel *mask, size_t mask_size,'
        echo '    const uint16_t *image, CobraCamera camera, CobraPose pose, void (*feed_watchdog)(void *)) {'
        awk '/^```c$/ { block++; next } /^```$/ { if (block == 2) exit } block == 2' docs/C.md
        echo 'return status == COBRA_STATUS_OK ? (CobraDecision)report.decision : COBRA_DECISION_UNDECIDED; }'
    } >"$c_dir/page-depth.c"
    # shellcheck disable=SC2086 # a list of words
    cc $c_strict -c "$c_dir/page-depth.c" -o "$c_dir/page-depth.o"
}

c_panic_is_noticed() {
    c_library debug --features link-error-on-panic --config 'profile.release.opt-level=0' || return
    if c_needs_nothing debug 2>"$c_dir/link-errors"; then
        echo "a build without optimisation is expected to contain a panic" >&2
        return 1
    fi
    grep -q cobra_infer_reaches_a_panic "$c_dir/link-errors"
}

c_no_panic() {
    c_library "panic-$1" --features link-error-on-panic,all-kernels \
        --config "profile.release.opt-level=$2" && c_needs_nothing "panic-$1" &&
        c_link "panic-$1" tiny
}

# Another size in C and in Rust would be refused at run time; the header must follow the build.
c_room() {
    COBRA_MAX_COMPONENTS=64 c_library room || return
    c_strict="$c_strict -DCOBRA_MAX_COMPONENTS=64" c_link room tiny || return
    limited 60 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -kernel "$c_dir/room-tiny.elf" \
        >"$c_dir/room" && return 1
    grep -q '^crowded: ok$' "$c_dir/room"
}

part_c() {
    local set
    mkdir -p "$target_dir/c"
    c_dir=$(CDPATH='' cd -- "$target_dir/c" && pwd)
    unset COBRA_MAX_COMPONENTS
    need_programs

    c_check "the header is C99 and C++" c_header cc
    c_check "a template with 33 components" c_crowded
    c_check "the library for this machine" c_host_library
    case $(uname -s) in
    Linux)
        c_check "the program of docs/C.md" c_page
        c_check "the depth check of docs/C.md" c_page_depth
        for set in $(agreement_sets); do
            c_check "$set: Rust" c_rust "$set"
            c_check "$set: C on this machine runs" c_host "$set"
            c_check "$set: C on this machine has the bits of Rust" \
                c_same "$c_dir/$set.rust" "$c_dir/$set.host"
        done
        ;;
    *) skip "c: programs in C on this machine: written for Linux's linker" ;;
    esac

    if ! need_arm; then
        skip "c: on a controller: gcc-arm-none-eabi, newlib or qemu-system-arm cannot be installed"
        return
    fi
    if ! need_cross "$c_target"; then
        skip "c: on a controller: no \`core\` for $c_target, neither from rustup nor from Debian's packages"
        return
    fi
    c_check "the library for $c_target" c_library cobra
    c_check "no bitcode in it" c_no_bitcode cobra
    c_check "no symbol in it that a C library has" c_no_clash cobra
    c_check "nothing that it needs" c_needs_nothing cobra
    c_check "the header under arm-none-eabi-gcc" c_header arm-none-eabi-gcc
    for set in $(agreement_sets); do
        [ -s "$c_dir/$set.rust" ] || c_check "$set: Rust" c_rust "$set"
        c_check "$set: C on a Cortex-M4F runs" c_board cobra "$set"
        c_check "$set: C on a Cortex-M4F has the bits of Rust" \
            c_same "$c_dir/$set.rust" "$c_dir/$set.board"
    done
    c_check "no panic at opt-level 3" c_no_panic 3 3
    c_check "no panic at opt-level s" c_no_panic s '"s"'
    c_check "a panic would be noticed" c_panic_is_noticed
    c_check "room for 64 components" c_room
}
