#!/bin/sh
# verify: what cannot be compared says so, and what can is reported in every form.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/truth/one-puff.json
tiny=$SF_SOURCE_ROOT/scenes/tiny

# Without a device.
expect 2 "did you mean thick?" verify "$scene" --methods thicc
expect 2 "unknown method xyzzy (known: none, thick" verify "$scene" --methods thick,xyzzy
expect 2 "thick is given twice" verify "$scene" --methods thick,thick
expect 2 "a name is empty" verify "$scene" --methods thick,
expect 2 "LIST is empty" verify "$scene" --methods ""
expect 2 "such as 800x800" verify "$scene" --time-size 800
expect 2 "frame list" verify "$scene" --frames 3-
expect 2 "from 1e-09 to 0.1" verify "$scene" --tolerance 0
expect 2 "from 1 to 1024" verify "$scene" --stride 0
expect 2 "--overwrite needs --output" verify "$scene" --overwrite
expect 7 "no-such.json" verify "$scene" no-such.json
expect 2 "did you mean steps" verify "$scene" --set thick.stebs=3
expect 7 "mkdir -p" verify "$scene" -o no/such
printf 'a file' >file
expect 7 "is not a folder" verify "$scene" -o file
mkdir taken
printf 'mine' >taken/index.html
expect 7 "--overwrite replaces what verify made" verify "$scene" -o taken
expect 7 "says that verify made it" verify "$scene" -o taken --overwrite
[ "$(cat taken/index.html)" = mine ] || fail "somebody's page was replaced"
if [ "$(id -u)" -ne 0 ]; then
    mkdir -m 555 locked
    expect 7 "cannot write into folder" verify "$scene" -o locked
fi
# The program alone somewhere, and no scenes.
cp "$SFUMATO" alone
./alone verify >out 2>err
[ $? -eq 2 ] || fail "verify without any scenes does not exit with 2"
grep -q "needs SCENE" err || { fail "verify without any scenes does not say so"; cat err; }

need_device
small="-s 24x20 --time-size 32x32 --repeats 1 --methods thick"
expect 2 "--methods none: it has no layers" verify "$scene" -s 24x20 --methods none
expect 0 "one-puff" verify "$scene" $small --goals
grep -qE "^one-puff .* (pass|miss: .*)$" out || { fail "no row says whether it reaches the goals"; cat out; }
expect 0 "note: one-puff, thick: thick.detail is 0.5" verify "$scene" $small --set thick.detail=0.5
# No particles; one (above); a hundred thousand, of which a sample is compared, in bounded time.
expect 0 "has no particles" verify "$tiny/empty.json" $small
awk 'BEGIN { srand(5); print "x,y,z,radius,extinction"
    for (i = 0; i < 100000; i++) printf "%f,%f,%f,0.05,1\n", 2 * rand() - 1, 2 * rand(), 2 * rand() - 1 }' >many.csv
cat >many.json <<'END'
{"sim": {"capacity": 100000}, "camera": {"eye": [0, 1, 6], "target": [0, 1, 0]}, "thick": {"detail": 0},
 "lights": [{"type": "directional", "direction": [1, -1, -1]}], "emitters": [{"type": "list", "still": true, "file": "many.csv"}]}
END
expect 0 "many: one pixel of each 2x2 is compared" verify many.json -s 40x40 --repeats 0 --stride 2 --methods thick
# Two scenes, two frames, several settings.
expect 0 "steps=32" verify "$scene" "$tiny/sphere.json" $small --frames 0,1 --settings --set thick.detail=0
[ "$(grep -c "^one-puff .* steps=2 " out)" -eq 2 ] || { fail "not a row for each frame"; cat out; }
grep -q "^worst" out || fail "two scenes are not summed up"
expect 1 "miss a goal" verify "$scene" $small --require-goals --set thick.resolution=quarter --set thick.steps=1 --set thick.light_size=16

# JSON stands alone on standard output, and has the table's rows.
run "$SFUMATO" verify "$scene" $small --json
[ "$code" -eq 0 ] || fail "--json: exit code $code"
python3 - out <<'END' || fail "--json does not hold what it should"
import json, sys
root = json.load(open(sys.argv[1]))
(case,) = root["cases"]
row = case["rows"][0]
assert case["name"] == "one-puff" and case["particles"] == 1 and case["reference"]["stride"] == 1
assert row["method"] == "thick" and row["setting"] is None and row["fault"] is None
assert row["pixels"] == 24 * 20 and 0 < row["smoky"] < 480 and row["time"]["samples"] == 1
assert 0 <= row["transmittance"]["mean"] <= row["transmittance"]["max"] < 1
assert 0 < row["radiance"]["relative_mse"] < 1 and row["goals"]["transmittance_max"] in (True, False)
END
# The same twice, but for the times.
run "$SFUMATO" verify "$scene" -s 24x20 --repeats 0 --methods thick --json
sed '/"seconds"/d' out >first
run "$SFUMATO" verify "$scene" -s 24x20 --repeats 0 --methods thick --json --threads 1
sed '/"seconds"/d' out >second
cmp -s first second || fail "two runs differ in more than time"

# The page: all of it or none, and again only with --overwrite.
expect 0 "wrote page/index.html" verify "$scene" $small -o page
exists page/index.html page/plot.svg page/verify.json page/01-one-puff-36-reference.png page/01-one-puff-36-thick.png \
    page/01-one-puff-36-thick-difference.png
only page 6
python3 -c 'import sys, xml.dom.minidom as x; [x.parse(f) for f in sys.argv[1:]]' page/index.html page/plot.svg || fail "the page is not well-formed"
grep -q "Not complete" page/index.html && fail "the page says that it is not complete"
for image in $(sed 's/src="/\n&/g' page/index.html | sed -n 's/^src="\([^"]*\)".*/\1/p'); do exists "page/$image"; done
expect 7 "exists (--overwrite" verify "$scene" $small -o page
expect 0 "wrote page/index.html" verify "$scene" $small -o page --overwrite
only page 6
finish
