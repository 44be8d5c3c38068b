#!/usr/bin/env python3
"""The layer rule: which room may include which, and that only src/gpu touches Vulkan, but for the one file
of the program that makes a window's surface. Prints each breach; exit status 1 if any."""
import pathlib
import re
import sys

ALLOWED = {
    "base": set(),
    "params": {"base"},
    "output": {"base"},
    "texture": {"base", "output"},
    "scene": {"base", "params", "output", "texture"},
    "graph": {"base"},
    "gpu": {"base", "graph"},
    "sim": {"base", "params", "scene", "graph", "gpu"},
    "light": {"base", "params", "scene", "graph", "gpu"},
    "truth": {"base", "params", "scene"},
    "methods": {"base", "params", "scene", "graph", "gpu", "sim", "light", "truth", "texture"},
    "render": {"base", "params", "scene", "graph", "gpu", "sim", "light", "truth", "methods", "output"},
    "app": set(),
    "include": set(),
}
# glsl/shared is read by both languages; sfumato/ is the public interface that every room may implement.
EVERYWHERE = {"shared", "sfumato"}
SURFACE = "app/view/surface.c"
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)


def breaches(root):
    src = root / "src"
    for path in sorted(src.rglob("*.[ch]")) + sorted(src.rglob("*.cpp")):
        room = path.relative_to(src).parts[0]
        if room not in ALLOWED:
            yield f"{path}: no such room in the layer rule: {room}"
            continue
        sees_vulkan = room == "gpu" or path.relative_to(src).as_posix() == SURFACE
        for name in INCLUDE.findall(path.read_text()):
            if re.match(r"(vulkan/|volk)", name) and not sees_vulkan:
                yield f"{path}: includes {name}; only src/gpu and src/{SURFACE} may see Vulkan"
            first = name.split("/")[0]
            if "/" not in name or first in EVERYWHERE and not (room in ("app", "include") and first != "sfumato"):
                continue
            if first in ALLOWED and first != room and first not in ALLOWED[room]:
                yield f"{path}: {room} may not include {name}"


def main():
    root = pathlib.Path(sys.argv[1])
    found = list(breaches(root))
    print("\n".join(found) or "layers: in order")
    return 1 if found else 0


sys.exit(main())
