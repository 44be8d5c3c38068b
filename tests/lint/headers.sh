#!/usr/bin/env bash
# Every header compiles by itself, and so does the example at the head of sfumato.h.
set -euo pipefail
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=(-std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wpedantic -Werror -Isrc -Isrc/include -Iglsl -fsyntax-only -xc)
while read -r header; do
    echo "#include \"$PWD/$header\"" >"$work/header.c"
    cc "${flags[@]}" "$work/header.c" || { echo "headers.sh: $header does not compile by itself"; exit 1; }
done < <(find src -name '*.h' | sort)
{
    echo '#include "sfumato/sfumato.h"'
    echo 'int main(void) { static struct sf_log log;'
    sed -n 's/^ \*     //p' src/include/sfumato/sfumato.h
    echo 'return frame.width == 0; }'
} >"$work/example.c"
[ "$(wc -l <"$work/example.c")" -gt 5 ] || { echo "headers.sh: sfumato.h has no example"; exit 1; }
cc "${flags[@]}" -Wno-unused "$work/example.c" || { echo "headers.sh: the example in sfumato.h does not compile"; exit 1; }
