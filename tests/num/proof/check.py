#!/usr/bin/env python3
"""Re-proves the error bounds of the elementary functions. Usage: check.py FRAMEWORK_NUM_DIRECTORY

1. elementary_tables.h is what its generator writes, every word is the nearest double to what it stands for, and a
   changed digit is noticed;
2. each bound AMBIT_ERROR_* that the code uses is at least what is proved: roundings by Gappa from the statements of the
   C source, which must be there; truncation, table words, reductions and compositions in 400-bit numbers. A claim that
   could be smaller by more than an eighth of its leading power of two is refused too, so that no bound can be changed
   unnoticed;
3. the thresholds between the cases do what they are for.
"""
import subprocess
import sys
from pathlib import Path

from circular import near_bounds, sin_bounds, tan_bounds
from exponential import exp_bound, sinh_cosh_far, tanh_far, tanh_near
from inverse import atan_bounds, inverse_bounds, quotient_bound
from logarithm import log_bound
from mpmath import floor, log, mpf
from power import power_bound
from ranges import check_ranges
from source import Source
from tables import ProofFailure, Tables, check_all, mutations, require


def check_generated(directory, text):
    generator = directory.parents[2] / "scripts" / "tables" / "elementary.py"
    written = subprocess.run([sys.executable, generator], capture_output=True, text=True, check=True).stdout
    require(written == text, "elementary_tables.h is not what scripts/tables/elementary.py writes")


def check_mutations(text):
    for line, changed in mutations(text):
        try:
            check_all(Tables(changed))
        except ProofFailure:
            continue
        raise ProofFailure(f"a changed digit in line {line + 1} of the tables goes unnoticed")


def prove(t, source):
    """name: proved bound of |h + l - f| / |f|"""
    quotient = quotient_bound(t, source)
    angle, angle_near = atan_bounds(t, source)
    proved = {"EXP": exp_bound(t, source), "LOG": log_bound(t, source), "ATAN_NEAR": angle_near}
    proved["SIN"], proved["SIN_FAR"] = sin_bounds(t, source)
    proved["TAN"], proved["TAN_FAR"] = tan_bounds(t, source, proved["SIN"], proved["SIN_FAR"], quotient)
    proved.update(inverse_bounds(t, source, angle))
    sine, cosine = near_bounds(t, source)
    sine_far, proved["COSH"] = sinh_cosh_far(t, source, proved["EXP"], quotient)
    proved["SINH"] = max(sine, sine_far)
    proved["TANH"] = max(tanh_near(sine, cosine, quotient), tanh_far(t, source, proved["EXP"], quotient))
    proved["POWER"] = power_bound(t, source, quotient)
    return proved


def check_claims(t, proved):
    """the claim allows for |h| in place of |f| and for the rounding of its product with |h|"""
    claims = {name[6:] for name in t.value if name.startswith("ERROR_")}
    require(claims == set(proved), f"claims without proof, or proofs without claim: {claims ^ set(proved)}")
    for name in sorted(claims):
        value, claimed = proved[name] * (1 + mpf(2) ** -40), t.error(name)
        eighth = mpf(2) ** (floor(log(claimed, 2)) - 3)
        print(f"{name:9} proved 2^{float(log(value, 2)):.3f} claimed 2^{float(log(claimed, 2)):.3f}")
        require(value <= claimed, f"{name}: the claimed bound is not proved")
        require(value > claimed - eighth, f"{name}: a smaller bound would be proved too")


def main():
    directory = Path(sys.argv[1])
    text = (directory / "elementary_tables.h").read_text()
    try:
        t, source = Tables(text), Source(directory)
        check_all(t)
        check_generated(directory, text)
        check_mutations(text)
        check_ranges(t, source)
        check_claims(t, prove(t, source))
    except ProofFailure as failure:
        sys.exit(f"proof failed: {failure}")


main()
