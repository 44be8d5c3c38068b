#!/usr/bin/env python3
"""Every picture and relative link in README.md and docs/*.md leads to a file, and every #part of one to a heading. Exit status 1 if not."""
import pathlib
import re
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
CODE = re.compile(r"^(```|~~~).*?^\1|`[^`\n]*`", re.M | re.S)


def anchors(path):
    """Headings as the usual viewers name them: lower case, no punctuation, hyphens for spaces."""
    text = CODE.sub(lambda match: match.group().strip("`") if match.group(1) is None else "", path.read_text())
    heads = re.findall(r"^#+\s+(.*?)\s*#*$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def broken(root):
    for page in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        for target in LINK.findall(CODE.sub("", page.read_text())):
            if re.match(r"[a-z][a-z0-9+.-]*:", target, re.I):
                continue
            name, _, part = target.partition("#")
            path = (page.parent / name) if name else page
            if not path.exists():
                yield f"{page.relative_to(root)}: {target}: no such file"
            elif part and path.suffix == ".md" and part not in anchors(path):
                yield f"{page.relative_to(root)}: {target}: no such heading"


def main():
    found = list(broken(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(found) or "links: all lead somewhere")
    return 1 if found else 0


sys.exit(main())
