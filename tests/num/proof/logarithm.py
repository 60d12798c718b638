"""log."""
from exponential import coefficient_error
from gappa import Model, around, between
from mpmath import log, mpf
from tables import U, require

STEPS = [("p", "r * AMBIT_INVERSE_9 - AMBIT_INVERSE_8"), ("p", "p * r + AMBIT_INVERSE_7"),
         ("p", "p * r - AMBIT_INVERSE_6"), ("p", "p * r + AMBIT_INVERSE_5"), ("p", "p * r - AMBIT_INVERSE_4"),
         ("p", "p * r + AMBIT_INVERSE_3")]
BRACKET = "s.l + (t.l + ((b - 0.5 * sq.l) + (r * sq.h) * p))"


def rounding(t, source, rho, top):
    """of the bracket if the leading term is under `top`"""
    square = rho ** 2 * (1 + 2 * U)
    m = Model(t, source, "log_kernel")
    for name, interval in (("r", around(rho)), ("sq.h", between(0, square)), ("sq.l", around(U * square)),
                           ("b", around(mpf(2) ** -32)), ("s.l", around(U * top)), ("t.l", around(U * top))):
        m.leaf(name, interval)
    for target, expression in STEPS:
        m.step(target, expression)
    m.argument("bracket", BRACKET)
    return m.error("bracket")


def series(t, rho):
    """the tail, the coefficients, and the rounded r^2 in the cubic term"""
    tail = rho ** 10 / 10 / (1 - rho) + rho ** 3 * U / 3 * mpf("1.01")
    return tail + coefficient_error(t, "INVERSE", lambda k: mpf(1) / k, range(3, 10), rho)


def next_to_one(t, source, rho):
    """relative to r where k = 0, ln c = 0: r scaled to [1, 2] in the products, kept in the polynomial"""
    m = Model(t, source, "log_kernel")
    for name, interval in (("r", around(rho)), ("scaled", "[1, 2]"), ("sq.h", between(0, rho ** 2 * (1 + 2 * U))),
                           ("sq.l", around(2 * U * rho)), ("t.l", around(2 * U))):
        m.leaf(name, interval)
    for target, expression in STEPS:
        m.step(target, expression)
    source.demand("log_kernel", BRACKET)
    m.define("bracket", "t.l + ((0 - 0.5 * sq.l) + (scaled * sq.h) * p)")
    return m.error("bracket") + series(t, rho) / rho


def low_words(t, source):
    """rounding of b = n LN2_LOW + t_low, and its error against n ln 2; a = n LN2_HIGH + t_high is exact"""
    n = mpf(1100)
    source.demand("log_kernel", "lanes a = n * AMBIT_LN2_HIGH + th, b = n * AMBIT_LN2_LOW + tl;")
    require(n * t.value["LN2_HIGH"] + 1 < mpf(2) ** 10, "log: the sum of the high words is not exact")
    m = Model(t, source, "log_kernel")
    m.leaf("n", around(n))
    m.leaf("tl", around(mpf(2) ** -43))
    m.argument("b", "n * AMBIT_LN2_LOW + tl")
    require(n * abs(t.value["LN2_LOW"]) + mpf(2) ** -43 < mpf(2) ** -32, "log: low words")
    return m.error("b") + n * abs(t.value["LN2_HIGH"] + t.value["LN2_LOW"] - log(2))


def log_bound(t, source):
    source.demand("log_kernel", "lanes r = (mc.h - 1.0) + mc.l;")
    source.demand("log_kernel", "pair s = fast_two_sum(a, r), t = fast_two_sum(s.h, -0.5 * sq.h);")
    rho = mpf(6) / 2048
    common = rounding(t, source, rho, mpf(1) / 2) + series(t, rho)
    worst, table = mpf(0), mpf(0)
    for j in range(257):
        c, high, low, _ = t.rows["log"][4 * j:4 * j + 4]
        ends = [max(mpf(1), 1 + mpf(2 * j - 1) / 512), min(mpf(2), 1 + mpf(2 * j + 1) / 512)]
        shift = log(2) if j >= t.first else 0
        rest = max(abs(m * c - 1) for m in ends)
        require(rest <= rho and rest < mpf(2) ** -8, f"log row {j}: |r|")
        table = max(table, abs(high + low + (0 if j in (0, 256) else log(c) + shift)))
        if j in (0, 256):
            require(rest <= mpf(1) / 512, f"log row {j}: |r|")
            continue
        require(abs(high) > rest, f"log row {j}: the first sum is not exact")
        least = min(abs(log(m) - shift) for m in ends)
        small = least <= mpf(1) / 64
        error = rounding(t, source, rest, mpf(1) / 2) + series(t, rest) if small else common
        worst = max(worst, (error + table) / least)
    far = rounding(t, source, rho, mpf(1024)) + series(t, rho)
    octaves = (far + table + low_words(t, source)) / (log(2) / 2 - mpf("0.004"))
    one = mpf(1) / 512
    return max(worst, octaves, next_to_one(t, source, one) / (1 - one))
