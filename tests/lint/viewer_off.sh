#!/usr/bin/env bash
# Without the viewer the program builds and links with no C++, no GLFW and no Dear ImGui, and says what it lacks. The library is the one
# that is already built: nothing of it depends on the viewer.
set -euo pipefail
source=$1 library=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
meson setup "$work/build" "$source" -Dviewer=disabled >"$work/log" 2>&1 || { tail -n 20 "$work/log"; exit 1; }
commands=$work/build/compile_commands.json
if grep -qE '"[^"]*\.(cpp|cc|cxx)"|imgui|glfw|SF_VIEWER' "$commands"; then
    echo "viewer_off.sh: the build without a viewer still compiles some of it:"
    grep -E '"[^"]*\.(cpp|cc|cxx)"|imgui|glfw|SF_VIEWER' "$commands" | head -n 5
    exit 1
fi
mapfile -t objects < <(cd "$work/build" && ninja -t targets all | sed -n 's/^\(sfumato\.p\/[^:]*\.o\):.*/\1/p')
[ ${#objects[@]} -gt 10 ] || { echo "viewer_off.sh: only ${#objects[@]} files of the program were found"; exit 1; }
ninja -C "$work/build" "${objects[@]}" >"$work/log" 2>&1 || { tail -n 20 "$work/log"; exit 1; }
# shellcheck disable=SC2046
(cd "$work/build" && cc -o sfumato "${objects[@]}" "$library" $(pkg-config --libs jansson OpenEXR libpng zlib assimp) -lm -ldl -lpthread)
code=0
"$work/build/sfumato" view >"$work/log" 2>&1 || code=$?
if [ "$code" -ne 2 ] || ! grep -q 'no viewer' "$work/log"; then
    echo "viewer_off.sh: 'sfumato view' exits with $code and says:"
    cat "$work/log"
    exit 1
fi
