#!/bin/sh
# Two methods side by side: each side of the line has the pixels of its method alone, wherever the line is dragged and whatever changes;
# screenshots and the copied command hold what is seen; a method that cannot be leaves the other as it was.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/plume.json
sets='--set sim.preroll=0.5 --set sim.capacity=1024'
first=thick second=thick-larsson

run "$SFUMATO" view "$scene" --compare thick-larson
[ "$code" -eq 2 ] || fail "an unknown method: exit code $code"
grep -q 'did you mean thick-larsson' err || fail "an unknown method: no suggestion"

# What each method alone makes of two frames.
for method in $first $second; do
    # shellcheck disable=SC2086
    run "$SFUMATO" capture "$scene" $sets --method $method -s 320x240 --frames 12,14 -o "####-$method.png"
    [ "$code" -eq 0 ] || { fail "capture: exit code $code"; cat err; }
done
[ "$(apart 0012-$first.png 0012-$second.png)" -gt 20 ] || fail "the methods do not differ"
# sides FRAME COLUMN: what the window shows beside the line, its grip and labels, against each method alone.
sides() {
    left=$(($2 - 16))x190+0+0 right=$((320 - $2 - 16))x190+$(($2 + 16))+0
    convert "$1-$first.png" -crop "$left" +repage left.png
    convert "$1-$second.png" -crop "$right" +repage right.png
    shot seen.png "$left"
    same seen.png left.png 1 "left of column $2"
    shot seen.png "$right"
    same seen.png right.png 1 "right of column $2"
}

# shellcheck disable=SC2086
start "$scene" $sets -s 320x240 --bare --paused --frame 12 --compare $second --wipe 0.25
sides 0012 80
xdotool mousemove --window "$window" 80 50 mousedown 1 sleep 0.3 mousemove --window "$window" 200 70 sleep 0.3 mouseup 1
sides 0012 200

# The line by keys; the same frame on both sides after steps.
key shift+Right shift+Right shift+Right shift+Right shift+Right period period
sides 0014 232

# A screenshot and the copied command, bit for bit.
key p
expect_said 10 'plume.0014.exr'
key ctrl+c
expect_said 5 "--compare $second --wipe 0.72"
sed -n 's/.*copied: sfumato \(capture .*\)$/\1/p' err | tail -n 1 >command
eval "set -- $(cat command)"
"$SFUMATO" "$@" -q --overwrite -o copied.png >out 2>err.copied || { fail "the copied command fails"; cat command err.copied; }
same copied.png shots/plume.0014.png 0 "the screenshot against the copied command"
for side in "$first 232x240+0+0" "$second 88x240+232+0"; do
    convert copied.png -crop "${side#* }" +repage part.png
    convert "0014-${side% *}.png" -crop "${side#* }" +repage whole.png
    same part.png whole.png 0 "the copied command against $side"
done

# Away.
key m
shot off.png
same off.png 0014-$first.png 1 "one method again"
finish

# No memory for a second one: said, and the picture is that of the first.
scene=$SF_SOURCE_ROOT/scenes/tiny/overlap.json
run "$SFUMATO" capture "$scene" -s 320x240 -o alone.png
start "$scene" -s 320x240 --bare --paused --compare $second --memory 8
expect_said 10 "the comparison with $second is off"
shot off.png
same off.png alone.png 1 "the picture where there is no memory for two"
finish
done_testing
