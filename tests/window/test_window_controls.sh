#!/bin/sh
# Panels, keys and the mouse: a slider that is moved changes the picture, and back; time obeys its keys.
. "$SF_SOURCE_ROOT/tests/window/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/plume.json
part=500x400+20+20 # of the picture

start "$scene" -s 1100x700 --paused --frame 30 -vv
shot panels.png
shot plain.png $part

# Ctrl+F, a name, and the first control found stands where the viewer says.
key ctrl+f
sleep 0.3
xdotool type --delay 60 'medium.extinction'
expect_said 10 'control medium.extinction'
set -- $(sed -n 's/.*control medium.extinction \(.*\)$/\1/p' err | tail -n 1)
x=$(($1 + $3 / 4)) y=$(($2 + $4 / 2))
steady
xdotool mousemove --window "$window" "$x" "$y" mousedown 1
sleep 0.2
xdotool mousemove_relative -- 60 0
sleep 0.2
xdotool mousemove_relative -- 40 0
sleep 0.3
xdotool mouseup 1
xdotool mousemove --window "$window" 5 5
steady
shot moved.png
shot changed.png $part
differ plain.png changed.png "a slider moved by the mouse"
key Escape
key ctrl+z
steady
shot back.png
shot again.png $part
same plain.png again.png 0 "every parameter as in the file again"

# Keys: panels away and back, the list of keys, a step, the beginning.
xdotool mousemove --window "$window" 300 300
key Tab
steady
shot bare.png
differ panels.png bare.png "Tab"
key Tab
key question
steady
shot keys.png
shot keys-cropped.png $part
differ plain.png keys-cropped.png "the list of keys"
key Escape
key period
key period
steady
shot stepped.png
shot stepped-cropped.png $part
differ plain.png stepped-cropped.png "two frames on"
key f
steady
shot framed.png
differ stepped.png framed.png "framing the smoke"
key shift+5
steady
shot above.png
differ framed.png above.png "the view from above"
key c
steady
shot scene.png
shot scene-cropped.png $part
same stepped-cropped.png scene-cropped.png 0 "the scene's camera again"
key l
key Right Right Right
steady
shot lit.png
shot lit-cropped.png $part
differ scene.png lit.png "a light that was turned"

# A frame back and on again, before the way back is gone: it comes to rest, where it was.
xdotool key --delay 1 comma period
steady
ticks() { awk '{ print $14 + $15 }' "/proc/$view/stat"; }
before=$(ticks)
sleep 1
used=$(($(ticks) - before))
[ "$used" -lt 40 ] || fail "at rest it takes $used ticks of the processor in a second"
shot again.png $part
same lit-cropped.png again.png 0 "a frame back and on again"
finish
[ "$(figure frame)" -eq 32 ] || fail "frame $(figure frame), not 32"
[ "$(figure inputs)" -gt 10 ] || fail "only $(figure inputs) inputs were answered"
grep -q '"panel": *true' config/sfumato/view.json || { fail "settings are not remembered"; cat config/sfumato/view.json; }

# A corrupt settings file is a warning.
echo '{"width": ' >config/sfumato/view.json
start "$scene" -s 300x200 --bare --paused
said 'view.json' || { fail "a corrupt settings file is not mentioned"; cat err; }
finish

# Playing goes on by itself.
start "$scene" -s 200x150 --bare
sleep 2
key space
finish
[ "$(figure frame)" -gt 10 ] || fail "two seconds of playing came to frame $(figure frame)"

# Told to end, it closes in order and says so.
start "$scene" -s 200x150 --bare
kill -TERM "$view"
wait "$view"
code=$?
view=
[ "$code" -eq 130 ] || fail "exit code $code after SIGTERM, not 130"
! grep -q 'validation' err || { fail "the validation layers speak"; cat err; }
done_testing
