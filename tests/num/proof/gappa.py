"""Bounds of rounding errors by Gappa, from the statements of the C source."""
import re
import subprocess

from mpmath import mpf
from tables import require


def literal(x):
    """A dyadic number as Gappa's exact notation, mantissa b exponent."""
    x = mpf(x)
    return f"{int(x.man) * (-1 if x < 0 else 1)}b{x.exp}"


def upward(x):
    """x >= 0 with at most 60 bits, not below x."""
    x = mpf(x)
    if x.man.bit_length() <= 60:
        return x
    shift = x.exp + x.man.bit_length() - 60
    return mpf(int(x / mpf(2) ** shift) + 1) * mpf(2) ** shift


def around(x):
    """[-x, x], outward."""
    return f"[-{literal(upward(x))}, {literal(upward(x))}]"


def between(low, high):
    """[low, high] of two dyadic numbers."""
    return f"[{literal(low)}, {literal(high)}]"


class Model:
    """Statements of one C function in two versions: with every operation rounded to nearest, and exact.

    step() names a statement of the source, which must be there; a name that is assigned twice is renamed. Leaves are
    given as intervals or as values; error() is the largest difference of both versions.
    """

    def __init__(self, tables, source, function):
        self.tables, self.source, self.function = tables, source, function
        self.definitions, self.ranges, self.current, self.count = "", [], {}, 0

    def leaf(self, name, interval):
        self.ranges.append(f"{name.replace('.', '_')} in {interval}")

    def value(self, name, number):
        self.definitions += f"{name.replace('.', '_')} = {literal(number)};\n"

    def translate(self, expression, exact):
        def word(match):
            name = match.group(0)
            if name.startswith("AMBIT_"):
                return literal(self.tables.value[name[6:]])
            if name in self.current:
                return self.current[name][exact]
            return name.replace(".", "_")
        expression = re.sub(r"flip\((\w+), sign\)", r"\1", expression)  # the sign is exact
        return re.sub(r"[A-Za-z_][\w.]*", word, expression)

    def step(self, target, expression, assigned=None):
        """`assigned`: the C name on the left if it is not `target`"""
        self.source.demand(self.function, f"{assigned or target} = {expression}")
        self.define(target, expression)

    def argument(self, target, expression):
        """An expression that is not assigned, such as the argument of a call."""
        self.source.demand(self.function, expression)
        self.define(target, expression)

    def define(self, target, expression):
        """A statement whose place in the source the caller has checked."""
        self.count += 1
        names = f"v{self.count}", f"x{self.count}"
        self.definitions += f"{names[0]} rnd= {self.translate(expression, 0)};\n"
        self.definitions += f"{names[1]} = {self.translate(expression, 1)};\n"
        self.current[target] = names

    def error(self, target):
        names = self.current[target]
        text = "@rnd = float<ieee_64, ne>;\n" + self.definitions
        text += "{ " + " /\\ ".join(self.ranges) + f" -> |{names[0]} - {names[1]}| in ? }}\n"
        run = subprocess.run(["gappa"], input=text, capture_output=True, text=True, check=False)
        found = re.search(r"in \[0, (\d+)(?:b(-?\d+))?", run.stdout + run.stderr)
        require(found, f"gappa proved nothing:\n{text}\n{run.stdout}{run.stderr}")
        return mpf(int(found.group(1))) * mpf(2) ** int(found.group(2) or 0)
