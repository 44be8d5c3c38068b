#!/bin/sh
# sfumato texture: which files it makes, and what it refuses before it makes any. None of this needs a device.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
small="--tiles 2x1 -s 24x24"

# Names, and what is in the files. What `file` says is not needed: test_texture_files reads them.
mkdir made
# shellcheck disable=SC2086
{
    expect 0 "wrote made/a.exr" texture made/a.exr made/a.png $small
    grep -q "wrote made/a.color.png" err || fail "does not name the colour's file"
    grep -q "2x1 tiles of 24x24 in .* slope 0\.0" err || fail "does not say what it made"
    exists made/a.exr made/a.color.png made/a.normal.png
    only made 3
    for channels in color alpha normal height; do
        expect 0 "" texture made/$channels.PNG made/$channels.exr $small --channels $channels -q
        [ ! -s err ] || fail "-q: says something"
        exists made/$channels.PNG made/$channels.exr
    done
    only made 11
    # The same options, the same bytes, whatever the number of threads; each option changes them.
    expect 0 "" texture again.exr $small --threads 7
    cmp -s made/a.exr again.exr || fail "two runs differ"
    for change in "--seed 2" "--kind fbm" "--octaves 2" "--lacunarity 3" "--roughness 0.9" "--scale 2" "--ragged 0.2" \
        "--softness 0.3" "--density 2" "--mottle 1" "--clones 9" "--loop 2" "--tileable" "--type float" \
        "--compression none"; do
        expect 0 "" texture other.exr $small $change --overwrite
        cmp -s made/a.exr other.exr && fail "$change changes nothing"
    done
    expect 0 "" texture loop.exr $small --loop 2
    expect 0 "" texture other.exr $small --loop 2 --changes 9 --overwrite
    cmp -s loop.exr other.exr && fail "--changes changes nothing"
    expect 0 "" texture deep.png $small --channels height --bits 16
    [ "$(od -An -tu1 -j24 -N1 deep.png)" -eq 16 ] || fail "--bits 16 is not 16"

    # Files that exist stay as they are.
    echo kept >b.normal.png
    expect 7 "b.normal.png: exists (--overwrite replaces it)" texture b.exr b.png $small
    [ "$(cat b.normal.png)" = kept ] || fail "b.normal.png has changed"
    absent b.exr b.color.png
    expect 0 "" texture b.png $small --overwrite
    [ "$(wc -c <b.normal.png)" -gt 100 ] || fail "b.normal.png was not replaced"
    expect 7 "there is no folder nowhere (mkdir -p 'nowhere')" texture nowhere/a.exr $small
    mkdir folder.exr
    expect 7 "folder.exr: is a folder" texture folder.exr $small --overwrite
    expect 2 "a.exr: would be written twice" texture a.exr a.exr $small
    expect 2 "a.color.png: would be written twice" texture a.png b.exr a.png $small --overwrite
    absent a.exr a.color.png a.normal.png
}

# What cannot be is said before anything is made.
expect 2 "needs OUTPUT" texture
for name in a a.jpg .png dir.png/a; do
    expect 2 "$name: the name must end in .exr or .png" texture $name
done
expect 2 "did you mean cellular?" texture a.exr --kind celular
expect 2 "fbm, turbulence, cellular, dispersed" texture a.exr --kind marble
expect 2 "each side must be 8 to 8192 pixels" texture a.exr -s 7x8
expect 2 "--tiles 0x1: each side must be 1 to 64" texture a.exr --tiles 0x1
expect 2 "must be ACROSSxDOWN, such as 2x2" texture a.exr --tiles 4
expect 2 "a loop of 3 does not divide the 2x2 tiles" texture a.exr --loop 3
expect 2 "over the limit" texture a.exr --tiles 64x64 -s 8192x8192
expect 2 "from 1.2 to 4" texture a.exr --lacunarity 1
expect 2 "from 0 to 2" texture a.exr --ragged nan
expect 2 "from 1 to 10" texture a.exr --octaves 0
expect 2 "did you mean normal?" texture a.exr --channels normals
expect 2 "known: 8, 16" texture a.exr --bits 12
expect 2 "did you mean --softness?" texture a.exr --softnes 1
expect 2 "too many arguments" texture a.exr b.exr c.exr d.exr e.exr f.exr g.exr h.exr i.exr
absent a.exr

# A signal stops it, and leaves nothing.
mkdir stopped
"$SFUMATO" texture stopped/a.exr -s 4096x4096 2>err &
pid=$!
sleep 1
kill -TERM $pid # a shell lets its background jobs ignore SIGINT
wait $pid
code=$?
[ "$code" -eq 130 ] || fail "interrupted: exit code $code"
grep -q "interrupted: nothing is written" err || fail "interrupted: says nothing of it"
only stopped 0
finish
