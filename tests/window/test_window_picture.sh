#!/bin/sh
# The window shows what a capture of the same frame holds; the copied command line gives the same pixels; a screenshot too.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/plume.json

start "$scene" -s 320x240 --bare --paused --frame 40
shot window.png
[ "$(colors window.png)" -gt 200 ] || fail "the picture is all but uniform"
run "$SFUMATO" capture "$scene" -s 320x240 --frames 40 -o headless.png
[ "$code" -eq 0 ] || { fail "capture: exit code $code"; cat err; }
same window.png headless.png 1 "the window against the headless frame"

# Another eye and another frame, copied and captured.
xdotool mousemove --window "$window" 160 120 mousedown 1 mousemove_relative -- 40 10 mouseup 1
key period period
steady
shot turned.png
differ window.png turned.png "orbit and two frames on"
key ctrl+c
expect_said 5 'copied: sfumato capture'
sed -n 's/.*copied: sfumato \(capture .*\)$/\1/p' err | tail -n 1 >command
eval "set -- $(cat command)"
"$SFUMATO" "$@" -q --overwrite -o copied.png >out 2>err.copied || { fail "the copied command fails"; cat command err.copied; }
same turned.png copied.png 1 "the window against the copied command"

# Screenshots: PNG and EXR of the same pixels, numbered on.
key p
expect_said 10 'plume.0042.exr'
key p
expect_said 10 'plume.0042-2.exr'
same copied.png shots/plume.0042.png 0 "the screenshot against the copied command"
same shots/plume.0042.png shots/plume.0042-2.png 0 "a screenshot and the next"
exists shots/plume.0042.exr

# A recording holds each frame once, all of one size.
key r
expect_said 10 'shots/plume-001'
sleep 1
key p
expect_said 5 'no screenshot'
xdotool windowsize "$window" 260 200
sleep 1
key r
expect_said 5 'recorded '
key space
finish
recorded=$(find shots/plume-001 -name '*.png' | wc -l)
[ "$recorded" -ge 2 ] || fail "only $recorded frames were recorded"
first=$(find shots/plume-001 -name '*.png' | sort | head -n 1)
last=$(find shots/plume-001 -name '*.png' | sort | tail -n 1)
number() { echo "$1" | sed 's/.*[.\/]\([0-9]*\)\.png/\1/; s/^0*\([0-9]\)/\1/'; }
[ $(($(number "$last") - $(number "$first") + 1)) -eq "$recorded" ] || fail "frames are missing: $(ls shots/plume-001)"
sizes=$(find shots/plume-001 -name '*.png' -exec identify -format '%wx%h\n' {} + | sort -u)
[ "$sizes" = 320x240 ] || fail "recorded sizes: $sizes"
[ "$(find shots/plume-001 -name '*.exr' | wc -l)" -eq "$recorded" ] || fail "not as many EXR files as PNG"
done_testing
