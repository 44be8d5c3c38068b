# Sourced by the tests of the viewer: a screen of their own (Xvfb), a window manager, and the mouse and keys by xdotool.
# shellcheck shell=sh disable=SC2034,SC2154
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
for tool in Xvfb openbox xdotool import compare; do
    command -v $tool >/dev/null || { echo "no $tool: skipped"; exit 77; }
done
need_device

screen=1280x1024
Xvfb -noreset -displayfd 3 -screen 0 ${screen}x24 -nolisten tcp 3>display 2>/dev/null &
server=$!
tries=0
while [ ! -s display ] && [ $tries -lt 200 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
[ -s display ] || { echo "Xvfb does not start"; exit 99; }
DISPLAY=:$(cat display)
export DISPLAY
openbox >/dev/null 2>&1 &
manager=$!
sleep 0.5 # it holds the server while it takes the screen over
XDG_CONFIG_HOME=$work/config
export XDG_CONFIG_HOME
view=
leave() {
    [ -z "$view" ] || kill -9 "$view" 2>/dev/null
    kill "$manager" "$server" 2>/dev/null
    wait 2>/dev/null
    cleanup
}
trap leave EXIT

# until_true SECONDS COMMAND...: tries it until it succeeds.
until_true() {
    limit=$(($1 * 20))
    shift
    tries=0
    until "$@" >/dev/null 2>&1; do
        sleep 0.05
        tries=$((tries + 1))
        [ $tries -lt $limit ] || return 1
    done
}

# Sets $window. xdotool can wait for ever on a server that somebody holds: each try has its limit.
find_window() {
    until_true 30 timeout 2 xdotool search --onlyvisible --class '^sfumato$' || { fail "no window"; cat err; exit 1; }
    window=$(timeout 2 xdotool search --onlyvisible --class '^sfumato$' | tail -n 1)
    timeout 5 xdotool windowactivate --sync "$window" 2>/dev/null
}

# start ARGUMENTS...: a viewer with validation on; $view its process, $window its window; err what it says.
start() {
    "$SFUMATO" view --validate -v --report report.json "$@" >out 2>err &
    view=$!
    find_window
    until_true 60 said 'the first picture' || { fail "no picture"; cat err; }
    case " $* " in *" --paused "*) steady ;; esac
}

# Waits until the window shows something and what it shows has stopped changing (for a viewer that is paused).
steady() {
    before=
    tries=0
    while [ $tries -lt 100 ]; do
        now=$(import -window "$window" rgb:- 2>/dev/null | cksum)
        [ "$now" != "$before" ] || return 0
        before=$now
        tries=$((tries + 1))
        sleep 0.3
    done
    fail "the window does not come to rest"
}

# shot FILE.png [GEOMETRY]: what the window shows now, or that part of it.
shot() {
    import -window "$window" whole.png
    if [ -n "${2:-}" ]; then convert whole.png -crop "$2" +repage "$1"; else mv whole.png "$1"; fi
    last_shot=$1 last_part=${2:-}
}
# colors FILE: how many there are.
colors() { identify -format %k "$1"; }
# apart A B: the greatest difference of any channel of any pixel, 0 to 255.
apart() {
    compare -metric PAE "$1" "$2" null: 2>&1 | sed 's/.*(\(.*\)).*/\1/' | awk '{ printf "%d\n", $1 * 255 + 0.5 }'
}
# A busy machine may draw late: when the last shot is one of the two, it is taken again for up to ten seconds.
# same A B TOLERANCE WHAT; differ A B WHAT
same() {
    tries=0
    while far=$(apart "$1" "$2"); [ "${far:-999}" -gt "$3" ]; do
        tries=$((tries + 1))
        if [ $tries -gt 20 ] || { [ "$last_shot" != "$1" ] && [ "$last_shot" != "$2" ]; }; then
            fail "$4: $1 and $2 differ by ${far:-size} of 255"
            return
        fi
        sleep 0.5
        shot "$last_shot" "$last_part"
    done
}
differ() {
    tries=0
    while far=$(apart "$1" "$2"); [ "${far:-999}" -eq 0 ]; do
        tries=$((tries + 1))
        [ $tries -le 20 ] || { fail "$3: nothing has changed"; return; }
        sleep 0.5
        shot "$last_shot" "$last_part"
    done
    # What has begun to change is waited for.
    [ $tries -eq 0 ] || { steady; shot "$last_shot" "$last_part"; }
}

key() { xdotool key --window "$window" --delay 40 "$@" 2>/dev/null || xdotool key "$@"; }
said() { grep -qF -e "$1" err; }
# expect_said SECONDS TEXT
expect_said() { until_true "$1" said "$2" || { fail "does not say '$2'"; cat err; }; }
# figure NAME: out of the report.
figure() { sed 's/[{}]//g; s/, "/\n"/g' report.json | sed -n "s/^\"$1\": \"\{0,1\}\([^\"]*\)\"\{0,1\}\$/\1/p"; }

# finish: closes it as a person does; it must go at once, with exit code 0 and validation silent, leaks at the end included.
finish() {
    key ctrl+q
    until_true 20 gone || { fail "does not close"; cat err; kill -9 "$view"; }
    wait "$view"
    code=$?
    view=
    [ "$code" -eq 0 ] || { fail "exit code $code"; cat err; }
    ! grep -q 'validation' err || { fail "the validation layers speak"; cat err; }
    exists report.json
}
gone() { ! kill -0 "$view" 2>/dev/null; }
done_testing() {
    [ $failures -eq 0 ] || { echo "$failures failed"; exit 1; }
    exit 0
}
