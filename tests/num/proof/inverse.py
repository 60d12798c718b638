"""Quotients and roots of pairs; atan, and asin, acos, atan2 from it.

Pairs that are divided may have low words up to LOOSE of the high one, arguments of atan up to LEG (one of them: the
other is a double). All is scaled by powers of two, which is exact.
"""
from concurrent.futures import ThreadPoolExecutor

from exponential import coefficient_error
from gappa import Model, around, between
from mpmath import atan, mpf, pi
from tables import U, require

LOOSE, LEG = 4 * U, mpf("1.75") * U
STEPS = [("z", "q * q"), ("w", "z * z")]
POLYNOMIAL = ("(z * AMBIT_INVERSE_5 - AMBIT_INVERSE_3) + "
              "w * ((z * AMBIT_INVERSE_9 - AMBIT_INVERSE_7) - w * AMBIT_INVERSE_11)")


LOW = "rest * (inverse - inverse * z) + (q * z) * p"


def quotient_bound(t, source):
    """relative error of pair_divide; a.h and b.h in [1, 2]"""
    source.demand("pair_divide", "lanes inverse = 1.0 / b.h, q = a.h * inverse; pair v = two_product(q, b.h); "
                  "return fast_two_sum(q, (((a.h - v.h) - v.l) + (a.l - q * b.l)) * inverse);")
    residual = mpf("2.01") * U * 2  # |a.h - q b.h|, as q = (a.h/b.h)(1 + e)(1 + e')
    m = Model(t, source, "pair_divide")
    for name, interval in (("q", "[0.49, 2.01]"), ("v.l", around(2 * U)), ("a.l", around(2 * LOOSE)),
                           ("b.l", around(2 * LOOSE))):
        m.leaf(name, interval)
    m.leaf("a.h - v.h", around(residual + 2 * U))
    m.argument("rest", "((a.h - v.h) - v.l) + (a.l - q * b.l)")
    # rest / b.h instead of rest / (b.h + b.l); |rest| relative to a.h; two roundings and the inverse's
    size = mpf("2.01") * U + 2 * LOOSE * (1 + 4 * U)
    return (m.error("rest") + size * (mpf("3.01") * U + LOOSE * mpf("1.01"))) * (1 + mpf(2) ** -40)


def atan_series(t, top):
    """relative to q: the tail, the coefficients, z and w rounded"""
    powers = (3, 5, 7, 9, 11)
    rounded = U * top ** 2 / 3 * mpf("1.02") + 3 * U * top ** 4
    coefficients = coefficient_error(t, "INVERSE", lambda k: mpf(1) / k, powers, top) / top
    return top ** 12 / 13 + coefficients + rounded


def atan_zero(t, source, top):
    """relative error where c = 0 and the corner is 0: y/x by pair_divide's steps, and the polynomial; q in [1, 2]"""
    delta = mpf("2.02") * U + LEG * mpf("1.01")  # |rest * inverse| relative to q
    m = Model(t, source, "atan_kernel")
    for name, interval in (("q", "[1, 2]"), ("z", between(0, top ** 2 * (1 + 2 * U))),
                           ("w", between(0, top ** 4 * (1 + 8 * U))), ("rest", around(4 * delta)),
                           ("inverse", "[0.49, 1]")):
        m.leaf(name, interval)
    m.step("p", POLYNOMIAL)
    m.step("low", LOW)
    return quotient_bound(t, source) + m.error("low") + atan_series(t, top) + delta * (top ** 4 + 2 * U) * mpf("1.02")


def atan_row(t, source, j, steep):
    """relative error for c = j/32, the corner atan c or pi/2 - atan c not 0. Sizes are relative to a; for the roundings
    a is in [1, 2], which at most doubles them. den: the least a + c b"""
    c, top = mpf(j) / 32, mpf(1) / 64 * (1 + mpf(2) ** -30)
    b, den = min(mpf(1), c + top), 1 + c * max(0, c - top)
    m = Model(t, source, "atan_kernel")
    m.value("c", c)
    for name, size in (("b.l", LEG * b), ("a.l", LEG), ("ca.l", U * c), ("cb.l", U * c * b), ("den.l", U)):
        m.leaf(name, around(2 * size))
    m.step("num_l", "(b.l - c * a.l) - ca.l")
    m.step("den_l", "den.l + (cb.l + (a.l + c * b.l))")
    num_error, den_error = m.error("num_l"), m.error("den_l")
    num_l = LEG * max(b, c) + U * c + num_error
    den_l = U * (1 + c * b) + U * c * b + LEG * max(1, c * b) + den_error
    residual = mpf("2.01") * U * top * den  # |num_h - q den.h|
    m = Model(t, source, "atan_kernel")
    for name, size in (("v.l", 2 * U * top), ("num_l", num_l), ("den_l", den_l),
                       ("num_h - v_h", residual + 2 * U * top)):
        m.leaf(name, around(2 * size))
    m.leaf("q", around(top))
    source.demand("atan_kernel", "lanes rest = ((num_h - v.h) - v.l) + (num_l - q * den_l);")
    m.define("rest", "((num_h - v_h) - v.l) + (num_l - q * den_l)")
    rest, rest_error = residual + num_l + top * den_l, m.error("rest")
    # t against q + rest inverse: the errors above, and inverse for 1/(den.h + den_l)
    division = (num_error + top * den_error + rest_error + rest * (mpf("2.02") * U + den_l / den)) / den * mpf("1.01")
    delta = (rest + rest_error) / den * (1 + 8 * U + den_l)
    corner = t.pair("atan", j + (33 if steep else 0))
    m = Model(t, source, "atan_kernel")
    for name, interval in (("q", around(top)), ("rest", around(2 * (rest + rest_error))),
                           ("inverse", "[0.24, 1]"), ("s.l", around(U))):
        m.leaf(name, interval)
    m.value("corner.l", corner[1])
    for target, expression in STEPS:
        m.step(target, expression)
    m.step("p", POLYNOMIAL)
    m.step("low", LOW)
    m.argument("bracket", "s.l + (corner.l + flip(low, sign))")
    angle = atan(c)
    table = abs(sum(corner) - (pi / 2 - angle if steep else angle))
    series = top ** 13 / 13 + coefficient_error(t, "INVERSE", lambda k: mpf(1) / k, (3, 5, 7, 9, 11), top)
    total = division + m.error("bracket") + table + series + delta * top ** 4 * mpf("1.02") + delta ** 2
    return total / ((pi / 2 - atan(b)) if steep else atan(c - top))


def atan_bounds(t, source):
    """relative errors of the angle in [0, pi/2]: everywhere, and up to ATAN_SMALL"""
    for line in ("pair ca = two_product(c, a.h), cb = two_product(c, b.h);", "pair den = fast_two_sum(a.h, cb.h);",
                 "num_h = b.h - ca.h,",
                 "lanes inverse = 1.0 / den.h, q = num_h * inverse; pair v = two_product(q, den.h);",
                 "pair s = two_sum(corner.h, flip(q, sign));", "* 32.0, &row) * 0x1p-5;"):
        source.demand("atan_kernel", line)
    # b.h - RN(c a.h) is exact by Sterbenz: |b/a - c| <= 1/64 (1 + 2^-50), c >= 1/32; for c = 1/32 the product is exact,
    # and a quotient that rounds to 1/64 goes to row 0
    for j in range(2, 33):
        c, off = mpf(j) / 32, mpf(1) / 64 * (1 + mpf(2) ** -50)
        sterbenz = (c - off) / c * (1 - U) >= mpf(1) / 2 and (c + off) / c * (1 + U) <= 2
        require(sterbenz, f"atan row {j}: first difference")
    which = [(j, False) for j in range(1, 33)] + [(j, True) for j in range(33)]
    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(lambda row: atan_row(t, source, *row), which))
    small = t.value["ATAN_SMALL"] * (1 + mpf(2) ** -20)
    return max(*rows, atan_zero(t, source, mpf(1) / 64 * (1 + mpf(2) ** -40))), atan_zero(t, source, small)


def leg_bound(t, source):
    """relative error of other_leg, sqrt(1 - u^2)"""
    for line in ("pair q = two_product(u, u), w = fast_two_sum(all(1), -q.h);", "w = fast_two_sum(w.h, w.l - q.l);",
                 "pair v = two_product(s, s);", "(pair) { s, rest * half }"):
        source.demand("other_leg", line)
    # 1 - u^2: if q.h >= 1/2 both differences are exact; else w.h >= 1/2
    m = Model(t, source, "other_leg")
    m.leaf("w.l", around(U))
    m.leaf("q.l", around(U / 2))
    m.argument("low", "w.l - q.l")
    square = 2 * m.error("low")
    # sqrt(w) - s = R/(2 s) - R^2/(8 s^3) + ..., R = w - s^2, w.h in [1, 4], s in [1, 2]
    residual = mpf("2.01") * U * 4
    m = Model(t, source, "other_leg")
    for name, interval in (("v.l", around(4 * U)), ("w.l", around(4 * U)), ("half", "[0.24, 0.51]")):
        m.leaf(name, interval)
    m.leaf("w_h - v_h", around(residual + 4 * U))
    source.demand("other_leg", "lanes half = 0.5 / s, rest = ((w.h - v.h) - v.l) + w.l;")
    m.define("rest", "((w_h - v_h) - v.l) + w.l")
    m.define("low", "rest * half")
    size = residual + 4 * U
    # the root is within u of s, w.l is at most u/2 of w.h below 2, and of 2 u above
    low_word = max(1 + mpf("0.5"), 1 + 1 / mpf(2) ** mpf("0.5")) * U * mpf("1.01")
    require(low_word <= LEG, "leg: low word")
    second = size ** 2 / 8 * mpf("1.01")
    return square + m.error("low") + size / 2 * mpf("1.01") * U + second


def inverse_bounds(t, source, angle):
    """relative errors of asin, acos, and of pi - angle (atan2)"""
    leg = leg_bound(t, source)
    source.demand("supplement", "pair s = fast_two_sum(all(AMBIT_PI_HIGH), -a.h); "
                  "s = fast_two_sum(s.h, s.l + (AMBIT_PI_LOW - a.l));")
    m = Model(t, source, "supplement")
    m.leaf("s.l", around(2 * U))
    m.leaf("a.l", around(U))
    m.argument("bracket", "s.l + (AMBIT_PI_LOW - a.l)")
    table = abs(t.value["PI_HIGH"] + t.value["PI_LOW"] - pi)
    room = 1 + mpf(2) ** -40
    moved = mpf(source.number("acos_kernel", r"less\(u\.h, all\((0x1p-\d+)\)\)")) * 2
    # d angle / d ln leg = sin cos <= angle; pi - angle >= pi/2 >= angle
    supplement = angle + (m.error("bracket") + table) / (pi / 2)
    return {"ASIN": (angle + leg) * room, "ACOS": (max(angle, supplement) + leg + moved) * room,
            "ATAN": max(angle, supplement) * room}
