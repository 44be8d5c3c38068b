#!/bin/sh
# bench and its reports.
. "$SF_SOURCE_ROOT/tests/cli/lib.sh"
need_device
scene=$SF_SOURCE_ROOT/scenes/tiny/all.json
short="-s 64x48 --frames 4-7 --warmup 2 --repeats 2"

expect 0 "compute copy of an 64x48 RGBA32F image (goal of thick 2.0x: " bench "$scene" $short --json a.json --csv a.csv --trace a.trace
for line in "live particles" "simulation" "picture" "sum of passes" "frame on the device" "wall, two in flight" "CPU, recording" \
    "passes account for" "image copy" "arithmetic"; do
    grep -q "$line" out || fail "bench does not print '$line'"
done
exists a.json a.csv a.trace
grep -q '"frame_in_compute_copies"' a.json || fail "a.json has no ratio to the compute copy"
# Each pass of the table stands in each report.
passes=$(sed 1d a.csv | cut -d, -f1)
[ -n "$passes" ] || fail "a.csv has no passes"
for pass in $passes; do
    grep -q "^$pass " out || fail "$pass is not in the table"
    grep -q "\"name\": \"$pass\"" a.json || fail "$pass is not in a.json"
    grep -q "\"name\":\"$pass\"" a.trace || fail "$pass is not in a.trace"
done
# No time is negative or absurd, and shares come to one.
awk -F, 'NR > 1 && !($5 >= 0 && $5 <= $6 && $6 <= $7 && $7 < 60e9) { print; bad = 1 } END { exit bad }' a.csv ||
    fail "a.csv: times out of order"
awk -F: '/"share"/ { sum += $2 } END { exit !(sum > 0.999 && sum < 1.001) }' a.json || fail "the shares do not come to one"

expect 0 "frame in compute copies:" bench "$scene" $short --compare a.json --json b.json
! grep -q "warning" err || { fail "a run compared with its like warns"; cat err; }
expect 0 "its size is 64x48, not 32x32" bench "$scene" -s 32x32 --frames 4-7 --repeats 1 --compare a.json
# A report on standard output stands alone.
expect 0 "" bench "$scene" $short --json -
[ "$(head -c 1 out)" = "{" ] || fail "--json - prints something before the report"
# Frame 0 has nothing to warm up with and no step of simulation.
expect 0 "frame = " bench "$scene" -s 16x16 --frames 0 --repeats 1

expect 0 "yes" bench --sort --sizes 1,1000,65536 --repeats 2 --json sort.json
[ "$(grep -c '"correct": true' sort.json)" -eq 3 ] || fail "sort.json does not have three verified sizes"

# Published tables: every row has a time, and the published numbers stand beside it.
for suite in larsson-fps larsson-table1; do
    expect 0 "Larsson's thesis" bench --suite $suite --quick --json $suite.json
    grep -q '^sfumato: timing' err || fail "--suite $suite shows no progress"
    ! grep -Eq '"(min|max|average)": (0\.0|-)' $suite.json || fail "$suite.json: a row without a time"
done
[ "$(grep -c '"row":' larsson-table1.json)" -eq 7 ] && [ "$(grep -c '"row":' larsson-fps.json)" -eq 6 ] || fail "the suites have other rows"
grep -q "^hard .* 1.00  |  .* 212  1.00" out || fail "the ratios are not to the first row"
grep -q "^soft, and its z used again .* 190  0.90" out || fail "the thesis's 190 is not beside its row"
expect 2 "did you mean larsson-fps?" bench --suite larson-fps
expect 2 "sizes of its own" bench --suite larsson-fps -s 64x64
expect 2 "takes no scene" bench --suite larsson-fps "$scene"
expect 2 "--quick needs --suite" bench "$scene" --quick
finish
