#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who may include whom. Reads every include of core/, ui/ and app/ and reports what the rules forbid.

A room of core may include itself and the rooms that its CMakeLists.txt names (ROOMS), which come before it in core/CMakeLists.txt;
it names none that it does not include; core/README.md says the same.

usage: check_includes.py ROOT            prints violations, exits 1 where there are any
       check_includes.py --unused ROOT   public headers of all rooms that nobody outside their room includes
       check_includes.py --self-test     plants one violation of each rule and checks that each is found
"""
import pathlib
import re
import sys
import tempfile

# Rooms with headers in the open that nobody outside them uses; such a header belongs to detail/. Only ever fewer.
STILL_OPEN = {"cohort", "mechanics", "pipeline", "render", "retraction", "uncertainty"}
THIRD_PARTY = re.compile(r"^(vtk|itk|dcmtk/|CGAL/|Q[A-Z]|nlohmann/|tbb/|CLI/|cholmod|openssl/|igtl|cairo|ft2build)")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def rooms(root):
    """Rooms in order, each with those that it names."""
    order = re.search(r"set\(GLISSON_ROOMS ([^)]*)\)", (root / "core/CMakeLists.txt").read_text()).group(1).split()
    named = {}
    for room in order:
        text = (root / "core" / room / "CMakeLists.txt").read_text()
        match = re.search(r"\bROOMS((?:\s+[a-z]+)+)", text)
        named[room] = set(match.group(1).split() if match else ())
        # The part of render that knows no VTK is a library of its own.
        named[room] |= {"render"} if room != "render" and "glisson_pictures" in text else set()
    return named


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp")) if folder.exists() else []


def unused_headers(root, rooms_aside=STILL_OPEN):
    """Public headers that no other room, window or program includes, be it through another public header."""
    included = {p: {name for _, name in includes(p)} for folder in ("core", "ui", "app", "resources/examples") for p in sources(root / folder)}
    public = {str(p.relative_to(root / "core")): p for p in sources(root / "core")
              if p.suffix == ".h" and "detail" not in p.parts and p.relative_to(root / "core").parts[0] not in rooms_aside}
    used, fresh = set(), set()
    for path, names in included.items():
        parts = path.relative_to(root).parts
        fresh |= {n for n in names if n in public and not (parts[0] == "core" and parts[1] == n.split("/")[0])}
    while fresh:
        used |= fresh
        fresh = {n for f in fresh for n in included[public[f]] if n in public} - used
    return [public[n] for n in sorted(public.keys() - used)]


def violations(root):
    root = pathlib.Path(root)
    found = []

    def report(path, number, why):
        found.append(f"{path.relative_to(root)}:{number}: {why}")

    may = rooms(root)
    used = {room: set() for room in may}
    for path in sources(root / "core"):
        parts = path.relative_to(root / "core").parts
        room = parts[0]
        if room not in may:
            report(path, 1, f"room '{room}' is not among GLISSON_ROOMS")
            continue
        internal = "detail" in parts
        for number, name in includes(path):
            if re.match(r"^Q[A-Z]", name):
                report(path, number, f"Qt in core: {name}")
            if name.startswith("gdcm") or "GDCM" in name:
                report(path, number, f"GDCM is never used: {name}")
            if path.suffix == ".h" and not internal and THIRD_PARTY.match(name):
                report(path, number, f"third-party header in a public header: {name}")
            other = name.split("/")[0]
            if other in may and "/" in name and other != room:
                used[room].add(other)
                if other not in may[room]:
                    report(path, number, f"{room} may not include {other}, which its CMakeLists.txt does not name: {name}")
                elif "/detail/" in name:
                    report(path, number, f"{name} is internal to {other}")
    order = list(may)
    table = dict(re.findall(r"^\| `([a-z]+)` \|[^|]*\|[^|]*\| ([^|]+?) \|$", (root / "core/README.md").read_text(encoding="utf-8"), re.M))
    for room, named in may.items():
        path = root / "core" / room / "CMakeLists.txt"
        for other in sorted(named - used[room]):
            report(path, 1, f"{room} names {other} and includes nothing of it")
        for other in sorted(named & set(order[order.index(room):])):
            report(path, 1, f"{room} names {other}, which does not come before it in core/CMakeLists.txt")
        wanted = ", ".join(other for other in order if other in named) or "–"
        if table.get(room) != wanted:
            report(root / "core/README.md", 1, f"the row of {room} ends with '{table.get(room)}', not with '{wanted}'")
    for path in unused_headers(root):
        report(path, 1, "no other room and no program includes this header: it belongs to detail/")
    for path in sources(root / "ui"):
        part = path.relative_to(root / "ui").parts[0]
        for number, name in includes(path):
            if name.startswith("vtk") and part != "views":
                report(path, number, f"VTK outside ui/views: {name}")
            if part in ("tools", "commands") and re.match(r"^Q[A-Z]", name):
                report(path, number, f"Qt in ui/{part}: {name}")
            if "/detail/" in name:
                report(path, number, f"{name} is internal to its room")
    return found


def self_test():
    named = {"base": "", "image": "base", "dicom": "base image", "roi": "image", "mechanics": "base", "render": "image live",
             "pipeline": "image", "study": "image pipeline", "live": "base"}
    table = "".join(f"| `{r}` | takes | gives | {', '.join(n.split()) or '–'} |\n" for r, n in named.items() if r != "live")
    buildfiles = {"core/CMakeLists.txt": f"set(GLISSON_ROOMS {' '.join(named)})\n", "core/README.md": table,
                  **{f"core/{r}/CMakeLists.txt": f"glisson_room({r}\n  SOURCES a.cpp\n  ROOMS {n}\n  PRIVATE_LIBRARIES x)\n"
                     for r, n in named.items()}}
    uses = {f"core/{r}/uses.cpp": "".join(f'#include "{o}/grid.h"\n' for o in n.split() if (r, o) != ("mechanics", "base"))
            for r, n in named.items() if n}
    planted = {
        "core/image/a.cpp": '#include "roi/contour_stack.h"\n',
        "core/mechanics/a.cpp": '#include "image/grid.h"\n',
        "core/base/a.cpp": "#include <QString>\n",
        "core/render/a.h": "#include <vtkRenderer.h>\n",
        "core/dicom/a.cpp": "#include <itkGDCMImageIO.h>\n",
        "core/study/a.cpp": '#include "pipeline/detail/json_reader.h"\n',
        "core/kitchen/a.cpp": "\n",
        "core/image/nobody.h": "\n",
        "core/image/nobody.cpp": '#include "image/nobody.h"\n',
        "ui/panels/a.cpp": "#include <vtkRenderer.h>\n",
        "ui/tools/a.cpp": "#include <QWidget>\n",
    }
    clean = {
        "core/image/grid.h": '#include "image/through.h"\n',
        "core/image/through.h": "\n",
        "core/roi/b.cpp": '#include "image/grid.h"\n#include <vector>\n',
        "core/render/b.cpp": "#include <vtkRenderer.h>\n",
        "core/pipeline/detail/b.h": "#include <nlohmann/json.hpp>\n",
        "ui/views/b.cpp": "#include <vtkRenderer.h>\n#include <QWidget>\n",
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in {**buildfiles, **uses, **planted, **clean}.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = violations(root)
    planted.pop("core/image/nobody.cpp")  # it only includes what is planted
    # What is wrong with build files: an edge that nobody uses, one that leads up, a row that is not there.
    planted.update({"core/mechanics/CMakeLists.txt": "", "core/render/CMakeLists.txt": "", "core/README.md": ""})
    missed = [p for p in planted if not any(v.startswith(p + ":") for v in found)]
    wrong = [v for v in found if any(v.startswith(c + ":") for c in clean)]
    for p in missed:
        print(f"self-test: the violation planted in {p} was not found")
    for v in wrong:
        print(f"self-test: reported without cause: {v}")
    return 1 if missed or wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1] == "--unused":
        print("\n".join(str(p) for p in unused_headers(pathlib.Path(sys.argv[2]), set())))
        return 0
    found = violations(sys.argv[1])
    print("\n".join(found) if found else "the include rules hold")
    return 1 if found else 0


sys.exit(main())
