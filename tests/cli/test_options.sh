#!/bin/sh
# The command line itself: what cannot be is said, with exit code 2, before anything is done.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
scene=$SF_SOURCE_ROOT/scenes/tiny/sphere.json

expect 0 "sfumato COMMAND" help
expect 0 "sfumato COMMAND" --help
expect 0 "sfumato 0." --version
run "$SFUMATO"
[ "$code" -eq 2 ] || fail "no command: exit code $code"
for command in capture bench verify texture devices graph params check effect; do
    expect 0 "sfumato $command" help $command
    cp out by_help
    expect 0 "sfumato $command" $command --help
    cmp -s out by_help || fail "help $command and $command --help differ"
    [ "$(wc -l <out)" -le 40 ] || fail "$command --help does not fit a screen"
    [ "$(awk '{ if (length > most) most = length } END { print most }' out)" -le 120 ] || fail "$command --help is too wide"
done

expect 2 "did you mean capture?" captur
expect 2 "unknown command xyzzy" xyzzy
expect 2 "a command comes first" --validate capture
expect 2 "did you mean check?" help chekc
expect 2 "did you mean --frames?" capture "$scene" --frame 1
expect 2 "did you mean --overwrite?" capture "$scene" --overwrit
expect 2 "unknown option --xyzzy" bench "$scene" --xyzzy=3
expect 2 "unknown option -x" capture "$scene" -x
expect 2 "needs a value: PATTERN" capture "$scene" -o
expect 2 "needs a value: LIST" capture "$scene" --frames --overwrite
expect 2 "takes no value" capture "$scene" --overwrite=yes
expect 2 "needs SCENE" capture
expect 2 "needs SCENE" bench
expect 2 "too many arguments: b.json" capture a.json b.json
expect 2 "too many arguments: --aovs" capture a.json -- --aovs

for size in 0x0 0x800 800x0 100000x100000 800x40000 99999999999999999999x1; do
    expect 2 "-s $size: each side must be 1 to 32768 pixels" capture "$scene" -s $size
done
for size in 800 x 800x 800x800x800 -8x8 8.5x8 "8 x8" WxH; do
    expect 2 "such as 800x800" capture "$scene" -s "$size"
done
expect 2 "frame list" capture "$scene" --frames 1-
expect 2 "frame list" capture "$scene" --frames 9-1
expect 2 "frame list" capture "$scene" --frames=1-100x0
expect 2 "frame list" capture "$scene" --frames 1,,2
expect 2 "frame list" capture "$scene" --frames -5
expect 2 "frame list" bench "$scene" --frames x
expect 2 "--frames: LIST is empty" capture "$scene" --frames ""
expect 2 "must end in .exr or .png" capture "$scene" -o a.jpg
expect 2 "must end in .exr or .png" capture "$scene" -o a.####
expect 2 "must end in .exr or .png" capture "$scene" -o dir.exr/a
expect 2 "a.png" capture "$scene" -o a.png --frames 1-2
expect 2 "is given twice" capture "$scene" -o a.exr -o a.exr
expect 2 "exclude each other" capture "$scene" --overwrite --skip-existing
expect 2 "must be one of half, float" capture "$scene" --type double
expect 2 "did you mean zips?" capture "$scene" --compression zisps
expect 2 "none, rle, zips" capture "$scene" --compression dwaa
expect 2 "did you mean aces?" capture "$scene" --tone ace
expect 2 "from -32 to 32" capture "$scene" --exposure 1e999
expect 2 "from -32 to 32" capture "$scene" --exposure nan
expect 2 "from 1 to 64" capture "$scene" --threads 0
expect 2 "from 1 to 64" capture "$scene" --threads -1
expect 2 "from 1 to 64" capture "$scene" --threads 4k
expect 2 "from 1 to 100000" bench "$scene" --repeats 0
expect 2 "--sizes needs --sort" bench "$scene" --sizes 4
expect 2 "takes no scene" bench --sort "$scene"
expect 2 "whole numbers from 1" bench --sort --sizes 16,,4
expect 2 "whole numbers from 1" bench --sort --sizes 0
expect 2 "did you mean json?" graph "$scene" --format jsn
expect 2 "json-schema" params --format html
expect 2 "method" capture "$scene" --method thicc
expect 2 "thick.stepz" capture "$scene" --set thick.stepz=3
expect 2 "steps" capture "$scene" --set thick.steps=many
expect 2 "nothing" capture "$scene" --set nothing

# Options may stand anywhere, be joined with = or not, and end at --.
expect 0 "" graph --format=json "$scene" -s 64x32
cp out joined
expect 0 "" graph "$scene" -s64x32 --format json
cmp -s out joined || fail "graph prints differently with other spellings of the options"
expect 0 "" graph -s=64x32 --format json -- "$scene"
cmp -s out joined || fail "graph prints differently after --"
for format in text json-schema markdown; do
    expect 0 "thick" params --format $format
done
for format in text dot json; do
    expect 0 "thick" graph "$scene" --format $format
done

# Output that is lost is an error, and a closed pipe no sudden death.
if [ -c /dev/full ]; then
    "$SFUMATO" params >/dev/full 2>err
    [ $? -eq 7 ] || fail "params >/dev/full does not exit with 7"
    grep -q "standard output: " err || fail "params >/dev/full does not say why"
fi
code=$({ "$SFUMATO" params 2>err; echo $? >closed; } | true; cat closed)
[ "$code" -eq 7 ] || [ "$code" -eq 0 ] || fail "params into a closed pipe: exit code $code"
finish
