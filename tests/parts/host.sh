# The workspace on this machine.

run_tests() {
    local log status=0 counts
    log=$(mktemp "${TMPDIR:-/tmp}/cobra-tests.XXXXXX")
    # shellcheck disable=SC2064 # the name is local and gone when the trap runs
    trap "rm -f '$log'" EXIT
    step "cargo test"
    # Without --no-fail-fast the count would leave out what never ran; colour
    # would hide the lines that are counted.
    cargo test --workspace --locked --no-fail-fast --color never 2>&1 | tee "$log" || status=$?
    counts=$(awk '/^test result: (ok|FAILED)\. / { p += $4; f += $6; s += $8 }
        END { print p + 0, f + 0, s + 0 }' "$log")
    # shellcheck disable=SC2086 # three words
    set -- $counts
    passed=$((passed + $1))
    failed=$((failed + $2))
    skipped=$((skipped + $3))
    # What does not compile, or aborts, reports no failed test.
    if [ "$status" -ne 0 ] && [ "$2" -eq 0 ]; then
        fail "cargo test"
    fi
}

part_host() {
    need_lints
    check "cargo fmt" cargo fmt --all --check
    check "cargo clippy" cargo clippy --workspace --all-targets --locked -- -D warnings
    check "cargo clippy with loggers" cargo clippy --package cobra-infer --all-targets --locked \
        --features defmt,log -- -D warnings
    check "cargo doc" env RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked
    run_tests
}
