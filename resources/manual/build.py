#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual: Markdown pages to HTML (pandoc), and to one PDF (weasyprint) where asked for.

usage: build.py OUTPUT [--pdf]      writes OUTPUT/html/*.html, and OUTPUT/glisson-manual.pdf with --pdf
       build.py --messages          prints the generated page of messages as Markdown; needs no pandoc
       build.py --page FILE         prints one page as Markdown with everything that it includes; needs no pandoc

A page may take part of another document, so that every fact has one place:
    <!-- include: core/pipeline/README.md :: ## Figures of contact :: ## How far -->
takes the lines from the first one that begins with the second field to the one before the first that begins with the third
(to the end of the document where that is empty).
"""
import argparse
import concurrent.futures
import html
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
REFERENCES = ROOT / "core/REFERENCES.bib"
INCLUDE = re.compile(r"^<!-- include: (\S+) :: (.+?) ::(?: (.*?))? ?-->$", re.M)
DIAGNOSTIC = re.compile(r'^GLISSON_DIAGNOSTIC\((\w+), "([\w-]+)", (\w+),\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)')
SEVERITY_MEANS = {"Note": "told, nothing to do", "Warning": "check it; `--strict` refuses it", "Error": "the numbers are no answer"}


def fail(message):
    sys.exit(f"manual: {message}")


def pages():
    """[(file, chapter)] in the order of pages.txt; a line without .md begins a chapter."""
    chapter, found = "", []
    for line in (HERE / "pages.txt").read_text(encoding="utf-8").splitlines():
        line = line.strip()
        if not line:
            continue
        if line.endswith(".md"):
            found.append((line, chapter))
        else:
            chapter = line
    return found


def part(path, first, last):
    """Lines of a document from the one that begins with `first` to the one before that which begins with `last`."""
    lines = path.read_text(encoding="utf-8").splitlines()
    start = next((n for n, line in enumerate(lines) if line.startswith(first)), None)
    if start is None:
        fail(f"{path.relative_to(ROOT)} has no line that begins with \"{first}\"")
    end = len(lines)
    if last:
        end = next((n for n in range(start + 1, len(lines)) if lines[n].startswith(last)), None)
        if end is None:
            fail(f"{path.relative_to(ROOT)} has no line after \"{first}\" that begins with \"{last}\"")
    return "\n".join(lines[start:end]).strip("\n")


def reference_keys():
    return set(re.findall(r"^@\w+\{(\w+),", REFERENCES.read_text(encoding="utf-8"), re.M))


def cite(text, keys):
    """[key] and [key, key] of the code's documents as pandoc's citations."""
    def citation(match):
        named = [k.strip() for k in re.split(r"[,;]", match.group(1))]
        return "[" + "; ".join("@" + k for k in named) + "]" if all(k in keys for k in named) else match.group(0)
    return re.sub(r"\[([a-z]+\d{4}\w*(?:[,;] ?[a-z]+\d{4}\w*)*)\](?!\()", citation, text)


def diagnostics():
    """[(code, severity, text, room)] of core/base/diagnostics.def, in its order."""
    room, found = "", []
    source = (ROOT / "core/base/diagnostics.def").read_text(encoding="utf-8")
    for match in re.finditer(r"^// (\w+)(?::.*)?$|" + DIAGNOSTIC.pattern, source, re.M):
        if match.group(1):
            room = match.group(1) if (ROOT / "core" / match.group(1)).is_dir() else room
        else:
            text = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', match.group(5))).replace('\\"', '"')
            found.append((match.group(3), match.group(4), text, room))
    return found


def advice():
    """{code: what to do} of messages.advice: "code: text", continued by indented lines."""
    found, code = {}, None
    for number, line in enumerate((HERE / "messages.advice").read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if line[0].isspace():
            if code is None:
                fail(f"messages.advice:{number}: continues nothing")
            found[code] += " " + line.strip()
            continue
        code, colon, text = line.partition(":")
        if not colon or code in found:
            fail(f"messages.advice:{number}: " + ("a second entry of " + code if colon else "no colon"))
        found[code] = text.strip()
    return found


def messages():
    """The page of messages: introduction, then every code with its text and what to do."""
    todo = advice()
    out = [(HERE / "messages.md").read_text(encoding="utf-8").strip(), ""]
    room = None
    for code, severity, text, of in diagnostics():
        if code not in todo:
            fail(f"messages.advice says nothing of the code {code} of core/base/diagnostics.def")
        if of != room:
            room = of
            out += [f"## {room}", ""]
        shown = re.sub(r"\{(\w+)\}", lambda m: "⟨" + m.group(1) + "⟩", text)
        shown = shown.replace("<", "&lt;").replace("*", "\\*")
        out += [f"### {code} {{#{code}}}", "", f"*{severity}* – {SEVERITY_MEANS[severity]}.", "", f"> {shown}", "",
                f"**What to do.** {todo.pop(code)}", ""]
    if todo:
        fail("messages.advice speaks of codes that are not in core/base/diagnostics.def: " + ", ".join(todo))
    return "\n".join(out)


def markdown(name):
    """A page with what it includes, citations as pandoc reads them, and links to documents outside of the manual as text."""
    text = messages() if name == "messages.md" else (HERE / name).read_text(encoding="utf-8")
    text = INCLUDE.sub(lambda m: part(ROOT / m.group(1), m.group(2), m.group(3) or ""), text)
    if "<!-- include" in text:
        fail(f"{name}: an include that is not of the form <!-- include: FILE :: FROM :: TO -->")
    return cite(text, reference_keys())


def title_of(name):
    return (HERE / name).read_text(encoding="utf-8").splitlines()[0].lstrip("# ")


def language(name):
    return "de" if name.endswith(".de.md") else "en"


def to_html(name, text, math):
    command = ["pandoc", "--from", "markdown-implicit_figures+autolink_bare_uris", "--to", "html5", math, "--citeproc",
               "--bibliography", str(REFERENCES), "--metadata", "link-citations=true", "--metadata",
               "reference-section-title=" + ("Quellen" if language(name) == "de" else "References"), "--wrap", "none"]
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    if done.returncode or "[WARNING]" in done.stderr:
        fail(f"{name}: pandoc: {done.stderr.strip()}")
    return done.stdout


def navigation(all_pages, current):
    out, chapter = [], None
    for name, of in all_pages:
        if of != chapter:
            chapter = of
            out.append(f"<h2>{html.escape(chapter)}</h2>")
        here = ' class="here"' if name == current else ""
        depth = "../" * current.count("/")
        out.append(f'<a{here} href="{depth}{name[:-3]}.html">{html.escape(title_of(name))}</a>')
    return "\n".join(out)


def relink(body, name, output):
    """Pages become .html; pictures are copied beside them; other files of the repository are named, not linked."""
    folder = (HERE / name).parent

    def target(match):
        attribute, link = match.group(1), match.group(2)
        if re.match(r"[a-z]+:|#", link):
            return match.group(0)
        path, hash_, anchor = link.partition("#")
        found = (folder / path).resolve()
        if not found.exists():
            fail(f"{name}: {link} leads nowhere")
        if found.is_relative_to(HERE) and found.suffix == ".md":
            return f'{attribute}="{path[:-3]}.html{hash_}{anchor}"'
        if found.suffix in (".svg", ".png"):
            place = output / "pictures" / found.name
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(found, place)
            return f'{attribute}="{"../" * name.count("/")}pictures/{found.name}"'
        return f'class="file" title="{html.escape(str(found.relative_to(ROOT)))}"'
    return re.sub(r'\b(href|src)="([^"]+)"', target, body)


def write_html(output):
    all_pages = pages()
    output.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(HERE / "style.css", output / "style.css")
    template = (HERE / "template.html").read_text(encoding="utf-8")

    def write(name):
        body = relink(to_html(name, markdown(name), "--mathml"), name, output)
        values = {"language": language(name), "title": html.escape(title_of(name)), "depth": "../" * name.count("/"),
                  "navigation": navigation(all_pages, name), "body": body}
        place = output / (name[:-3] + ".html")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(re.sub(r"@(\w+)@", lambda m: values[m.group(1)], template), encoding="utf-8")

    with concurrent.futures.ThreadPoolExecutor(max_workers=max(1, min(4, os.cpu_count() or 1))) as pool:
        list(pool.map(write, [name for name, _ in all_pages]))
    check_links(output)


def check_links(output):
    """Every link inside the manual leads to a page and to an anchor of it."""
    texts = {p.relative_to(output).as_posix(): p.read_text(encoding="utf-8") for p in output.rglob("*.html")}
    anchors = {name: set(re.findall(r'\bid="([^"]+)"', text)) for name, text in texts.items()}
    for name, text in texts.items():
        for link in re.findall(r'\bhref="([^"]+)"', text):
            if re.match(r"[a-z]+:", link) or link.endswith(".css"):
                continue
            path, _, anchor = link.partition("#")
            page = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            if page not in texts:
                fail(f"{name}: {link} leads to no page")
            if anchor and anchor not in anchors[page]:
                fail(f"{name}: {link} leads to no place of {page}")


def draw_equation(tex, folder, display, drawn):
    """An equation as SVG (weasyprint reads no MathML); the file's name, height and depth in em."""
    from matplotlib import font_manager, mathtext, rcParams
    rcParams["mathtext.fontset"] = "stix"
    rcParams["svg.fonttype"] = "path"
    if tex not in drawn:
        name = f"equation-{len(drawn)}.svg"
        text = re.sub(r"\\(tfrac|dfrac)", r"\\frac", re.sub(r"\s+", " ", tex.strip()))
        size = 12
        try:
            depth = mathtext.math_to_image(f"${text}$", str(folder / name), format="svg",
                                           prop=font_manager.FontProperties(size=size))
        except ValueError as error:
            fail(f"equation {tex}: {error}")
        height = float(re.search(r'height="([\d.]+)pt"', (folder / name).read_text(encoding="utf-8")).group(1))
        drawn[tex] = (name, height / size, depth / size)
    name, height, depth = drawn[tex]
    height, depth = 1.15 * height, 1.15 * depth  # its letters look smaller than those of the text
    style = f"height:{height:.3f}em;vertical-align:{-depth:.3f}em"
    return f'<img class="{"display" if display else "inline"} equation" src="{name}" style="{style}" alt="{html.escape(tex)}"/>'


def write_pdf(output, file):
    """All pages as one document; weasyprint lays it out."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        drawn, bodies = {}, []
        for name, _ in pages():
            anchor = re.sub(r"\W", "-", name[:-3])
            body = relink(to_html(name, markdown(name), "--mathjax"), name, folder)
            body = re.sub(r'<span class="math (inline|display)">\\[(\[](.*?)\\[)\]]</span>',
                          lambda m: draw_equation(html.unescape(m.group(2)), folder, m.group(1) == "display", drawn), body,
                          flags=re.S)
            body = re.sub(r'\bid="', f'id="{anchor}--', body)
            body = re.sub(r'href="#', f'href="#{anchor}--', body)
            body = re.sub(r'src="(?:\.\./)+', 'src="', body)

            def inner(match, name=name):
                page = os.path.normpath(os.path.join(os.path.dirname(name), match.group(1)))
                to = re.sub(r"\W", "-", page)
                return f'href="#{to}' + (f'--{match.group(3)}"' if match.group(3) else '"')
            body = re.sub(r'href="([\w./-]+)\.html(#([^"]*))?"', inner, body)
            bodies.append(f'<section id="{anchor}" lang="{language(name)}">{body}</section>')
        shutil.copyfile(HERE / "style.css", folder / "style.css")
        page = ('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Glisson</title>'
                '<link rel="stylesheet" href="style.css"></head><body class="print"><main>' + "\n".join(bodies) + "</main></body></html>")
        (folder / "manual.html").write_text(page, encoding="utf-8")
        done = subprocess.run(["weasyprint", "--quiet", str(folder / "manual.html"), str(file)], capture_output=True, text=True)
        if done.returncode:
            fail("weasyprint: " + done.stderr.strip()[-400:])


def main():
    parser = argparse.ArgumentParser(description="builds the manual")
    parser.add_argument("output", nargs="?", type=pathlib.Path)
    parser.add_argument("--pdf", action="store_true")
    parser.add_argument("--messages", action="store_true")
    parser.add_argument("--page")
    a = parser.parse_args()
    if a.messages:
        print(messages())
    elif a.page:
        print(markdown(a.page))
    elif a.output is None:
        parser.error("an output folder is needed")
    else:
        write_html(a.output / "html")
        if a.pdf:
            write_pdf(a.output, a.output / "glisson-manual.pdf")


if __name__ == "__main__":
    main()
