# Sourced by the tests of the command line. $SFUMATO is the program, $SF_SOURCE_ROOT the checkout.
# shellcheck shell=sh disable=SC2034
set -u
export LC_ALL=C
failures=0
mounts=
work=$(mktemp -d)
cleanup() {
    for mount in $mounts; do umount "$mount"; done
    rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 99' HUP INT TERM
cd "$work" || exit 99
# The tests leave the user's own cache alone.
XDG_CACHE_HOME=$work/cache
export XDG_CACHE_HOME

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# run COMMAND...: leaves $code, and what it said in the files out and err.
run() {
    "$@" >out 2>err
    code=$?
}

# expect CODE FRAGMENT ARGUMENTS...: the program exits with CODE, and FRAGMENT stands in what it says ("" asks for nothing). A failure
# must have said why in a line that begins with "sfumato: error: ".
expect() {
    wanted=$1
    fragment=$2
    shift 2
    run "$SFUMATO" "$@"
    [ "$code" -eq "$wanted" ] || { fail "sfumato $*: exit code $code, not $wanted"; cat err; return; }
    [ -z "$fragment" ] || grep -qF -e "$fragment" out err || { fail "sfumato $*: does not say '$fragment'"; cat out err; }
    case $wanted in
    0 | 130) ;;
    *) grep -q '^sfumato: error: ' err || { fail "sfumato $*: gives no reason"; cat err; } ;;
    esac
}

# exists FILE..., absent FILE...
exists() {
    for file in "$@"; do [ -s "$file" ] || fail "$file is missing or empty"; done
}
absent() {
    for file in "$@"; do [ ! -e "$file" ] || fail "$file is there"; done
}
# only FOLDER COUNT: so many files and nothing else, such as a temporary, are in the folder.
only() {
    count=$(find "$1" -mindepth 1 | wc -l)
    [ "$count" -eq "$2" ] || { fail "$1 holds $count files, not $2:"; ls -la "$1"; }
}

# Exits with 77, which is a skip, when no Vulkan device can draw.
need_device() {
    if ! "$SFUMATO" devices --json >devices.json 2>err || ! grep -q '"suitable": true' devices.json; then
        echo "no Vulkan device:"
        cat err
        exit 77
    fi
}

# tmpfs FOLDER OPTIONS: false where mounting is not allowed.
tmpfs() {
    mkdir -p "$1"
    mount -t tmpfs -o "$2" tmpfs "$1" 2>mount.err || { echo "not tried: mount -o $2: $(cat mount.err)"; return 1; }
    mounts="$1 $mounts"
}

finish() {
    [ "$failures" -eq 0 ] || echo "$failures checks failed"
    [ "$failures" -eq 0 ]
    exit
}
