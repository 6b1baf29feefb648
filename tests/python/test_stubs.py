# SPDX-License-Identifier: GPL-3.0-or-later
"""The stubs are those of the module: every name, every argument; the examples pass a type checker; everything says what it is."""
import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import glisson
from glisson import _core

ROOT = pathlib.Path(os.environ["GLISSON_ROOT"])
STUB = pathlib.Path(glisson.__file__).with_name("_core.pyi")


def has_mypy():
    return subprocess.run([sys.executable, "-c", "import mypy.stubtest"], capture_output=True).returncode == 0


def signature_of(text):
    """[argument] of the signature that begins a docstring of a binding, and whether each has a default."""
    inside = re.match(r"\w+\((.*)\) ->", text.splitlines()[0]).group(1)
    found, depth, word = [], 0, ""
    for c in inside + ",":
        depth += c in "[({<"
        depth -= c in "])}>"
        if c == "," and depth <= 0:
            found.append(word.strip())
            word = ""
        else:
            word += c
    return [(w.split(":")[0].strip(), "=" in w) for w in found if w and w.split(":")[0].strip() not in ("*", "self")]


def arguments_of(node):
    a = node.args
    plain = a.posonlyargs + a.args
    defaults = [False] * (len(plain) - len(a.defaults)) + [True] * len(a.defaults)
    pairs = list(zip(plain, defaults)) + [(k, d is not None) for k, d in zip(a.kwonlyargs, a.kw_defaults)]
    return [(arg.arg, default) for arg, default in pairs if arg.arg != "self"]


class Stubs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tree = ast.parse(STUB.read_text(encoding="utf-8"))

    def test_every_function_has_the_arguments_of_its_stub(self):
        checked = 0
        for node in self.tree.body:
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(arguments_of(node), signature_of(getattr(_core, node.name).__doc__), node.name)
                checked += 1
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                for method in node.body:
                    if not isinstance(method, ast.FunctionDef) or method.decorator_list or method.name == "__init__":
                        continue
                    doc = getattr(getattr(_core, node.name), method.name).__doc__
                    self.assertEqual(arguments_of(method), signature_of(doc), f"{node.name}.{method.name}")
                    checked += 1
        self.assertGreater(checked, 25)

    def test_every_public_name_is_there_and_says_what_it_is(self):
        for name in glisson.__all__:
            thing = getattr(glisson, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if not inspect.isclass(thing):
                continue
            for attribute, value in vars(thing).items():
                if attribute.startswith("_") or not isinstance(value, property):
                    continue
                if attribute in ("name", "value") or attribute == "__members__":
                    continue
                self.assertTrue((value.__doc__ or "").strip(), f"{name}.{attribute}")
        public = {n for n in dir(_core) if not n.startswith("_")}
        self.assertEqual(public - set(glisson.__all__) - {"version"}, set())

    def test_a_marker_says_that_types_are_there(self):
        self.assertTrue(STUB.with_name("py.typed").exists())

    @unittest.skipUnless(has_mypy(), "python3-mypy is not installed")
    def test_stubs_agree_with_the_module(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "glisson", "--concise"], capture_output=True, text=True, cwd=folder)
        # What every class of pybind11 has and no stub says.
        usual = re.compile(r"metaclass differs$|stub does not have \*args argument|__members__ is not present in stub$")
        odd = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("glisson") and not usual.search(line)]
        self.assertEqual(odd, [])
        self.assertNotIn("error:", done.stdout + done.stderr)

    @unittest.skipUnless(has_mypy(), "python3-mypy is not installed")
    def test_a_type_checker_takes_the_examples_and_sees_a_mistake(self):
        examples = sorted((ROOT / "resources/examples/python").glob("*.py"))
        self.assertEqual(len(examples), 3)
        with tempfile.TemporaryDirectory() as folder:
            wrong = pathlib.Path(folder) / "wrong.py"
            wrong.write_text("import glisson\nglisson.run('scene.json', outptu='x')\nglisson.scan(3)\n")
            command = [sys.executable, "-m", "mypy", "--cache-dir", folder + "/cache"]
            good = subprocess.run([*command, *examples], capture_output=True, text=True, cwd=folder)
            bad = subprocess.run([*command, wrong], capture_output=True, text=True, cwd=folder)
        self.assertEqual(good.returncode, 0, good.stdout + good.stderr)
        self.assertIn("outptu", bad.stdout)
        self.assertIn("Found 2 errors", bad.stdout)


if __name__ == "__main__":
    unittest.main()
