"""The rules beside the error bounds: thresholds in the C source, checked against what they are for."""
from mpmath import exp, log, mpf, pi
from tables import U, require

DBL_MAX = mpf(2) ** 1024 * (1 - U)
LEAST_NORMAL = mpf(2) ** -1022


def check_outward_step(t):
    """|l| <= ulp(h)/2 and err: a step of one double is enough if both are below the distance to the neighbour, which is
    ulp/2 below a power of two, where |l| <= ulp/4"""
    for name in t.value:
        if name.startswith("ERROR_") and name != "ERROR_POWER":
            require(t.error(name[6:]) < U / 4, f"{name} is no small part of an ulp")
    require(t.error("POWER") * (mpf(2) ** 31 + 2) < U / 4, "ERROR_POWER is no small part of an ulp")


def check_tiny(source):
    """odd f: |f(x) - x| <= |x|^3/2 is below the distance of x from its neighbours, 2^-53 |x| at least"""
    for function in ("widen_odd", "sinh_at", "atan_at"):
        tiny = mpf(source.number(function, r"tiny = less\(magnitude\(x\), all\((0x1p-\d+)\)\)"))
        require(tiny ** 2 / 2 < U, f"{function}: tiny arguments")
    # exp: 1 + x + ... with the kernel's pair (1, about x): x^2 is far below |x|, and x below the neighbours' distance
    tiny = mpf(source.number("exp_at", r"less\(magnitude\(x\), all\((0x1p-\d+)\)\), all\(0\)"))
    require(tiny < U / 4 and tiny < mpf(2) ** -60 * 2, "exp: tiny arguments")


def check_exponents(source):
    """where the kernels answer, nothing over- or underflows"""
    low = mpf(source.number("exp_at", r"e\.declined = outside\(x, (-\d+), "))
    high = mpf(source.number("exp_at", r"e\.declined = outside\(x, -\d+, (0x[0-9a-f.]+p\d+)\)"))
    require(exp(low) > LEAST_NORMAL * (1 + 4 * U) and exp(high) < DBL_MAX * (1 - 2 * U), "exp: range")
    for function in ("sinh_at", "cosh_at"):
        most = mpf(source.number(function, r"e\.declined = outside\(x, -\d+, (\d+)\)"))
        require(exp(most) / 2 < DBL_MAX / 2 and most < 1400, f"{function}: range")
        require(f"outside(x, -{int(most)}, {int(most)})" in source.body(function), f"{function}: range")
    # beyond: rare's limits, and e^x/2 for sinh and cosh
    require(exp(mpf(source.number("exp_point", r"if \(x < (-\d+)\)"))) < mpf(2) ** -1075, "exp: underflow")
    require(exp(mpf(source.number("exp_point", r"if \(x > (\d+)\)"))) > DBL_MAX, "exp: overflow")
    require(exp(mpf(source.number("half_exp", r"if \(x > (\d+)\)"))) / 2 > DBL_MAX, "sinh: overflow")
    require(exp(-2 * mpf(700)) < U ** 2, "sinh, cosh: half of exp")
    source.demand("half_exp", "widen(y, y.h * (2 * AMBIT_ERROR_EXP))")
    # powers: the result and what is a step above it are normal, or infinite as they should be
    source.demand("power_widen", "bits_less(scaled, all_bits(2)) | bits_less(all_bits(2045), scaled) | "
                  "bits_equal(e, all_bits(0)) | bits_equal(e, all_bits(2047))")


def check_limits(t, source):
    """arguments that are cut off, because the function hardly changes beyond"""
    far = mpf(source.number("atan_at", r"smaller\(magnitude\(x\), all\((0x1p\d+)\)\)"))
    half_pi = pi / 2
    gap = min(abs(half_pi - mpf(float(half_pi))), abs(mpf(float(half_pi)) * (1 + 2 * U) - half_pi))
    require(1 / far + half_pi * t.error("ATAN") < gap, "atan: cut off")
    top = mpf(source.number("tanh_far", r"smaller\(u, all\((\d+)\)\)"))
    rest = 2 / (exp(2 * top) + 1)
    require(rest + t.error("TANH") < U, "tanh: cut off, lower bound")  # above the double below 1
    require(rest > 0 and t.error("TANH") < U, "tanh: cut off, upper bound")
    kernel = source.number("kernel_range", r"all\((0x1p-\d+)\), magnitude")
    require(mpf(kernel) ** 2 * t.error("ATAN") > LEAST_NORMAL, "atan2: range of the kernel")
    most = source.number("kernel_range", r"magnitude\(x\), all\((0x1p\d+)\)")
    require(most == 1 / kernel, "atan2: range of the kernel")
    slender = int(source.number("upper_angle", r"if \(ey - ex < -(\d+)\)"))
    require(mpf(2) ** (-2 * (slender - 2)) < mpf(2) ** -110, "atan2: slender angles")
    require(mpf(2) ** -(slender - 2) < gap / 2, "atan2: steep angles")
    require(int(source.number("upper_angle", r"if \(ey - ex > (\d+)\)")) == slender, "atan2: steep angles")
    require(mpf(2) ** (slender // 2 + 2) < 1 / mpf(kernel), "atan2: scaled arguments")
    # 36 bits at most in a quotient of the reduction of exp
    require(1400 * 64 / log(2) < 2 ** 17, "exp: n")


def check_uses(source):
    """each enclosure steps by the bound that is proved for it, odd functions on the proper side near 0"""
    for function, fragment in (
            ("sin_error", "error_below(h, AMBIT_SIN_LEAST, AMBIT_ERROR_SIN, AMBIT_ERROR_SIN_FAR)"),
            ("tan_error", "near = less(size, all(AMBIT_TAN_LEAST)) | less(all(AMBIT_TAN_MOST), size);"),
            ("tan_error", "choose(near, all(AMBIT_ERROR_TAN), all(AMBIT_ERROR_TAN_FAR))"),
            ("exp_at", "y.h * AMBIT_ERROR_EXP)"), ("log_at", "magnitude(y.h) * AMBIT_ERROR_LOG)"),
            ("sin_of", "widen_odd(x, y, sin_error(y.h), -1)"), ("cos_of", "all(0), sin_error(y.h))"),
            ("tan_of", "widen_odd(x, y, tan_error(y.h), 1)"),
            ("asin_at", "widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_ASIN, 1)"),
            ("acos_at", "widen(y, magnitude(y.h) * AMBIT_ERROR_ACOS)"),
            ("atan_at", "widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_ATAN, -1)"),
            ("atan2_at", "error_below(r.h, AMBIT_ATAN_SMALL, AMBIT_ERROR_ATAN_NEAR, AMBIT_ERROR_ATAN)"),
            ("sinh_at", "widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_SINH, 1)"),
            ("cosh_at", "y.h * AMBIT_ERROR_COSH)"),
            ("tanh_at", "widen_odd(x, y, magnitude(y.h) * AMBIT_ERROR_TANH, -1)"),
            ("exp_point", "widen(y, y.h * AMBIT_ERROR_EXP)"), ("power_widen", "a.y.h * n.error")):
        source.demand(function, fragment)


def check_ranges(t, source):
    check_uses(source)
    check_outward_step(t)
    check_tiny(source)
    check_exponents(source)
    check_limits(t, source)
