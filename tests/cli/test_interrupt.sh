#!/bin/sh
# Ctrl-C finishes the frame in hand; SIGKILL leaves no half-written file under a final name.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
need_device
scene=$SF_SOURCE_ROOT/scenes/tiny/all.json
options="-s 320x240 --compression none --frames 0-99999"

# begin FOLDER: a capture in the background, $pid, that has written three frames at least.
begin() {
    mkdir "$1"
    # A shell lets its background jobs ignore SIGINT, so they are told to stop by SIGTERM.
    "$SFUMATO" capture "$scene" $options -o "$1/a.######.exr" >out 2>err &
    pid=$!
    tries=0
    while [ ! -e "$1/a.000002.exr" ]; do
        sleep 0.05
        tries=$((tries + 1))
        if [ $tries -gt 1200 ]; then
            fail "$1: no frame in a minute"
            cat err
            break
        fi
    done
}
# whole FOLDER: all files are of one size.
whole() {
    sizes=$(for file in "$1"/a.??????.exr; do wc -c <"$file"; done | sort -u | wc -l)
    [ "$sizes" -eq 1 ] || { fail "$1: files of different sizes"; ls -la "$1"; }
}

begin term
kill -TERM "$pid"
wait "$pid"
code=$?
[ "$code" -eq 130 ] || fail "SIGTERM: exit code $code, not 130"
grep -q "interrupted: .* of 100000 frames are written" err || { fail "SIGTERM: does not say how far it came"; cat err; }
whole term
only term "$(find term -name 'a.??????.exr' | wc -l)"
written=$(sed -n 's/.*interrupted: \([0-9]*\) of.*/\1/p' err)
only term "$written"

begin killed
kill -KILL "$pid"
wait "$pid" 2>wait.err
whole killed

# The second one does not wait for the frame in hand.
mkdir twice
"$SFUMATO" capture "$scene" -s 4000x4000 -o twice/a.exr >out 2>err &
pid=$!
sleep 1
kill -TERM "$pid"
sleep 0.1
kill -TERM "$pid"
wait "$pid" 2>wait.err
code=$?
[ "$code" -eq 143 ] || { fail "SIGTERM twice: exit code $code, not 143"; cat err; }
absent twice/a.exr

# SIGINT as a terminal sends it, in the long way to a late frame: at once, and with nothing written.
mkdir way
run timeout --preserve-status -k 60 -s INT 1 "$SFUMATO" capture "$scene" -s 32x32 -o way/a.exr --frames 900000
[ "$code" -eq 130 ] || { fail "SIGINT: exit code $code, not 130"; cat err; }
only way 0
finish
