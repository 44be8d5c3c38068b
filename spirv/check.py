#!/usr/bin/env python3
"""Fails unless the shaders listed in spirv/meson.build are those under glsl/: check.py GLSL NAME..."""
import pathlib
import sys


def main():
    root, listed = pathlib.Path(sys.argv[1]), sys.argv[2:]
    there = {str(path.relative_to(root)) for kind in ('comp', 'vert', 'frag') for path in root.rglob('*.' + kind)}
    wrong = [f'{name}: not listed in spirv/meson.build' for name in sorted(there - set(listed))]
    if listed != sorted(listed):
        wrong.append('the list in spirv/meson.build is not in order')
    for line in wrong:
        print(line)
    sys.exit(1 if wrong else 0)


main()
