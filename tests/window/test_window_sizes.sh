#!/bin/sh
# Sizes: odd, tiny, large; minimised and restored; full screen; every present mode.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/plume.json

start "$scene" -s 400x300 --paused --frame 20
for size in 401x299 333x77 1x1 7x500 640x3 1111x777 200x150; do
    xdotool windowsize "$window" "${size%x*}" "${size#*x}"
    sleep 0.4
    steady # shown before the next one comes, however slow the device is
done
xdotool windowsize --sync "$window" 311 233
key Tab
steady
shot odd.png
[ "$(identify -format %wx%h odd.png)" = 311x233 ] || fail "the window is $(identify -format %wx%h odd.png), not 311x233"
run "$SFUMATO" capture "$scene" -s 311x233 --frames 20 -o headless.png
same odd.png headless.png 1 "an odd size after many"

# Minimised it sleeps: a few turns a second at most, though time is running.
xdotool windowminimize "$window"
sleep 0.5
key space
xdotool windowmap "$window" 2>/dev/null
xdotool windowactivate "$window" 2>/dev/null
sleep 1
key space
steady
shot restored.png
[ "$(colors restored.png)" -gt 100 ] || fail "nothing after it was restored"
key F11
sleep 1
steady
shot full.png
[ "$(identify -format %wx%h full.png)" = $screen ] || fail "full screen is $(identify -format %wx%h full.png), not $screen"
key F11
sleep 1
steady
shot window.png
[ "$(identify -format %wx%h window.png)" = 311x233 ] || fail "back from full screen it is $(identify -format %wx%h window.png)"
finish
[ "$(figure remade)" -ge 8 ] || fail "the swapchain was made anew only $(figure remade) times"

# Minimised for 3 seconds while it plays: hardly a turn of the loop, hardly any time of the processor.
start "$scene" -s 200x150 --bare
xdotool windowminimize "$window"
sleep 0.5
ticks() { awk '{ print $14 + $15 }' "/proc/$view/stat"; }
before=$(ticks)
sleep 3
used=$(($(ticks) - before))
[ "$used" -lt 60 ] || fail "minimised it takes $used ticks of the processor in 3 s"
xdotool windowmap "$window"
xdotool windowactivate --sync "$window" 2>/dev/null
finish

for mode in fifo mailbox immediate; do
    start "$scene" -s 160x120 --bare --paused --present-mode $mode
    finish
    [ "$(figure present_mode)" = $mode ] || fail "present mode $(figure present_mode), not $mode"
done
expect 2 'fifo' view "$scene" --present-mode vsync
expect 2 'mailbox' view "$scene" --present-mode vsync
expect 2 'nowhere' view --set nowhere.x=1 "$scene"
screen_name=$DISPLAY
unset DISPLAY
expect 4 'capture' view "$scene"
DISPLAY=$screen_name
export DISPLAY
DISPLAY=:77777 expect 4 'capture' view "$scene"
done_testing
