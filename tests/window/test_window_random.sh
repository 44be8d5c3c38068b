#!/bin/sh
# 2,000 times shown under random input and sizes, panels included: memory stays flat but for the pipelines that are kept (a bounded number),
# and nothing breaks.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/tiny/all.json
[ -n "${SEED:-}" ] || SEED=7

# Without a window manager: random clicks would find its menus, and end it.
"$SFUMATO" view --validate -v --report report.json "$scene" --set sim.fps=200 -s 300x220 --present-mode immediate --exit-after 2200 >out 2>err &
view=$!
find_window
kill "$manager"
wait "$manager" 2>/dev/null
resident() { awk '/^VmRSS/ { print $2 }' "/proc/$view/status" 2>/dev/null; }

# Deterministic input: awk writes xdotool's script for each round. Frames follow each other fast, so that it takes not too long.
turn=0
start_kib=
while kill -0 "$view" 2>/dev/null && [ $turn -lt 400 ]; do
    awk -v seed="$((SEED + turn))" -v window="$window" 'BEGIN {
        srand(seed)
        split("space period comma Tab f c l o Home bracketleft bracketright question Escape shift+1 shift+5 ctrl+1 1 Left Up p ctrl+z slash Escape", keys)
        for (i = 0; i < 12; i++) {
            what = int(rand() * 6)
            x = int(rand() * 300); y = int(rand() * 220)
            if (what == 0) print "windowsize " window " " 1 + int(rand() * 640) " " 1 + int(rand() * 420)
            else if (what == 1) print "key " keys[1 + int(rand() * 23)]
            else if (what == 2) print "mousemove --window " window " " x " " y " mousedown 1 mousemove_relative -- " int(rand() * 80 - 40) " " int(rand() * 80 - 40) " mouseup 1"
            else if (what == 3) print "mousemove --window " window " " x " " y " click 4"
            else if (what == 4) print "mousemove --window " window " " x " " y " mousedown 3 mousemove_relative -- " int(rand() * 40 - 20) " 5 mouseup 3"
            else print "mousemove --window " window " " x " " y " click 5"
        }
    }' >input
    timeout 20 xdotool - <input >/dev/null 2>&1
    turn=$((turn + 1))
    [ $turn -ne 50 ] || start_kib=$(resident)
    now=$(resident)
    [ -z "$now" ] || end_kib=$now
done
until_true 120 gone || { fail "does not come to its end"; kill -9 "$view"; }
wait "$view"
code=$?
view=
[ "$code" -eq 0 ] || { fail "exit code $code"; tail -n 20 err; }
! grep -q 'not taken' err || fail "the eye went where no eye can be"
! grep -q 'validation' err || { fail "the validation layers speak"; grep -m 5 validation err; }
[ "$(figure shown)" -ge 2000 ] || fail "shown only $(figure shown) times"
echo "resident ${start_kib:-?} KiB after 50 rounds, ${end_kib:-?} KiB at the end; $(figure pictures) pictures, $(figure remade) swapchains, $turn rounds"
[ -n "$start_kib" ] && [ $((end_kib - start_kib)) -lt 40000 ] || fail "memory grew from ${start_kib:-?} to ${end_kib:-?} KiB"
done_testing
