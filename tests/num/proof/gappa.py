"""Runs Gappa on one goal and returns the bound that it proves."""
import re
import subprocess

from mpmath import mpf
from tables import require


def literal(x):
    """A dyadic number as Gappa's exact notation, mantissa b exponent."""
    x = mpf(x)
    return f"{int(x.man) * (-1 if x < 0 else 1)}b{x.exp}"


def around(x):
    """[-x, x], rounded outward to 60 bits if longer."""
    x = mpf(x)
    if x.man.bit_length() <= 60:
        return f"[-{literal(x)}, {literal(x)}]"
    shift = x.exp + x.man.bit_length() - 60
    top = f"{int(x / mpf(2) ** shift) + 1}b{shift}"
    return f"[-{top}, {top}]"


def rounding_error(definitions, ranges, computed, exact):
    """The largest |computed - exact| that round-to-nearest doubles can have; ranges: name -> interval text."""
    text = "@rnd = float<ieee_64, ne>;\n" + definitions
    text += "{ " + " /\\ ".join(f"{name} in {interval}" for name, interval in ranges.items())
    text += f" -> |{computed} - {exact}| in ? }}\n"
    run = subprocess.run(["gappa"], input=text, capture_output=True, text=True, check=False)
    found = re.search(r"in \[0, (\d+)(?:b(-?\d+))?", run.stdout + run.stderr)
    require(found, f"gappa proved nothing:\n{text}\n{run.stdout}{run.stderr}")
    return mpf(int(found.group(1))) * mpf(2) ** int(found.group(2) or 0)
