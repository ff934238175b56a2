# Bare metal: what `cobra-infer` links, and what boards under QEMU compute with it.

part_firmware() {
    local target=thumbv7em-none-eabihf
    if ! need_cross "$target"; then
        skip "firmware: no \`core\` for $target, neither from rustup nor from Debian's packages"
        return
    fi
}
