"""The Python package: what it says of scenes whose answer is known, and the examples of docs/python.md."""
import contextlib
import importlib.util
import io
import math
import os
import re
import shutil
import sys
import tempfile
import unittest
import zipfile

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TREE, "python"))
sys.dont_write_bytecode = True

import ambit  # noqa: E402

DECAY = """
local ambit = require "ambit"
local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
ambit.simulate { decay, initial = { x = ambit.between("0.9", "1.1") }, t = { 0, 1 }, solver = "lohner",
  events = { { name = "half", g = function(s) return s.x - "0.5" end } } }
print(ambit.evaluate { ambit.around(2, "1%") })
"""


class Package(unittest.TestCase):
    def test_results(self):
        found = ambit.run(DECAY)
        self.assertTrue(found.proved)
        self.assertEqual([result.verb for result in found.results], ["simulate", "evaluate"])
        run, evaluated = found.results
        self.assertGreater(len(run.steps), 0)
        for step in run.steps:
            for start in (0.9, 1.0, 1.1):
                self.assertIn(start * math.exp(-step.t.mid), step.x["x"])
                self.assertIn(start * math.exp(-step.span.mid), step.tube["x"])
        self.assertLess(run.steps[-1].x["x"].width, 0.074)
        self.assertTrue(run.events and run.events[0].t.lo <= math.log(2.0) <= run.events[0].t.hi)
        self.assertIn(2.01, evaluated.values[0].value)
        self.assertNotIn(2.03, evaluated.values[0].value)
        self.assertIn("[1.9799, 2.0201]", found.printed)
        arrays = run.arrays()
        self.assertEqual(list(arrays["hi"]["x"]), [step.x["x"].hi for step in run.steps])

    def test_files_and_words(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "scene.lua")
            with open(name, "w", encoding="utf-8") as file:
                file.write("print(arg[1], arg[2])")
            self.assertIn("1.5\tµ", ambit.run(name, 1.5, "µ").printed)

    def test_errors(self):
        with self.assertRaisesRegex(ambit.AmbitError, "standard input:2: wrong"):
            ambit.run("local a\nerror 'wrong'\n")
        found = ambit.run("local a\nerror 'wrong'\n", check=False)
        self.assertEqual((found.exit, found.proved), (1, False))
        with self.assertRaisesRegex(ambit.AmbitError, "cannot run"):
            ambit.run("print(1)\n", command="/nowhere/ambit")
        with self.assertRaises(ambit.AmbitError):
            ambit.run("/nowhere/scene.lua")
        with self.assertRaises(TypeError):
            ambit.run("print(1)\n", sandboxed=True)

    def test_limits_and_sandbox(self):
        found = ambit.run("while true do end\n", time=1)
        self.assertEqual((found.exit, found.code), (5, "stopped.time"))
        found = ambit.run("print(pcall(io.open, '/etc/passwd'))\n", sandbox=True)
        self.assertIn("not in a sandbox", found.printed)

    def test_stream(self):
        kinds = [record["record"] for record in ambit.stream(DECAY)]
        self.assertEqual((kinds[0], kinds[-1]), ("provenance", "end"))
        first = next(ambit.stream("while true do end\n"))  # left off: the scene is ended
        self.assertEqual(first["record"], "provenance")

    def test_plot(self):
        found = ambit.run(DECAY, plot=True)
        self.assertIn("<svg", found._repr_svg_())
        self.assertIsNone(ambit.run("print(1)\n")._repr_svg_())

    def test_examples(self):
        with open(os.path.join(TREE, "docs", "python.md"), encoding="utf-8") as file:
            blocks = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        self.assertGreaterEqual(len(blocks), 3)
        for block in blocks:
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, "docs/python.md", "exec"), {})

    @unittest.skipUnless(importlib.util.find_spec("setuptools") and importlib.util.find_spec("wheel"), "no setuptools")
    def test_wheel(self):
        from setuptools import build_meta
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(os.path.join(TREE, "python"), os.path.join(folder, "python"))
            before = os.getcwd()
            os.chdir(os.path.join(folder, "python"))
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    name = build_meta.build_wheel(folder)
            finally:
                os.chdir(before)
            self.assertTrue(name.endswith("-py3-none-any.whl"))
            self.assertIn("ambit/__init__.py", zipfile.ZipFile(os.path.join(folder, name)).namelist())


if __name__ == "__main__":
    unittest.main()
