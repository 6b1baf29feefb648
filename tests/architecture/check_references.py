#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every reference key quoted in core/ stands in core/REFERENCES.bib.  usage: check_references.py ROOT"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
known = set(re.findall(r"^@\w+\{(\w+),", (root / "core/REFERENCES.bib").read_text(encoding="utf-8"), re.M))
missing = []
for path in sorted((root / "core").rglob("*")):
    if path.suffix not in (".h", ".cpp", ".md"):
        continue
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for group in re.findall(r"\[([a-z]+\d{4}\w*(?:[,;] ?[a-z]+\d{4}\w*)*)(?:,[^\]]*)?\]", line):
            for key in re.split(r"[,;] ?", group):
                if key not in known:
                    missing.append(f"{path.relative_to(root)}:{number}: [{key}] is not in core/REFERENCES.bib")
print("\n".join(missing) if missing else f"all keys are known ({len(known)} references)")
sys.exit(1 if missing or not known else 0)
