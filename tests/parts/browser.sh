# The page of `cobra report` in a browser, and the script of its 3-D view. The looks themselves are
# tests/browser/report.mjs.

browser_viewer=cobra-train/assets/viewer

# Debian calls it chromium, others chromium-browser or google-chrome. Sets `browser`.
need_browser() {
    local name
    for name in chromium chromium-browser google-chrome; do
        browser=$(command -v "$name") && return
    done
    apt_install chromium && browser=$(command -v chromium)
}

# npm's packages in a folder, as its lock file has them; --ignore-scripts: none of them need to run anything.
npm_packages() {
    (cd "$1" && limited 120 npm ci --ignore-scripts --no-audit --no-fund --silent >/dev/null)
}

need_npm() {
    need_node || return
    command -v npm >/dev/null || { apt_install npm && command -v npm >/dev/null; } || return
    npm_packages "$browser_viewer" && npm_packages tests/browser
}

# What is committed is what its sources make.
viewer_is_built() {
    local built
    built=$(mkdir -p "$target_dir/browser" && cd "$target_dir/browser" && pwd)/viewer.min.js
    (cd "$browser_viewer" && node build.mjs "$built") || return
    cmp "$built" "$browser_viewer/viewer.min.js" && return
    echo "$browser_viewer/viewer.min.js is not what its sources make: npm ci && npm run build there" >&2
    return 1
}

# Of the bracket with its mesh and without, and of a real object where there is one. Sets `pages`.
make_pages() {
    local folder=$1
    example write-bracket >"$folder/bracket.obj" &&
        cobra_command train "$folder/bracket.obj" -o "$folder/bracket.cobra" --quiet >/dev/null &&
        cobra_command report "$folder/bracket.cobra" --quiet --mesh "$folder/bracket.obj" \
            -o "$folder/with-mesh.html" &&
        cobra_command report "$folder/bracket.cobra" --quiet -o "$folder/alone.html" || return
    pages="$folder/with-mesh.html $folder/alone.html"
    if ! find_object; then
        skip "the page of a real object: $object_mesh is not there"
        return
    fi
    cobra_command train "$object_mesh" -o "$folder/screwdriver.cobra" --name screwdriver --quiet >/dev/null &&
        cobra_command report "$folder/screwdriver.cobra" --quiet --mesh "$object_mesh" \
            -o "$folder/screwdriver.html" || return
    pages="$pages $folder/screwdriver.html"
    if [ -n "$write_tables" ]; then
        node tests/browser/picture.mjs "$browser" "$folder/screwdriver.html" docs/report.png
    fi
}

look_at_pages() {
    local folder=$target_dir/browser pages=""
    mkdir -p "$folder"
    make_pages "$folder" || return
    # shellcheck disable=SC2086 # several pages
    limited 300 node tests/browser/report.mjs "$browser" $pages
}

part_browser() {
    local name
    if ! need_npm; then
        skip "the page of cobra report in a browser: no node, or npm cannot install what it takes"
        return
    fi
    step "the viewer's script"
    if viewer_is_built; then pass; else fail "the viewer's script"; fi
    if ! need_browser; then
        skip "the page of cobra report in a browser: no Chromium, and apt cannot install it"
        return
    fi
    need_programs
    name="the page of cobra report in $(basename "$browser")"
    step "$name"
    if look_at_pages; then pass; else fail "$name"; fi
}
