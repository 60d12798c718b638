#!/usr/bin/env python3
"""Writes framework/kernel/num/elementary_tables.h: every constant of the elementary functions, computed by mpmath at 400 bits.

Usage: elementary.py > framework/kernel/num/elementary_tables.h          (the output is the same on every run)

Every polynomial is a Taylor polynomial, so that no fitted coefficient needs a certificate. The claimed error bounds are
here too: the kernels use them and tests/num/proof/check.py proves them, both from the generated file.
"""
from mpmath import atan, cosh, factorial, floor, log, mp, mpf, nint, pi, sin, sinh, sqrt

mp.prec = 400

# name: (m, e), the claimed bound m/8 2^e of |h + l - f| / |h|. SIN_FAR, TAN_FAR: |sin| >= SIN_LEAST, TAN_LEAST <= |tan|
# <= TAN_MOST; ATAN_NEAR: |atan| <= ATAN_SMALL; POWER: times the exponent
CLAIMS = {"EXP": (15, -66), "LOG": (15, -68), "SIN": (12, -63), "SIN_FAR": (14, -64), "TAN": (10, -62),
          "TAN_FAR": (14, -63), "ATAN": (13, -64), "ATAN_NEAR": (15, -96), "ASIN": (13, -64), "ACOS": (13, -64),
          "SINH": (9, -64), "COSH": (15, -66), "TANH": (13, -64), "POWER": (10, -97)}
RANGES = {"SIN_LEAST": 5 / 128, "TAN_LEAST": 41 / 1024, "TAN_MOST": 24.0, "ATAN_SMALL": 2.0 ** -22}


def nearest(x):
    """The double nearest to x."""
    return float(mpf(x))


def pair(x):
    """x as the sum of two doubles."""
    high = nearest(x)
    return [high, nearest(mpf(x) - mpf(high))]


def on_grid(x, bits):
    """The multiple of 2^-bits nearest to x."""
    return nearest(nint(mpf(x) * mpf(2) ** bits) / mpf(2) ** bits)


def parts(x, widths):
    """x as a sum of doubles of the given widths in bits."""
    result, rest = [], mpf(x)
    for width in widths:
        exponent = int(floor(log(abs(rest), 2))) + 1
        part = nearest(rest) if width == 53 else on_grid(rest, width - exponent)
        result.append(part)
        rest -= mpf(part)
    return result


def sine(n):
    """sin(n pi/128), exact where it is 0 or +-1."""
    exact = {0: 0, 64: 1, 128: 0, 192: -1}
    n %= 256
    return mpf(exact[n]) if n in exact else sin(pi * n / 128)


def log_rows():
    """Rows (c, T, t, 0): c = 1/m rounded to 2^-9, T + t = -ln c, less ln 2 from row `first` on, T of 42 bits."""
    rows, first = [], None
    for j in range(257):
        m = 1 + mpf(j) / 256
        halve = m > sqrt(mpf(2))
        if halve and first is None:
            first = j
        c = mpf(on_grid(1 / m, 9))
        value = mpf(0) if j in (0, 256) else -log(c) - (log(2) if halve else 0)
        high = on_grid(value, 42)
        rows += [float(c), high, nearest(value - mpf(high)), 0.0]
    return rows, first


def constant(name, value):
    print(f"#define AMBIT_{name} {float(value).hex()}")


def table(name, values, per_line=2):
    print(f"static const double ambit_{name}[{len(values)}] = {{")
    for i in range(0, len(values), per_line):
        print("  " + ", ".join(float(v).hex() for v in values[i:i + per_line]) + ",")
    print("};")


def main():
    print("/* elementary_tables.h -- written by scripts/tables/elementary.py, do not edit.\n"
          "** Double-doubles (high, low), proved against the functions by tests/num/proof/check.py. */")
    print("/* clang-format off */")
    print("#ifndef AMBIT_ELEMENTARY_TABLES_H\n#define AMBIT_ELEMENTARY_TABLES_H")
    print("/* claimed bounds of |h + l - f| / |h|; FAR: where SIN_LEAST <= |sin|, TAN_LEAST <= |tan| <= TAN_MOST;\n"
          "** NEAR: where |atan| <= ATAN_SMALL; POWER: times the exponent */")
    for name, (eighths, exponent) in CLAIMS.items():
        constant(f"ERROR_{name}", eighths / 8 * 2.0 ** exponent)
    for name, value in RANGES.items():
        constant(name, value)
    print("/* Taylor coefficients 1/k! and 1/k */")
    for k in range(3, 9):
        constant(f"FACTORIAL_{k}", nearest(1 / factorial(k)))
    for k in range(3, 12):
        constant(f"INVERSE_{k}", nearest(mpf(1) / k))
    print("/* ln2/64 in parts of 36, 36 and 53 bits, its inverse, and 2^(j/64) */")
    for i, part in enumerate(parts(log(2) / 64, [36, 36, 53])):
        constant(f"LN2_64_{i + 1}", part)
    constant("LN2_64_INVERSE", nearest(64 / log(2)))
    table("exp_table", sum((pair(mpf(2) ** (mpf(j) / 64)) for j in range(64)), []))
    print("/* ln2, the high part a multiple of 2^-42; rows (c, -ln c high, low, 0), c near 1/(1 + j/256),\n"
          "** less ln2 from FIRST on */")
    high = on_grid(log(2), 42)
    constant("LN2_HIGH", high)
    constant("LN2_LOW", nearest(log(2) - mpf(high)))
    rows, first = log_rows()
    print(f"#define AMBIT_LOG_FIRST {first}")
    table("log_table", rows, 4)
    print("/* pi/128 in three parts, its inverse, and sin(n pi/128); the cosine is 64 rows further */")
    for i, part in enumerate(parts(pi / 128, [53, 53, 53])):
        constant(f"PI_128_{i + 1}", part)
    constant("PI_128_INVERSE", nearest(128 / pi))
    table("sin_table", sum((pair(sine(n)) for n in range(320)), []))
    print("/* atan(j/32), then pi/2 - atan(j/32), j = 0..32; pi */")
    table("atan_table", sum((pair(atan(mpf(j) / 32)) for j in range(33)), [])
          + sum((pair(pi / 2 - atan(mpf(j) / 32)) for j in range(33)), []))
    high, low = pair(pi)
    constant("PI_HIGH", high)
    constant("PI_LOW", low)
    print("/* sinh(j/64) and cosh(j/64), j = 0..48 */")
    table("sinh_table", sum((pair(sinh(mpf(j) / 64)) + pair(cosh(mpf(j) / 64)) for j in range(49)), []), 4)
    print("#endif")


main()
