# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual's pages: every diagnostic has its advice, every include and link leads somewhere, HTML and PDF can be built."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["GLISSON_ROOT"])
BUILD = ROOT / "resources/manual/build.py"
spec = importlib.util.spec_from_file_location("manual_build", BUILD)
manual = importlib.util.module_from_spec(spec)
spec.loader.exec_module(manual)


class Messages(unittest.TestCase):
    def test_every_code_is_found(self):
        """As many as the compiler sees, so that none is lost by the way the table is read."""
        lines = [line for line in (ROOT / "core/base/diagnostics.def").read_text(encoding="utf-8").splitlines()
                 if line.startswith("GLISSON_DIAGNOSTIC(")]
        self.assertEqual(len(manual.diagnostics()), len(lines))
        self.assertGreater(len(lines), 90)

    def test_every_code_has_advice_and_every_advice_a_code(self):
        codes = {code for code, _, _, _ in manual.diagnostics()}
        self.assertEqual(codes, set(manual.advice()))
        for code, text in manual.advice().items():
            self.assertTrue(text.endswith((".", ")")), f"{code}: {text}")

    def test_a_code_without_advice_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "clone"
            for part in ("resources/manual", "core/base"):
                shutil.copytree(ROOT / part, copy / part)
            advice = copy / "resources/manual/messages.advice"
            advice.write_text(advice.read_text(encoding="utf-8").replace("few-voxels-empty:", "few-voxels-emptied:"), encoding="utf-8")
            done = subprocess.run([sys.executable, copy / "resources/manual/build.py", "--messages"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn("few-voxels-empty", done.stderr)


class Pages(unittest.TestCase):
    def test_every_page_is_listed_and_its_includes_are_there(self):
        listed = {name for name, _ in manual.pages()}
        there = {p.relative_to(manual.HERE).as_posix() for p in manual.HERE.rglob("*.md")}
        self.assertEqual(listed, there)
        for name in listed:
            self.assertTrue(manual.markdown(name).startswith("# "), name)

    def test_glossary_has_some_fifty_terms(self):
        self.assertGreaterEqual(len(re.findall(r"^:   ", manual.markdown("glossary.md"), re.M)), 50)

    def test_the_table_of_exports_is_that_of_the_program(self):
        told = re.findall(r"^\| `([a-z][\w-]*)` \|", manual.markdown("task-export.md"), re.M)
        there = re.findall(r'^    \{"([\w-]+)", "', (ROOT / "core/pipeline/export.cpp").read_text(encoding="utf-8"), re.M)
        self.assertEqual(sorted(told), sorted(there))
        self.assertGreater(len(there), 10)

    @unittest.skipUnless(shutil.which("pandoc"), "pandoc is not installed")
    def test_html_is_built_and_all_links_lead_somewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, BUILD, folder], check=True)
            html = {p.name for p in pathlib.Path(folder).rglob("*.html")}
            self.assertEqual(html, {pathlib.Path(name).stem + ".html" for name, _ in manual.pages()})
            text = (pathlib.Path(folder) / "html/theory.html").read_text(encoding="utf-8")
            self.assertIn("<math", text)
            self.assertIn("sparse meshless models", text.lower())

    @unittest.skipUnless(shutil.which("pandoc") and shutil.which("weasyprint") and shutil.which("pdftotext"),
                         "pandoc, weasyprint or poppler-utils is not installed")
    def test_pdf_holds_every_page(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, BUILD, folder, "--pdf"], check=True)
            text = subprocess.run(["pdftotext", pathlib.Path(folder) / "glisson-manual.pdf", "-"], capture_output=True, text=True,
                                  check=True).stdout
            squeezed = re.sub(r"\s+", " ", text)
            for name, _ in manual.pages():
                self.assertIn(re.sub(r"[µ`]", "", manual.title_of(name))[:40], squeezed, name)


if __name__ == "__main__":
    unittest.main()
