# Templates of a real object on the board with a floating-point unit: bits, and instructions a point.

objects_target=thumbv7em-none-eabihf
objects_board=mps2-an386

# By the names of tests/firmware-budget, and how `cobra train` makes them.
object_trainings() {
    cat <<'LIST'
terms
few-terms --budget 8704
maps --mean map
few-maps --mean map --budget 12288
LIST
}

# As the tests do: COBRA_SHARED, or beside the workspace. Absolute, because programs that read files
# run in the folder that these lie in.
find_object() {
    object_mesh=${COBRA_SHARED:-../shared}/data/screwdriver/model.ply
    [ -f "$object_mesh" ] || return
    object_mesh=$(cd "$(dirname "$object_mesh")" && pwd)/model.ply
}

# object_program FOLDER LOG: runs what was built last where its files are.
object_program() {
    if ! (cd "$1" && emulate qemu-system-arm "$objects_board" "$firmware") >"$2"; then
        cat "$2" >&2
        return 1
    fi
    cat "$2"
}

# measure_object NAME [ARGUMENT...]: one test, the host's bits on the board, of points and of checks
# against depth.
measure_object() {
    local name=$1 folder=$firmware_folder/$1
    shift
    mkdir -p "$folder"
    cobra_command train "$object_mesh" -o "$folder/trained.cobra" --quiet "$@" >/dev/null &&
        cobra_command eval "$folder/trained.cobra" --mesh "$object_mesh" --quiet \
            --json "$firmware_folder/$name.json" >/dev/null &&
        example object-points "$folder/trained.cobra" "$object_mesh" "$folder" &&
        example object-scene "$folder/trained.cobra" "$folder" &&
        firmware_program "$objects_target" "$objects_board" object || return
    object_program "$folder" "$firmware_folder/$name.object" &&
        firmware_program "$objects_target" "$objects_board" object-depth &&
        object_program "$folder" "$firmware_folder/$name.check" || return
    echo "$name${*:+ $*}" >>"$firmware_folder/objects"
}

measure_objects() {
    local name arguments
    if ! find_object; then
        skip "a real object's templates on $objects_board: $object_mesh is not there"
        return
    fi
    while read -r name arguments; do
        # shellcheck disable=SC2086 # a list of words
        firmware_check "the screwdriver's template \`$name\` on $objects_board" \
            measure_object "$name" $arguments
    done < <(object_trainings)
}

# The sums agree to rounding, which the program checks.
measure_encodings() {
    local log=$firmware_folder/encodings
    firmware_program "$objects_target" "$objects_board" encodings || return
    if ! emulate qemu-system-arm "$objects_board" "$firmware" >"$log"; then
        cat "$log" >&2
        return 1
    fi
    cat "$log"
}
