"""sin, cos and tan; sinh and cosh near 0: the addition theorem with a table."""
import re
from concurrent.futures import ThreadPoolExecutor

from exponential import coefficient_error, source_near
from gappa import Model, around, between
from mpmath import cosh, factorial, mpf, pi, sin, sinh
from tables import U, require, sine

ODD, EVEN = (3, 5, 7), (4, 6, 8)
CIRCULAR = ("angle_reduce", [
    ("odd", "AMBIT_FACTORIAL_5 - z * AMBIT_FACTORIAL_7", "odd"), ("odd", "odd * z - AMBIT_FACTORIAL_3", "odd"),
    ("even", "z * AMBIT_FACTORIAL_8 - AMBIT_FACTORIAL_6", "even"), ("even", "even * z + AMBIT_FACTORIAL_4", "even"),
    ("even", "even * z - 0.5", "even"), ("odd", "r.l + (r.h * z) * odd", "a.odd"),
    ("even", "z * even - r.h * r.l", "a.even")])
HYPERBOLIC = ("sinh_cosh_near", [
    ("odd", "AMBIT_FACTORIAL_5 + z * AMBIT_FACTORIAL_7", "odd"),
    ("odd", "(r * z) * (odd * z + AMBIT_FACTORIAL_3)", "odd"),
    ("even", "z * AMBIT_FACTORIAL_8 + AMBIT_FACTORIAL_6", "even"), ("even", "even * z + AMBIT_FACTORIAL_4", "even"),
    ("even", "z * (even * z + 0.5)", "even")])
BRACKET = "t.l + (q.l + (s.l + ((c.h * odd + c.l * r) + s.h * even)))"


def addition_rounding(t, source, kind, s, c, rho, low):
    """of the bracket of the addition theorem for table values s, c (high, low)"""
    function, steps = kind
    rest = "r.h" if kind is CIRCULAR else "r"
    m = Model(t, source, function)
    for name, number in zip(("s.h", "s.l", "c.h", "c.l"), (*s, *c)):
        m.value(name, number)
    m.leaf(rest, around(rho))
    m.leaf("q.l", around(U * abs(c[0]) * rho))
    m.leaf("t.l", around(U * (abs(s[0]) + abs(c[0]) * rho)))
    if kind is CIRCULAR:
        m.leaf("r.l", around(low))
    m.step("z", f"{rest} * {rest}")
    for target, expression, assigned in steps:
        m.step(target, expression, assigned)
    source.demand("addition", "pair q = two_product(c.h, r), t = fast_two_sum(s.h, q.h); "
                  f"return fast_two_sum(t.h, {BRACKET});")
    m.define("bracket", re.sub(r"\br\b(?!\.)", rest, BRACKET))
    return m.error("bracket")


def left_out(t, s, c, rho, low):
    """what the bracket leaves out of the theorem: products of low words, tails of the series, second order in r.l"""
    def taylor(powers):
        return coefficient_error(t, "FACTORIAL", lambda k: 1 / factorial(k), powers, rho)
    odd = rho ** 9 / factorial(9) * mpf("1.01") + taylor(ODD) + low * rho ** 2 / 2 + low ** 2
    even = rho ** 10 / factorial(10) * mpf("1.01") + taylor(EVEN) + low * rho ** 3 / 6 + low ** 2
    words = abs(s[1]) * rho ** 2 * mpf("0.51") + abs(c[1]) * (rho ** 3 / 6 * mpf("1.01") + low)
    return words + abs(c[0]) * odd + abs(s[0]) * even


def row_zero(t, source, kind, rho, low):
    """relative to r where S = 0 and C = 1: only `odd` is rounded; r scaled to [1, 2], z = r^2 kept apart"""
    function, steps = kind
    m = Model(t, source, function)
    m.leaf("r.h" if kind is CIRCULAR else "r", "[1, 2]")
    m.leaf("z", between(0, mpf(2) ** -12))
    require(rho ** 2 * (1 + 2 * U) <= mpf(2) ** -12, "row 0: z")
    if kind is CIRCULAR:
        m.leaf("r.l", around(2 * low))
    for target, expression, assigned in steps:
        if target == "odd":
            m.step(target, expression, assigned)
    z = rho ** 2
    tail = rho ** 8 / factorial(9) * mpf("1.01")
    tail += coefficient_error(t, "FACTORIAL", lambda k: 1 / factorial(k), ODD, rho) / rho
    return m.error("odd") + tail + U * z / 6 * mpf("1.01") + low * z / 2 * mpf("1.01")


def angle_reduction(t, source):
    """(largest |r|, its relative error)"""
    step, parts = pi / 128, [t.value[f"PI_128_{k}"] for k in (1, 2, 3)]
    for line in ("pair p = two_product(n, all(AMBIT_PI_128_1)), q = two_product(n, all(AMBIT_PI_128_2));",
                 "pair u = two_sum(x - p.h, -p.l), v = two_sum(u.h, -q.h);", "a.r = r.h,",
                 "a.floor = a.row - shift_right(to_bits(r.h), 63);"):
        source.demand("angle_reduce", line)
    most = source.number("angle_reduce", r"less_equal\(magnitude\(x\), all\((0x1p\d+)\)\)")
    ratio = source.number("angle_reduce", r"less_equal\(magnitude\(n\) \* (0x1p-\d+), magnitude\(r\.h\)\)")
    n = mpf(most) / step + 1
    off = mpf(1) / 2 + n * (abs(t.value["PI_128_INVERSE"] * step - 1) + 2 * U)
    # x - p.h is exact: n = 1 by the grid, both multiples of 2^-59, the difference below 2^-6; n > 1 by Sterbenz
    require(step / 2 * (1 - 4 * U) > mpf(2) ** -7 and step * off < mpf(2) ** -6 and off < 1, "sin: first difference")
    # relative to r, which is scaled to [1, 2]; all is linear in n and r, so that only their ratio counts
    m = Model(t, source, "angle_reduce")
    most_n = 2 / mpf(ratio)
    m.leaf("n", around(most_n))
    m.leaf("v.l", around(2 * U))
    m.leaf("q.l", around(U * most_n * parts[1]))
    m.leaf("u.l", around(U * (2 * (1 + U) + most_n * parts[1] * (1 + 2 * U))))
    m.argument("low", "((u.l + v.l) - q.l) - n * AMBIT_PI_128_3")
    return off * step, m.error("low") + most_n * abs(sum(parts) - step)


def sin_rows(t, source):
    """(absolute error, least |sin|, greatest) of the rows 1 .. 64; (relative error) of row 0"""
    rho, reduction = angle_reduction(t, source)
    low = U * rho * (1 + U)
    for n in range(320):  # every row has the words of one of the first 65, up to signs
        k = min(n % 128, 128 - n % 128)
        require([abs(w) for w in t.pair("sin", n)] == [abs(w) for w in t.pair("sin", k)], f"sin row {n}")

    def row(k):
        s, c = t.pair("sin", k), t.pair("sin", k + 64)
        require(abs(s[0]) > abs(c[0]) * rho * (1 + 2 * U), f"sin row {k}: the first sum is not exact")
        error = addition_rounding(t, source, CIRCULAR, s, c, rho, low) + left_out(t, s, c, rho, low)
        error += abs(sum(s) - sine(k)) + abs(sum(c) - sine(k + 64)) * rho + rho * reduction
        ends = [abs(sin(pi * k / 128 + sign * rho)) for sign in (-1, 1)]
        return error, min(ends), max(ends)

    zero = row_zero(t, source, CIRCULAR, rho, U) + reduction * (1 + mpf(2) ** -10)
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(row, range(1, 65))), zero, sin(rho)


def sin_bounds(t, source):
    """relative errors of sin and cos: everywhere, and where they are at least SIN_LEAST"""
    rows, zero, zero_most = sin_rows(t, source)
    least = t.value["SIN_LEAST"]
    require(zero_most < least, "sin: row 0 reaches SIN_LEAST")
    far = max(error / max(low, least * (1 - mpf(2) ** -50)) for error, low, high in rows if high >= least)
    return max(zero, max(error / low for error, low, _ in rows)), far


def tan_bounds(t, source, near, far, quotient):
    """sin/cos: one of them is small, never both; (everywhere, TAN_LEAST <= |tan| <= TAN_MOST)"""
    least, most, edge = t.value["TAN_LEAST"], t.value["TAN_MOST"], t.value["SIN_LEAST"]
    source.demand("tan_kernel",
                  "pair_divide(addition(s, c, a.r, a.odd, a.even), addition(c, minus, a.r, a.odd, a.even))")
    slack = 1 - mpf(2) ** -50
    require(least * slack / (1 + least ** 2) ** mpf("0.5") >= edge, "tan: sine at TAN_LEAST")
    require(slack / (1 + most ** 2) ** mpf("0.5") >= edge, "tan: cosine at TAN_MOST")
    require(2 * edge ** 2 < 1, "tan: sine and cosine both small")
    room = 1 + mpf(2) ** -40
    return (near + far + quotient) * room, (2 * far + quotient) * room


def near_bounds(t, source):
    """relative errors of (sinh, cosh) for |x| <= NEAR"""
    step, rho = mpf(1) / 64, mpf(2) ** -7
    source.demand("sinh_cosh_near", "r = u - nearest_integer(u * 64.0, &row) * 0x1p-6;")
    source.demand("sinh_cosh_near", "*sine = pair_flip(addition(s, c, r, odd, even), sign); "
                  "*cosine = addition(c, s, r, odd, even);")
    last = int(source_near(source) * 64)
    require(len(t.rows["sinh"]) == 4 * (last + 1), "sinh: rows")

    def row(j):
        s, c = t.pair("sinh", 2 * j), t.pair("sinh", 2 * j + 1)
        table = abs(sum(s) - sinh(j * step)) + abs(sum(c) - cosh(j * step))
        cosine = addition_rounding(t, source, HYPERBOLIC, c, s, rho, 0) + left_out(t, c, s, rho, 0) + table
        cosine /= cosh(max(0, j * step - rho))
        if j == 0:
            return row_zero(t, source, HYPERBOLIC, rho, 0), cosine
        require(s[0] > c[0] * rho * (1 + 2 * U), f"sinh row {j}: the first sum is not exact")
        error = addition_rounding(t, source, HYPERBOLIC, s, c, rho, 0) + left_out(t, s, c, rho, 0) + table
        return error / sinh(j * step - rho), cosine

    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(row, range(last + 1)))
    return max(r[0] for r in rows), max(r[1] for r in rows)
