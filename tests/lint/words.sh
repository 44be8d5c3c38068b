#!/usr/bin/env bash
# Nothing unfinished and no file that has outgrown its room.
set -uo pipefail
cd "$1"
status=0
if grep -rnIwE '(TO''DO|FIX''ME|XX''X)' src glsl tests script docs scenes README.md 2>/dev/null; then
    echo "words.sh: unfinished words above"; status=1
fi
while read -r lines file; do
    if [ "$file" != total ] && [ "$lines" -gt 600 ]; then
        echo "words.sh: $file has $lines lines; split it at 600"; status=1
    fi
done < <(find src glsl -type f \( -name '*.[ch]' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' -o -name '*.glsl' \) -exec wc -l {} +)
while read -r lines file; do # the rest is C
    if [ "$file" != src/app/view/ui.cpp ] || [ "$lines" -gt 300 ]; then
        echo "words.sh: $file has $lines lines; C++ is src/app/view/ui.cpp alone, of at most 300"; status=1
    fi
done < <(find src tests -type f \( -name '*.cpp' -o -name '*.cc' -o -name '*.cxx' -o -name '*.hpp' \) -exec wc -l {} \;)
exit $status
