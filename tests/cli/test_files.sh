#!/bin/sh
# What is wrong with files and surroundings is found before any work begins: none of this needs a device.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
tiny=$SF_SOURCE_ROOT/scenes/tiny/sphere.json
# So that a check that comes too late would be seen: no device can be had here.
VK_DRIVER_FILES=/nonexistent.json
VK_ICD_FILENAMES=/nonexistent.json
export VK_DRIVER_FILES VK_ICD_FILENAMES

# Folders.
expect 7 "there is no folder nowhere (mkdir -p 'nowhere')" capture "$tiny" -o nowhere/a.exr
expect 7 "mkdir -p 'a/b'" capture "$tiny" -o a.exr -o a/b/c.####.png
absent nowhere a a.exr
expect 7 "there is no folder nowhere" bench "$tiny" --json nowhere/a.json
expect 7 "there is no folder nowhere" bench "$tiny" --trace nowhere/a.json
expect 7 "there is no folder nowhere" bench --sort --json nowhere/a.json
echo text >file
expect 7 "file" capture "$tiny" -o file/a.exr
mkdir folder.exr
expect 7 "folder.exr: is a folder" capture "$tiny" -o folder.exr --overwrite
expect 7 "folder.exr: is a folder" capture "$tiny" -o folder.exr --skip-existing
if [ "$(id -u)" -ne 0 ]; then
    mkdir closed
    chmod a-w closed
    expect 7 "cannot write into folder closed" capture "$tiny" -o closed/a.exr
elif tmpfs readonly ro; then
    expect 7 "cannot write into folder readonly: Read-only file system" capture "$tiny" -o readonly/a.exr
fi

# Files that exist.
echo kept >a.0002.exr
expect 7 "a.0002.exr: exists (--overwrite replaces it" capture "$tiny" -o a.####.exr --frames 1-3
echo kept >a.0003.exr
expect 7 "a.0002.exr: exists, and 1 more" capture "$tiny" -o a.####.exr --frames 1-3
[ "$(cat a.0002.exr)" = kept ] || fail "a.0002.exr has changed"
absent a.0001.exr
expect 0 "nothing to do" capture "$tiny" -o a.%04d.exr --frames 2,3 --skip-existing
[ "$(cat a.0003.exr)" = kept ] || fail "a.0003.exr has changed"
ln -s dangling a.0009.exr
expect 7 "a.0009.exr: exists" capture "$tiny" -o a.####.exr --frames 9
# The default name is the scene's, in the current folder.
echo kept >sphere.0000.exr
expect 7 "sphere.0000.exr: exists" capture "$tiny"

# Reports to compare with.
expect 7 "No such file" bench "$tiny" --compare missing.json
echo '{"passes": 3}' >other.json
expect 2 "is not a report" bench "$tiny" --compare other.json
echo '{"passes": [' >cut.json
expect 2 "cut.json: line" bench "$tiny" --compare cut.json

# Scenes: one of each kind of failure, for its exit code.
expect 7 "missing.json" capture missing.json
expect 7 "missing.json" check missing.json
expect 7 "folder.exr" check folder.exr
: >empty.json
expect 3 "empty.json" capture empty.json
head -c 100 "$tiny" >truncated.json
expect 3 "truncated.json" check truncated.json
echo '{"camra": {}}' >unknown.json
expect 3 "did you mean" check unknown.json
echo '{"medium": {"extinction": 1e999}}' >huge.json
expect 3 "huge.json" check huge.json
printf '{"//": "\377\376"}' >latin.json
expect 3 "latin.json" check latin.json
awk 'BEGIN { for (i = 0; i < 100000; i++) printf "[" }' >deep.json
expect 3 "deep.json" check deep.json
echo '{"steps": [{"type": "flash", "strngth": 1}]}' >bang.json
echo '{"effects": [{"file": "bang.json"}]}' >bangs.json
expect 3 "/steps/0/strngth: unknown key, did you mean strength?" effect bang.json
expect 7 "missing.json" effect missing.json
expect 3 "effect-inner.json: ok: 1 emitter" effect bang.json "$SF_SOURCE_ROOT/scenes/assets/effect-inner.json"
expect 3 "bang.json: /steps/0/strngth" check bangs.json
# check goes on after a bad one, and its code is the first failure's.
expect 3 "sphere.json: ok: thick" check unknown.json "$tiny" missing.json
grep -q "missing.json" err || fail "check stopped at the first bad scene"
expect 0 "ok: thick" check "$tiny"
expect 2 "method" check "$tiny" --method thicc

# No Vulkan driver at all.
expect 4 "" devices
expect 4 "" devices --json
expect 4 "" capture "$tiny" -o new.exr
absent new.exr
expect 4 "" bench "$tiny"
expect 4 "" bench --sort
finish
