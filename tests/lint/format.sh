#!/usr/bin/env bash
# Every C and C++ file as clang-format would have it. Exit 77 (skip) where clang-format is not installed.
set -euo pipefail
cd "$1"
command -v clang-format >/dev/null || exit 77
mapfile -t files < <(find src tests glsl/shared -name '*.[ch]' -o -name '*.cpp' | sort)
clang-format --dry-run --Werror "${files[@]}"
