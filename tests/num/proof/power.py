"""Integer powers: the error of m^k by squaring, for every pattern of bits at once."""
from gappa import Model, around
from mpmath import mpf
from tables import U, require


def step_errors(t, source, low):
    """(rounding, left out, new bound of |l|) of a square and of a product, relative; h in [1, 2], |l| <= low h"""
    square, times = "p.l + (cross + cross)", "p.l + a.y.l * m"
    source.demand("power_square", "pair p = two_product(a.y.h, a.y.h); lanes cross = a.y.h * a.y.l; "
                  f"return (power) {{ {{ p.h, {square} }}, a.k + a.k, a.inexact | to_bits(p.l) }};")
    source.demand("power_times", "pair p = two_product(a.y.h, m); "
                  f"return (power) {{ {{ p.h, {times} }}, a.k, a.inexact | to_bits(p.l) }};")
    m = Model(t, source, "power_square")
    m.leaf("a.y.h", "[1, 2]")
    m.leaf("a.y.l", around(2 * low))
    m.leaf("p.l", around(4 * U))
    m.define("cross", "a.y.h * a.y.l")
    m.define("low", square)
    after = (U + 2 * low) * (1 + 4 * U)
    first = m.error("low"), low ** 2, after
    m = Model(t, source, "power_times")
    m.leaf("m", "[1, 2]")
    m.leaf("a.y.l", around(2 * after))
    m.leaf("p.l", around(4 * U))
    m.define("low", times)
    return first, (m.error("low"), 0, (U + after) * (1 + 4 * U))


def worst_ratio(t, source, top, every, memory):
    """error of m^k / k over all k with highest bit `top`; every: bits between two normalisations, 0 for none"""
    error, low, k = mpf(0), mpf(0), mpf(1)
    for bit in reversed(range(top)):
        if low not in memory:
            memory[low] = step_errors(t, source, low)
        (square, dropped, _), (times, _, after) = memory[low]
        error = (2 * error + square + dropped + times) * (1 + mpf(2) ** -40)
        low, k = after, 2 * k
        require(low < mpf(2) ** -40, "power: low word")
        if every and bit % every == 0:
            low = U
    return error / k


def power_bound(t, source, quotient):
    """relative error / exponent"""
    source.demand("power_kernel", "if (n.size > PLAIN_MOST && bit % 4 == 0)")
    source.demand("power_normal", "pair y = fast_two_sum(a.y.h, a.y.l);")
    source.demand("power_widen", "a.y = pair_divide((pair) { all(1), all(0) }, a.y);")
    require("#define PLAIN_MOST 511 " in source.text, "PLAIN_MOST is not 511: redo the proof")
    source.demand("exponent_of", "AMBIT_ERROR_POWER * ((double)size + (n < 0 ? 2 : 0))")
    require(quotient <= 2 * t.value["ERROR_POWER"], "power: the quotient")
    memory = {}
    plain = max(worst_ratio(t, source, top, 0, memory) for top in range(9))
    return max(plain, *(worst_ratio(t, source, top, 4, memory) for top in range(9, 32)))
