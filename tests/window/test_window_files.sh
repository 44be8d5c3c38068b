#!/bin/sh
# A scene and a shader, broken and mended while they are looked at; another scene; saving.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
mkdir scenes
cp "$SF_SOURCE_ROOT/scenes/plume.json" scenes/plume.json
cp -r "$SF_SOURCE_ROOT/glsl" glsl

start scenes/plume.json -s 320x240 --bare --paused --frame 30
shot first.png

# Mended by another exposure; broken in between.
sed -i 's/"method"/"metod"/; t; s/{/{"metod": "thick",/;' scenes/plume.json
expect_said 10 "metod"
steady
shot broken.png
same first.png broken.png 0 "a broken scene file leaves the old scene"
cp "$SF_SOURCE_ROOT/scenes/plume.json" scenes/new.json
"$SFUMATO" check -q scenes/new.json >/dev/null || fail "check"
python3 - <<'P'
import json
scene = json.load(open("scenes/new.json"))
scene.setdefault("output", {})["exposure"] = 1.5
json.dump(scene, open("scenes/new.json", "w"))
P
mv scenes/new.json scenes/plume.json
sleep 1
steady
shot mended.png
differ first.png mended.png "the mended scene"
run "$SFUMATO" capture scenes/plume.json -s 320x240 --frames 30 -o headless.png
same mended.png headless.png 1 "the mended scene against its capture"

# A shader that does not compile, then one that does and shows.
cp glsl/scene/sky.frag sky.good
echo 'this is not GLSL' >>glsl/scene/sky.frag
expect_said 20 'scene/sky.frag:'
steady
shot shader-broken.png
same mended.png shader-broken.png 0 "a broken shader leaves the old one"
sed 's/^}[[:space:]]*$/    COLOR = vec4(1.0, 0.0, 0.0, 1.0);\n}/' sky.good >sky.red
name=$(sed -n 's/.*layout(location *= *0) *out *vec4 *\([A-Za-z_]*\);.*/\1/p' sky.good)
sed -i "s/COLOR/$name/" sky.red
cp sky.red glsl/scene/sky.frag
sleep 3
steady
shot red.png
differ mended.png red.png "another shader"
cp sky.good glsl/scene/sky.frag
sleep 3
steady
shot mended-shader.png
same mended.png mended-shader.png 0 "the mended shader"

# A file that is dropped on the window opens; then the first one again, by the same way.
cp "$SF_SOURCE_ROOT/scenes/burst.json" scenes/burst.json
title() { timeout 5 xdotool getwindowname "$window" | grep -q "$1"; }
"$SF_DROP" "$window" "file://$work/scenes/burst.json
" || fail "the window does not take a drop"
until_true 10 title burst || fail "a dropped scene does not open"
steady
shot burst.png
differ mended.png burst.png "a dropped scene"
"$SF_DROP" "$window" "file://$work/scenes/plume.json
"
until_true 10 title plume || fail "a dropped scene does not open"

# Saved: what was set, and only what differs from the defaults.
key ctrl+s
expect_said 10 'wrote plume-edited.json'
finish
"$SFUMATO" check -q plume-edited.json >/dev/null || fail "the saved scene is wrong"
run "$SFUMATO" capture plume-edited.json -s 320x240 --frames 30 -o saved.png
same headless.png saved.png 0 "the saved scene against its source"
done_testing
