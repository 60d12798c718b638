#!/usr/bin/env python3
"""Re-proves the error bounds of the elementary functions. Usage: check.py FRAMEWORK_NUM_DIRECTORY

1. elementary_tables.h is what its generator writes, every word is the nearest double to what it stands for, and a
   changed digit is noticed;
2. the lines of the kernels that the proof models are still there;
3. each bound, hand decomposition plus Gappa, is at most the AMBIT_ERROR_* that the code uses.
"""
import re
import subprocess
import sys
from pathlib import Path

from kernels import CODE, bounds
from mpmath import log, mpf
from tables import ProofFailure, Tables, check_all, mutations, require


def check_generated(directory, text):
    generator = directory.parent.parent / "scripts" / "tables" / "elementary.py"
    written = subprocess.run([sys.executable, generator], capture_output=True, text=True, check=True).stdout
    require(written == text, "elementary_tables.h is not what scripts/tables/elementary.py writes")


def check_mutations(text):
    for line, changed in mutations(text):
        try:
            check_all(Tables(changed))
        except ProofFailure:
            continue
        raise ProofFailure(f"a changed digit in line {line + 1} of the tables goes unnoticed")


def check_code(directory):
    source = "".join((directory / f"elementary_{name}.h").read_text() for name in ("kernel", "composed"))
    source = re.sub(r"\s+", " ", source)
    for line in CODE:
        require(line in source, f"the kernels no longer contain `{line}`: redo the proof")


def check_bounds(tables):
    for name, value in bounds(tables).items():
        if name.endswith("_NEAR"):
            continue
        claimed = tables.error(name)
        value *= 1 + mpf(2) ** -40  # |h| for |f|
        print(f"{name:6} proved 2^{float(log(value, 2)):.2f} claimed 2^{float(log(claimed, 2)):.0f}")
        require(value <= claimed, f"{name}: the claimed bound is not proved")


def main():
    directory = Path(sys.argv[1])
    text = (directory / "elementary_tables.h").read_text()
    try:
        tables = Tables(text)
        check_all(tables)
        check_generated(directory, text)
        check_mutations(text)
        check_code(directory)
        check_bounds(tables)
    except ProofFailure as failure:
        sys.exit(f"proof failed: {failure}")


main()
