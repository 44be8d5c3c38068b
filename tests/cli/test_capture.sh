#!/bin/sh
# capture for real: files are whole or absent, whatever ends it.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
need_device
scene=$SF_SOURCE_ROOT/scenes/tiny/all.json
still=$SF_SOURCE_ROOT/scenes/tiny/sphere.json # the lightest
small="-s 64x48"

# Names, several outputs at once, ranges with a step.
mkdir many
expect 0 "wrote many/a.0001.exr to many/a.0007.exr, 4 files" capture "$scene" $small -o many/a.####.exr -o many/%03d.png --frames 1-5x2,7
exists many/a.0001.exr many/a.0003.exr many/a.0005.exr many/a.0007.exr many/001.png many/003.png many/005.png many/007.png
only many 8

# Frame N alone is frame N of a sequence, whatever is asked for beside it.
expect 0 "" capture "$scene" $small -o alone.exr --frames 5 --threads 1
cmp alone.exr many/a.0005.exr || fail "frame 5 alone differs from frame 5 of the sequence"
expect 0 "" capture "$scene" $small -o alone.png --frames 5 --no-cache
cmp alone.png many/005.png || fail "frame 5 alone differs from frame 5 of the sequence (PNG)"

# What exists is left or replaced as asked.
echo kept >many/a.0003.exr
rm many/a.0005.exr
expect 0 "3 files existed" capture "$scene" $small -o many/a.####.exr --frames 1-7x2 --skip-existing
[ "$(cat many/a.0003.exr)" = kept ] || fail "--skip-existing replaced a file"
cmp alone.exr many/a.0005.exr || fail "frame 5 differs when it is the only one missing"
expect 0 "" capture "$scene" $small -o many/a.####.exr --frames 3 --overwrite -q
[ ! -s err ] || fail "--quiet is not quiet"
exists many/a.0003.exr
[ "$(cat many/a.0003.exr)" != kept ] || fail "--overwrite left a file as it was"
only many 8

# Every kind of file.
for compression in none rle zips zip piz pxr24 b44; do
    expect 0 "" capture "$still" $small -o $compression.exr --compression $compression
done
expect 0 "" capture "$still" $small -o float.exr --type float --aovs
[ "$(wc -c <float.exr)" -gt "$(wc -c <zips.exr)" ] || fail "float with AOVs is not larger than half without"
for tone in linear reinhard aces neutral; do
    expect 0 "" capture "$still" $small -o $tone.png --tone $tone --exposure -1.5
done
expect 0 "" capture "$still" -s 1x1 -o one.exr
expect 0 "" capture "$still" -s 333x1 -o thin.exr --frames 3

# An image of the graph in place of the picture.
mkdir look
expect 0 "" capture "$scene" $small -o look/####.exr -o look/####.png --frames 3-5 --inspect light.raw --validate
only look 6
expect 2 "did you mean 'light.raw'" capture "$scene" $small -o look/none.png --inspect light.rau
expect 2 "light.map" capture "$scene" $small -o look/none.png --inspect nothing
only look 6

# Two methods side by side: what cannot be is said (the pixels are a matter of tests/window/test_window_wipe.sh).
expect 2 "did you mean 'thick-larsson'" capture "$still" $small -o wipe.png --compare thick-larson
expect 2 "--wipe says where" capture "$still" $small -o wipe.png --wipe 0.3
expect 2 "name one of them" capture "$still" $small -o wipe.png --compare none --inspect light.raw

# Limits of the device.
limit=$(sed -n 's/.*"max_image_side": *\([0-9]*\).*/\1/p' devices.json | head -n 1)
if [ "$limit" -lt 32768 ]; then
    expect 2 "each side must be 1 to $limit pixels" capture "$still" -o big.exr -s $((limit + 1))x1
fi
expect 6 "memory" capture "$still" -s 2048x2048 -o big.exr --memory 1
expect 4 "nosuchdevice" capture "$still" -o big.exr --device nosuchdevice
expect 4 "99" capture "$still" -o big.exr --device 99
absent big.exr
uuid=$(sed -n 's/.*"uuid": *"\([^"]*\)".*/\1/p' devices.json | head -n 1)
expect 0 "" capture "$still" $small -o uuid.exr --device "$uuid" --frames 1
expect 0 "" capture "$still" $small -o index.exr --device 0 --frames 1

# The validation layers are silent.
expect 0 "" capture "$scene" $small -o valid.####.exr --frames 0-3 --aovs --validate

# A full disk: the files that fit are whole, none is cut, no temporary stays.
if tmpfs full size=200k; then
    expect 7 "No space left" capture "$still" $small -o full/a.####.exr --frames 0-99 --compression none
    for file in full/*; do
        [ "$(wc -c <"$file")" -eq "$(wc -c <none.exr)" ] || fail "$file is not whole"
    done
fi
finish
