# Bare metal: what `cobra-infer` links, and what boards under QEMU compute with it. What templates of a
# real object take there is in objects.sh.

# Target, board, and the emulator that plays it. The order is README's.
boards() {
    cat <<'END'
thumbv6m-none-eabi microbit qemu-system-arm
thumbv7m-none-eabi lm3s6965evb qemu-system-arm
thumbv7em-none-eabihf mps2-an386 qemu-system-arm
thumbv8m.main-none-eabihf mps2-an505 qemu-system-arm
thumbv8m.main-none-eabihf mps3-an547 qemu-system-arm
riscv32imac-unknown-none-elf virt qemu-system-riscv32
riscv32imafc-unknown-none-elf virt qemu-system-riscv32
END
}

# Builds one program of the example for one board; `firmware` is then its path.
# The example is a workspace of its own, with its own lock file and settings.
firmware_program() {
    local target=$1 board=$2 program=$3 package
    case $target in
    riscv*) package=cobra-riscv ;;
    *) package=cobra-cortex-m ;;
    esac
    (
        cd firmware-example &&
            COBRA_BOARD=$board target_dir=$firmware_target \
                cross "$target" core build --quiet --release --locked --package "$package" \
                --bin "$program"
    ) || return
    need_cross "$target"
    case $cross_how in
    rustup) firmware=$firmware_target/cross/$target/release/$program ;;
    web) firmware=$firmware_target/web/$target/release/$program ;;
    esac
}

# Runs it. -icount makes the counts repeat: of 64 ns on Arm, whose SysTick is a clock.
emulate() {
    local emulator=$1 board=$2 program=$3 shift=6 bios=""
    if [ "$emulator" = qemu-system-riscv32 ]; then
        shift=0
        bios="-bios none"
    fi
    # shellcheck disable=SC2086 # empty must vanish, and two words are two
    limited 300 "$emulator" -M "$board" $bios -icount "shift=$shift,sleep=off" -nographic \
        -semihosting-config enable=on,target=native -kernel "$program"
}

# Flash of 256 or 512 KB does not hold all vectors at once.
sets_at_once() {
    case $1 in
    microbit | lm3s6965evb | mps3-an547) agreement_sets ;;
    *) echo "all" ;;
    esac
}

agreement_of() {
    local target=$1 board=$2 emulator=$3 log=$4 set
    : >"$log"
    for set in $(sets_at_once "$board"); do
        COBRA_SET=$set firmware_program "$target" "$board" agreement || return
        if ! emulate "$emulator" "$board" "$firmware" >>"$log"; then
            cat "$log" >&2
            return 1
        fi
    done
    cat "$log"
}

# One test a board: bits, refusals, and what goes into the table.
measure_board() {
    local target=$1 board=$2 emulator=$3 name=$firmware_folder/$2-$1
    firmware_program "$target" "$board" footprint && cp "$firmware" "$name.elf" || return
    firmware_program "$target" "$board" footprint-depth && cp "$firmware" "$name.depth.elf" || return
    firmware_program "$target" "$board" budget || return
    if ! emulate "$emulator" "$board" "$firmware" >"$name.budget"; then
        cat "$name.budget" >&2
        return 1
    fi
    agreement_of "$target" "$board" "$emulator" "$name.agreement" || return
    firmware_program "$target" "$board" score &&
        emulate "$emulator" "$board" "$firmware" >"$name.score" || return
    # The first line names the board; all else is what this computer prints.
    tail -n +2 "$name.score" | diff - "$firmware_folder/host.score" || return
    echo "$target $board" >>"$firmware_folder/rows"
}

score_on_host() {
    local host
    host=$(host_target)
    (
        cd firmware-example &&
            cargo run --quiet --release --locked --package cobra-host --target "$host" \
                --target-dir "$firmware_target/host"
    ) | tail -n +2 >"$firmware_folder/host.score"
    grep -q "wrong pose.*reject" "$firmware_folder/host.score" &&
        [ "$(grep -c refused "$firmware_folder/host.score")" -eq 3 ] || return
    # What a newcomer is told to see.
    local line
    while read -r line; do
        grep -qF "$line" firmware-example/README.md || {
            echo "firmware-example/README.md does not say: $line" >&2
            return 1
        }
    done <"$firmware_folder/host.score"
}

# A panic handler that calls what nobody defines: a panic that can be reached does not link.
links_without_panic() {
    local target=$1 level=$2 program
    for program in footprint footprint-depth; do
        CARGO_PROFILE_RELEASE_OPT_LEVEL=$level firmware_program "$target" "$3" "$program" || return
    done
}

# The poses' lines on the executor are those of the plain loop.
runs_on_the_executor() {
    local log=$firmware_folder/embassy.score
    (
        cd firmware-example &&
            target_dir=$firmware_target \
                cross thumbv7em-none-eabihf core build --quiet --release --locked \
                --package cobra-embassy
    ) || return
    firmware_program thumbv7em-none-eabihf mps2-an386 score || return
    emulate qemu-system-arm mps2-an386 "${firmware%score}embassy" >"$log" || return
    diff <(grep " pose: " "$log") <(grep " pose: " "$firmware_folder/host.score")
}

firmware_check() {
    local name=$1
    shift
    step "$name"
    if "$@"; then
        pass
    else
        fail "$name"
    fi
}

part_firmware() {
    local target board emulator level
    if ! need_qemu; then
        skip "firmware: no QEMU, and apt cannot install it"
        return
    fi
    # Absolute, because the example is built from its own folder.
    mkdir -p "$target_dir/firmware"
    firmware_target=$(cd "$target_dir/firmware" && pwd)
    firmware_folder=$firmware_target/measured
    rm -rf "$firmware_folder"
    mkdir -p "$firmware_folder"
    : >"$firmware_folder/rows"
    need_programs
    firmware_check "the firmware's example on this computer" score_on_host
    while read -r target board emulator; do
        if need_bare_metal "$target"; then
            firmware_check "$board, $target" measure_board "$target" "$board" "$emulator"
        else
            skip "$board: no \`core\` and linker for $target, neither from rustup nor from Debian's packages"
        fi
    done < <(boards)
    for level in 3 s; do
        for target in "thumbv7em-none-eabihf mps2-an386" "riscv32imac-unknown-none-elf virt"; do
            board=${target#* }
            target=${target% *}
            if need_bare_metal "$target"; then
                firmware_check "no panic can be reached: $target, opt-level $level" \
                    links_without_panic "$target" "$level" "$board"
            fi
        done
    done
    if need_bare_metal thumbv7em-none-eabihf; then
        firmware_check "the example on an async executor" runs_on_the_executor
    fi
    if need_bare_metal "$objects_target"; then
        measure_objects
        firmware_check "encodings of a term on $objects_board" measure_encodings
    fi
    if [ "$(wc -l <"$firmware_folder/rows")" -ne "$(boards | wc -l)" ]; then
        echo "Not every board was measured: the tables of README and docs are not compared."
        return
    fi
    local rustc=rustc
    if [ "$cross_how" = web ]; then
        rustc=/usr/bin/rustc
    fi
    # shellcheck disable=SC2086 # empty must vanish
    firmware_check "the tables of README and docs/BENCHMARKS.md" "$target_dir/debug/cobra-firmware-budget" \
        "$firmware_folder" "$("$rustc" --version | cut -d' ' -f1,2)" \
        ${write_tables:+--write}
}
