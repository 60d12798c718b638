"""Bounds of |h + l - f| / |h| for the kernels of framework/num/elementary_kernel.h and elementary_composed.h.

Each function below follows its section of docs/numerics/elementary.md: what the kernel leaves out is summed by hand
from the constants, the rounding of the low-order bracket comes from Gappa. CODE lists the lines that are modelled; the
kernels must contain them.
"""
from concurrent.futures import ThreadPoolExecutor

from gappa import around, literal, rounding_error
from mpmath import atan, cosh, coth, exp, factorial, floor, log, mpf, pi, sin, sinh, tanh
from tables import U, require, sine

CODE = [
    "lanes q = AMBIT_FACTORIAL_6 + r.h * AMBIT_FACTORIAL_7;", "q = AMBIT_FACTORIAL_5 + r.h * q;",
    "q = AMBIT_FACTORIAL_4 + r.h * q;", "q = AMBIT_FACTORIAL_3 + r.h * q;", "q = 0.5 + r.h * q;",
    "q = r.l + (r.h * r.h) * q;",
    "return fast_two_sum(s.h, s.l + (p.l + (th * q + (tl + tl * r.h))));",
    "lanes p = r * AMBIT_INVERSE_9 - AMBIT_INVERSE_8;", "p = p * r + AMBIT_INVERSE_7;", "p = p * r - AMBIT_INVERSE_6;",
    "p = p * r + AMBIT_INVERSE_5;", "p = p * r - AMBIT_INVERSE_4;", "p = p * r + AMBIT_INVERSE_3;",
    "return fast_two_sum(t.h, s.l + (t.l + ((b - 0.5 * sq.l) + (r * sq.h) * p)));",
    "return fast_two_sum(t.h, t.l + (q.l + (s.l + ((c.h * odd + c.l * r) + s.h * even))));",
    "pair r = fast_two_sum(v.h, ((u.l + v.l) - q.l) - n * AMBIT_PI_128_3);",
    "a.declined = ~(less_equal(magnitude(x), all(0x1p39)) & less_equal(magnitude(n) * 0x1p-92, magnitude(r.h)));",
    "lanes odd = AMBIT_FACTORIAL_5 - z * AMBIT_FACTORIAL_7;", "odd = odd * z - AMBIT_FACTORIAL_3;",
    "lanes even = z * AMBIT_FACTORIAL_8 - AMBIT_FACTORIAL_6;", "even = even * z + AMBIT_FACTORIAL_4;",
    "even = even * z - 0.5;",
    "a.r = r.h, a.odd = r.l + (r.h * z) * odd, a.even = z * even - r.h * r.l;",
    "lanes p = AMBIT_INVERSE_9 - z * AMBIT_INVERSE_11;", "p = p * z - AMBIT_INVERSE_7;", "p = p * z + AMBIT_INVERSE_5;",
    "p = p * z - AMBIT_INVERSE_3;", "t.l = t.l + (t.h * z) * p;", "return fast_two_sum(s.h, s.l + (corner.l + t.l));",
    "lanes odd = AMBIT_FACTORIAL_5 + z * AMBIT_FACTORIAL_7;", "odd = (r * z) * (odd * z + AMBIT_FACTORIAL_3);",
    "lanes even = z * AMBIT_FACTORIAL_8 + AMBIT_FACTORIAL_6;", "even = z * (even * z + 0.5);", "#define NEAR 0.75",
]


def rounded(name, exact_name, expression, exact):
    """A Gappa definition with every operation rounded, beside the exact one."""
    return f"{name} rnd= {expression};\n{exact_name} = {exact};\n"


def coefficient_error(t, name, terms, rho):
    """sum |c_k - exact| rho^power over terms {k: power}"""
    exact = (lambda k: 1 / factorial(k)) if name == "FACTORIAL" else (lambda k: mpf(1) / k)
    return sum(abs(t.value[f"{name}_{k}"] - exact(k)) * rho ** power for k, power in terms.items())


def f(t, k):
    return literal(t.value[f"FACTORIAL_{k}"])


def i(t, k):
    return literal(t.value[f"INVERSE_{k}"])


def exp_bound(t):
    step, n = log(2) / 64, mpf(2) ** 17  # |x| <= 1400
    inverse = t.value["LN2_64_INVERSE"]
    rho = step * (mpf(1) / 2 + n * (abs(inverse * step - 1) + 2 * U))
    parts = [t.value[f"LN2_64_{k}"] for k in (1, 2, 3)]
    low = U * rho * (1 + 4 * U)
    reduction = n * abs(sum(parts) - step) + 3 * U * (n * parts[2] + U * rho)
    horner = f"({f(t, 4)} + r * ({f(t, 5)} + r * ({f(t, 6)} + r * {f(t, 7)})))"
    poly = f"rl + (r * r) * (0.5 + r * ({f(t, 3)} + r * {horner}))"
    bracket = "sl + (pl + (th * {q} + (tl + tl * r)))"
    text = rounded("q", "Q", poly, poly) + rounded("b", "B", bracket.format(q="q"), bracket.format(q="Q"))
    ranges = {"r": around(rho), "rl": around(low), "th": "[1, 2]", "tl": around(U), "pl": around(2 * U * rho)}
    gappa = rounding_error(text, {**ranges, "sl": around(2 * U)}, "b", "B")
    table = max(abs(sum(t.pair("exp", j)) - mpf(2) ** (mpf(j) / 64)) for j in range(64))
    series = rho ** 8 / factorial(8) * mpf("1.01") + coefficient_error(t, "FACTORIAL", {k: k for k in range(3, 8)}, rho)
    dropped = low * rho * mpf("1.01") + low ** 2
    return (gappa + 2 * (series + dropped) + U * rho ** 2 + 2 * reduction + 2 * table) / exp(-rho)


def log_poly(t):
    text, signs = i(t, 9), {8: "-", 7: "+", 6: "-", 5: "+", 4: "-", 3: "+"}
    for k, sign in signs.items():
        text = f"({text} * r {sign} {i(t, k)})"
    return text


def log_gappa(t, rho, top):
    """rounding of the bracket if the leading term is under `top`"""
    p, square = log_poly(t), rho ** 2 * (1 + 2 * U)
    text = rounded("p", "P", p, p)
    bracket = "sl + (tl + ((a - 0.5 * ql) + (r * q) * {p}))"
    text += rounded("b", "B", bracket.format(p="p"), bracket.format(p="P"))
    return rounding_error(text, {"r": around(rho), "q": f"[0, {literal(square)}]", "ql": around(U * square),
                                 "a": around(mpf(2) ** -33), "sl": around(U * top), "tl": around(U * top)}, "b", "B")


def log_series(t, rho):
    """the tail, the coefficients, and q for r^2 in the cubic term"""
    tail = rho ** 10 / 10 / (1 - rho) + rho ** 3 * U / 3 * mpf("1.01")
    return tail + coefficient_error(t, "INVERSE", {k: k for k in range(3, 10)}, rho)


def log_bound(t):
    rho = mpf(6) / 2048
    common = log_gappa(t, rho, mpf(1) / 2) + log_series(t, rho)
    worst, table = mpf(0), mpf(0)
    for j in range(257):
        c, high, low, _ = t.rows["log"][4 * j:4 * j + 4]
        ends = [max(mpf(1), 1 + mpf(2 * j - 1) / 512), min(mpf(2), 1 + mpf(2 * j + 1) / 512)]
        shift = log(2) if j >= t.first else 0
        rest = max(abs(m * c - 1) for m in ends)
        require(rest <= rho and rest < mpf(2) ** -8, f"log row {j}: |r|")
        table = max(table, abs(high + low + (0 if j in (0, 256) else log(c) + shift)))
        if j in (0, 256):
            continue
        require(abs(high) > rest, f"log row {j}: the first sum is not exact")
        least = min(abs(log(m) - shift) for m in ends)
        error = common if least > mpf(1) / 64 else log_gappa(t, rest, mpf(1) / 2) + log_series(t, rest)
        worst = max(worst, (error + table) / least)
    ln2 = abs(t.value["LN2_HIGH"] + t.value["LN2_LOW"] - log(2))
    far = log_gappa(t, rho, mpf(1024)) + log_series(t, rho)
    octaves = (far + table + 1100 * ln2 + 2 * U * mpf(2) ** -33) / (log(2) / 2 - mpf("0.004"))
    r0 = mpf(1) / 512  # x next to 1: relative to r
    return max(worst, octaves, 8 * U * r0 ** 2 / 3 + r0 ** 9 / 10 + 4 * U ** 2)


def addition_gappa(t, s, c, rho, low, trigonometric):
    """rounding of the bracket of the addition theorem for table values s, c (high, low)"""
    odd, even = ("-", "-") if trigonometric else ("+", "+")
    poly = f"(({f(t, 5)} {odd} z * {f(t, 7)}) * z {odd} {f(t, 3)})"
    pole = f"((z * {f(t, 8)} {even} {f(t, 6)}) * z + {f(t, 4)})"
    if trigonometric:
        odd_text, even_text = f"rl + (r * z) * {poly}", f"z * ({pole} * z - 0.5) - r * rl"
    else:
        odd_text, even_text = f"(r * z) * {poly}", f"z * ({pole} * z + 0.5)"
    text = "z rnd= r * r;\nZ = r * r;\n"
    text += rounded("o", "O", odd_text, odd_text.replace("z", "Z"))
    text += rounded("e", "E", even_text, even_text.replace("z", "Z"))
    bracket = "tl + (ql + (sl + ((ch * {o} + cl * r) + sh * {e})))"
    values = {"ch": c[0], "cl": c[1], "sh": s[0], "sl": s[1]}
    text = "".join(f"{k} = {literal(v)};\n" for k, v in values.items()) + text
    text += rounded("b", "B", bracket.format(o="o", e="e"), bracket.format(o="O", e="E"))
    ranges = {"r": around(rho), "ql": around(U * abs(c[0]) * rho), "tl": around(U * (abs(s[0]) + abs(c[0]) * rho))}
    if trigonometric:
        ranges["rl"] = around(low)
    return rounding_error(text, ranges, "b", "B")


def left_out(t, s, c, rho, low):
    """what the bracket leaves out of the theorem: products of low words, tails of the series, second order in r.l"""
    odd = rho ** 9 / factorial(9) * mpf("1.01") + coefficient_error(t, "FACTORIAL", {3: 3, 5: 5, 7: 7}, rho)
    even = rho ** 10 / factorial(10) * mpf("1.01") + coefficient_error(t, "FACTORIAL", {4: 4, 6: 6, 8: 8}, rho)
    odd += low * rho ** 2 / 2 + low ** 2
    even += low * rho ** 3 / 6 + low ** 2
    words = abs(s[1]) * rho ** 2 * mpf("0.51") + abs(c[1]) * (rho ** 3 / 6 * mpf("1.01") + low)
    return words + abs(c[0]) * odd + abs(s[0]) * even


def row_zero(rho, low_relative):
    """relative to r where S = 0: roundings of odd (at most 8, of size z/6, and one of r.l) and the tail"""
    z = rho ** 2
    return 9 * U * z / 6 + U * low_relative + rho ** 8 / factorial(9) * mpf("1.01") + low_relative * z / 2


def angle_reduction(t):
    """(largest |r|, its relative error)"""
    step, parts = pi / 128, [t.value[f"PI_128_{k}"] for k in (1, 2, 3)]
    n = mpf(2) ** 39 / step + 1
    rho = step * (mpf(1) / 2 + n * (abs(t.value["PI_128_INVERSE"] * step - 1) + 2 * U))
    # low = ((u.l + v.l) - q.l) - n P3: four roundings of terms bounded by n (per_n) and |v.h| (per_r)
    per_n = U * parts[1] * (1 + 3 * U) + U * abs(parts[1]) + abs(parts[2])
    per_r = 2 * U * (1 + 3 * U)
    error_n = abs(sum(parts) - step) + 4 * U * per_n * (1 + 8 * U)
    error_r = 4 * U * per_r * (1 + 8 * U)
    return rho, error_n / mpf(2) ** -92 * (1 + 4 * U) + error_r


def sin_bound(t):
    rho, reduction = angle_reduction(t)
    require(rho < mpf(2) ** mpf("-6.33"), "sin: |r|")
    low = U * rho * (1 + U)
    for n in range(320):  # every row has the words of one of the first 65, up to signs
        k = min(n % 128, 128 - n % 128)
        require([abs(w) for w in t.pair("sin", n)] == [abs(w) for w in t.pair("sin", k)], f"sin row {n}")

    def row(k):
        s, c = t.pair("sin", k), t.pair("sin", k + 64)
        if k == 0:
            return row_zero(rho, U) + reduction
        require(abs(s[0]) > abs(c[0]) * rho * (1 + 2 * U), f"sin row {k}: the first sum is not exact")
        error = addition_gappa(t, s, c, rho, low, True) + left_out(t, s, c, rho, low)
        error += abs(sum(s) - sine(k)) + abs(sum(c) - sine(k + 64)) * rho + rho * reduction
        return error / min(abs(sin(pi * k / 128 + sign * rho)) for sign in (-1, 1))

    with ThreadPoolExecutor(2) as pool:
        return max(pool.map(row, range(65)))


def near_bounds(t):
    """(sinh, cosh) for |x| <= 3/4"""
    rho = mpf(2) ** -7

    def row(j):
        s, c = t.pair("sinh", 2 * j), t.pair("sinh", 2 * j + 1)
        table = abs(sum(s) - sinh(mpf(j) / 64)) + abs(sum(c) - cosh(mpf(j) / 64))
        cosine = addition_gappa(t, c, s, rho, 0, False) + left_out(t, c, s, rho, 0) + table
        cosine /= cosh(max(0, mpf(j) / 64 - rho))
        if j == 0:
            return row_zero(rho, 0), cosine
        require(s[0] > c[0] * rho * (1 + 2 * U), f"sinh row {j}: the first sum is not exact")
        sine_error = addition_gappa(t, s, c, rho, 0, False) + left_out(t, s, c, rho, 0) + table
        return sine_error / sinh(mpf(j) / 64 - rho), cosine

    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(row, range(49)))
    return max(r[0] for r in rows), max(r[1] for r in rows)


def atan_bound(t):
    top = mpf(2) ** -6 * (1 + mpf(2) ** -40)
    low = U * top * (1 + 4 * U)
    poly = f"(({i(t, 9)} - z * {i(t, 11)}) * z - {i(t, 7)})"
    poly = f"tl + (th * z) * (({poly} * z + {i(t, 5)}) * z - {i(t, 3)})"
    text = "z rnd= th * th;\nZ = th * th;\n" + rounded("l", "L", poly, poly.replace("z", "Z"))
    text += rounded("b", "B", "sl + (cl + l)", "sl + (cl + L)")
    gappa = rounding_error(text, {"th": around(top), "tl": around(low), "sl": around(2 * U), "cl": around(U)}, "b", "B")
    table = mpf(0)
    for j in range(33):
        angle = atan(mpf(j) / 32)
        table = max(table, abs(sum(t.pair("atan", j)) - angle), abs(sum(t.pair("atan", 33 + j)) - (pi / 2 - angle)))
    series = top ** 13 / 13 + coefficient_error(t, "INVERSE", {k: k for k in (3, 5, 7, 9, 11)}, top)
    quotient = 32 * U ** 2  # of the double-double t = (b - c a)/(a + c b)
    rows = (gappa + series + low * top ** 2 * mpf("1.01") + quotient + table) / atan(mpf(1) / 64)
    # where the corner is 0, relative to t: 7 roundings of size z/3, t.l z left out, the tail
    first = 7 * U * top ** 2 / 3 + U * top ** 2 * mpf("1.01") + top ** 12 / 13 + 64 * U ** 2
    return max(rows, first)


def composed_bounds(bound):
    """Condition of each composition times the bounds of its parts; 2^-98 for its double-double steps."""
    step, near = mpf(2) ** -98, mpf(3) / 4
    e, q = bound["EXP"], 2 / (exp(2 * near) + 1)
    return {
        "TAN": bound["SIN"] * mpf("2.001") + step,
        "ASIN": bound["ATAN"] + step, "ACOS": bound["ATAN"] + step,
        "SINH": max(bound["SINH_NEAR"], e * coth(near) * mpf("1.001") + step),
        "COSH": e * mpf("1.001") + step,
        "TANH": max((bound["SINH_NEAR"] + bound["COSH_NEAR"]) * mpf("1.001"), e * q / tanh(near) * mpf("1.001")) + step,
    }


def bounds(t):
    result = {"EXP": exp_bound(t), "LOG": log_bound(t), "SIN": sin_bound(t), "ATAN": atan_bound(t)}
    result["SINH_NEAR"], result["COSH_NEAR"] = near_bounds(t)
    result.update(composed_bounds(result))
    return result
