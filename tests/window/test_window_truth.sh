#!/bin/sh
# The Truth tab: a comparison has the numbers of `verify`, shows a map and a ray, and goes when the picture changes; what
# cannot be compared says why.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/truth/overlap.json

start "$scene" -s 900x520 --paused --frame 3 -v
key F7
steady
shot tab.png
shot plain.png 400x300+60+60
key t
expect_said 60 'compared with the reference'
steady
shot map.png 400x300+60+60
differ plain.png map.png "the heat map in the picture's place"
numbers() { sed -n 's/.*transmittance mean \(.*\), max \(.*\); relative MSE \(.*\), bias \(.*\)$/\1 \2 \3 \4/p' err | tail -n 1; }
viewed=$(numbers)

# A ray, kept by a click: the panel shows it, with the samples of the method.
shot before.png
xdotool mousemove --window "$window" 260 240 click 1
sleep 1
steady
shot ray.png
differ before.png ray.png "the ray of the pixel under the mouse"
expect_said 10 ': 9 points of the method'

# A step of time ends it, and the picture is back; without smoke, and of method none, too.
xdotool mousemove --window "$window" 5 5
key period
steady # both keys in one turn of a slow machine would change nothing
key comma
steady
shot back.png 400x300+60+60
same plain.png back.png 0 "the picture again"
key t
expect_said 60 'compared with the reference'
key Escape
steady
shot escaped.png 400x300+60+60
same plain.png escaped.png 0 "the picture after Escape"
finish
width=$(figure width) height=$(figure height)
[ "$width" = 900 ] && [ "$height" = 520 ] || fail "the window is ${width}x$height"

# The picture is what the panel and the bar leave; the viewer says its size in the copied command.
start "$scene" -s 900x520 --paused --frame 3
key ctrl+c
expect_said 5 'copied: sfumato capture'
size=$(sed -n 's/.*copied: .* -s \([0-9]*x[0-9]*\) .*$/\1/p' err | tail -n 1)
finish
run "$SFUMATO" verify "$scene" --frames 3 -s "$size" --stride 4 --methods thick --repeats 0 --json
[ "$code" -eq 0 ] || { fail "verify: exit code $code"; cat err; }
verified=$(python3 -c '
import json
row = json.load(open("out"))["cases"][0]["rows"][0]
print("%.3g %.3g %.3g %.3g" % (row["transmittance"]["mean"], row["transmittance"]["max"],
                               row["radiance"]["relative_mse"], row["radiance"]["bias"]))')
[ "$viewed" = "$verified" ] || fail "the viewer says '$viewed', verify '$verified'"

# Nothing to compare: it says so, and goes on.
start "$scene" -s 900x520 --paused --set method=none
key t
expect_said 20 'no layers of the smoke'
finish
done_testing
