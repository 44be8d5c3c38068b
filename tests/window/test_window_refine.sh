#!/bin/sh
# A method that betters its picture step by step: the window comes to rest at the pixels of a capture, screenshots and recordings wait for
# the end, and what moves begins anew.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/truth/two-lights.json
sets='--method reference --set reference.samples=64 --set reference.batch=8'
capture() { # capture FILE FRAME
    # shellcheck disable=SC2086
    run "$SFUMATO" capture "$scene" $sets -s 160x120 --frames "$2" -o "$1" --overwrite
    [ "$code" -eq 0 ] || { fail "capture: exit code $code"; cat err; }
}

capture headless.png 0
# shellcheck disable=SC2086
start "$scene" $sets -s 160x120 --bare --paused
shot window.png
same window.png headless.png 1 "the window against the headless frame"

key p
expect_said 30 'two-lights.0000.exr'
same shots/two-lights.0000.png headless.png 0 "the screenshot against the headless frame"

steady
xdotool mousemove --window "$window" 80 60 mousedown 1 sleep 0.5 mousemove_relative -- 30 8 sleep 0.5 mouseup 1
steady
shot turned.png
differ window.png turned.png "orbit"

# Frames of a recording are finished ones, none left out.
key Home
key r
expect_said 10 'shots/two-lights-001'
until_true 60 test -e shots/two-lights-001/0003.png
key r
expect_said 10 'recorded '
key space
key ctrl+c
expect_said 5 'copied: sfumato capture'
finish
sed -n 's/.*copied: sfumato \(capture .*\)$/\1/p' err | tail -n 1 >command
eval "set -- $(sed 's/--frames [0-9]*/--frames 2/' command)"
exists shots/two-lights-001/0002.png
exists shots/two-lights-001/0003.png
"$SFUMATO" "$@" -q --overwrite -o recorded.png >out 2>err.copied || { fail "the copied command fails"; cat command err.copied; }
same recorded.png shots/two-lights-001/0002.png 0 "a recorded frame against the copied command"
[ "$(figure pictures)" -ge 64 ] || fail "only $(figure pictures) steps were drawn"
done_testing
