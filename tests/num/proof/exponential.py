"""exp, and what is made of it away from 0: sinh, cosh, tanh."""
from gappa import Model, around
from mpmath import coth, exp, factorial, log, mpf, sinh
from tables import U, require

STEPS = [("q", "AMBIT_FACTORIAL_6 + r.h * AMBIT_FACTORIAL_7"), ("q", "AMBIT_FACTORIAL_5 + r.h * q"),
         ("q", "AMBIT_FACTORIAL_4 + r.h * q"), ("q", "AMBIT_FACTORIAL_3 + r.h * q"), ("q", "0.5 + r.h * q"),
         ("q", "r.l + (r.h * r.h) * q")]


def coefficient_error(t, name, exact, powers, rho):
    """sum |c_k - exact(k)| rho^k over the constants name_k"""
    return sum(abs(t.value[f"{name}_{k}"] - exact(k)) * rho ** k for k in powers)


def exp_reduction(t, source):
    """(largest |r.h|, absolute error of r) for |x| <= 1400"""
    step, n = log(2) / 64, mpf(2) ** 17
    parts = [t.value[f"LN2_64_{k}"] for k in (1, 2, 3)]
    rho = step * (mpf(1) / 2 + n * (abs(t.value["LN2_64_INVERSE"] * step - 1) + 2 * U))
    require(1400 / step < n, "exp: n")
    source.demand("exp_kernel", "pair a = two_sum(x - n * AMBIT_LN2_64_1, -(n * AMBIT_LN2_64_2));")
    # x - n P1 is exact: both are multiples of 2^-60, as |x| > 2^-8 where n != 0, and the difference is below 2^-7
    require(step / 2 * (1 - 4 * U) > mpf(2) ** -8 and rho + n * abs(parts[1]) < mpf(2) ** -7, "exp: first difference")
    m = Model(t, source, "exp_kernel")
    m.leaf("n", around(n))
    m.leaf("a.l", around(U * rho))
    m.argument("low", "a.l - n * AMBIT_LN2_64_3")
    return rho, n * abs(sum(parts) - step) + m.error("low")


def exp_bound(t, source):
    rho, reduction = exp_reduction(t, source)
    low = U * rho * (1 + 4 * U)
    m = Model(t, source, "exp_kernel")
    for name, interval in (("r.h", around(rho)), ("r.l", around(low)), ("th", "[1, 2]"), ("tl", around(U)),
                           ("p.l", around(2 * U * rho)), ("s.l", around(2 * U))):
        m.leaf(name, interval)
    for target, expression in STEPS:
        m.step(target, expression)
    m.argument("bracket", "s.l + (p.l + (th * q + (tl + tl * r.h)))")
    source.demand("exp_kernel", "pair p = two_product(th, r.h), s = fast_two_sum(th, p.h);")
    table = max(abs(sum(t.pair("exp", j)) - mpf(2) ** (mpf(j) / 64)) for j in range(64))
    series = rho ** 8 / factorial(8) * mpf("1.01")
    series += coefficient_error(t, "FACTORIAL", lambda k: 1 / factorial(k), range(3, 8), rho)
    dropped = low * rho * mpf("1.01") + low ** 2
    total = m.error("bracket") + 2 * (series + dropped) + U * rho ** 2 + 2 * reduction + 2 * table
    return total / exp(-rho)


def halves_rounding(t, source):
    """rounding of s.l + (e.l + i.l), e.h < 2, i.h <= 2: absolute; the parts are at least .99"""
    source.demand("exp_halves", "pair s = two_sum(e.h, i.h);")
    m = Model(t, source, "exp_halves")
    for name in ("s.l", "e.l", "i.l"):
        m.leaf(name, around(4 * U))
    m.argument("bracket", "s.l + (e.l + i.l)")
    most = source.number("exp_halves", r"choose\(bits_less\(\*k, all_bits\((\d+)\)\), "
                         r"power_of_two\(-\(\*k & all_bits\(127\)\) - \(\*k & all_bits\(127\)\)\), all\(0\)\)")
    require(most <= 128, "sinh, cosh: k & 127")
    return m.error("bracket") + 2 * mpf(4) ** -int(most)  # e^-2u left out from k = most on


def sinh_cosh_far(t, source, e, quotient):
    """(sinh for |x| > NEAR, cosh): e and 1/e have relative errors e and e + quotient"""
    near = source_near(source)
    source.demand("exp_halves", "i = pair_divide((pair) { all(1), all(0) }, e);")
    rounding = halves_rounding(t, source)
    cosine = e + quotient + rounding / mpf("0.99")
    sine = e * coth(near) + quotient / (exp(2 * near) - 1) + rounding / mpf("0.99") / (1 - exp(-2 * near))
    return sine * (1 + mpf(2) ** -40), cosine * (1 + mpf(2) ** -40)


def source_near(source):
    source.demand("sinh_kernel", "bits near = less_equal(magnitude(x), all(NEAR));")
    source.demand("tanh_kernel", "bits near = less_equal(magnitude(x), all(NEAR)), sign = sign_bit(x);")
    require("#define NEAR 0.75 " in source.text, "NEAR is not 0.75: redo the proof")
    return mpf(3) / 4


def tanh_far(t, source, e, quotient):
    """(E - 1)/(E + 1), E = e^2u: its derivative by ln E is 1/sinh 2u relative to it"""
    near = source_near(source)
    body = ("lanes scale = power_of_two(k), l = e.l * scale; *less_one = fast_two_sum(e.h * scale, all(-1)), "
            "*plus_one = fast_two_sum(e.h * scale, all(1));")
    source.demand("tanh_far", body)
    source.demand("tanh_kernel", "pair_divide(num, den)")
    m = Model(t, source, "tanh_far")  # in units of E.h, which cancel
    m.leaf("less_one->l".replace("->", "."), around(U))
    m.leaf("l", around(U))
    source.demand("tanh_far", "less_one->l = less_one->l + l, plus_one->l = plus_one->l + l;")
    m.define("sum", "less_one.l + l")
    rounding = m.error("sum") / (1 - exp(-2 * near))
    require(2 * U / (1 - exp(-2 * near)) <= 4 * U, "tanh: low word of the numerator")
    return (e / sinh(2 * near) + 2 * rounding + quotient) * (1 + mpf(2) ** -40)


def tanh_near(sine, cosine, quotient):
    return (sine + cosine + quotient) * (1 + mpf(2) ** -40)
