# The C interface.

part_c() {
    skip "c: not built yet"
}
