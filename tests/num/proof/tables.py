"""The constants of framework/kernel/num/elementary_tables.h as exact numbers, and the checks of every word of them."""
import re

from mpmath import atan, cosh, factorial, floor, log, mp, mpf, pi, sin, sinh

mp.prec = 400
U = mpf(2) ** -53


class ProofFailure(Exception):
    pass


def require(condition, what):
    if not condition:
        raise ProofFailure(what)


def half_ulp(x):
    return mpf(2) ** (floor(log(abs(x), 2)) - 53) if x else mpf(0)


class Tables:
    def __init__(self, text):
        constants = re.findall(r"#define AMBIT_(\w+) (-?0x[0-9a-f.]+p[+-]?\d+)", text)
        self.value = {name: mpf(float.fromhex(value)) for name, value in constants}
        self.first = int(re.search(r"#define AMBIT_LOG_FIRST (\d+)", text).group(1))
        self.rows = {}
        for name, count, body in re.findall(r"ambit_(\w+)_table\[(\d+)\] = \{(.*?)\};", text, re.S):
            words = [mpf(float.fromhex(w)) for w in body.replace("\n", " ").split(",") if w.strip()]
            require(len(words) == int(count), f"{name}: {len(words)} words of {count}")
            self.rows[name] = words

    def error(self, name):
        return self.value["ERROR_" + name]

    def pair(self, name, i):
        return self.rows[name][2 * i], self.rows[name][2 * i + 1]


def check_pair(high, low, exact, what):
    """high and low are the nearest doubles: not a bit of either can change."""
    if exact == 0:
        require(high == 0 and low == 0, what)
        return
    require(abs(high - exact) <= half_ulp(high), what + ": high word")
    rest = exact - high
    require(low == 0 if rest == 0 else low != 0 and abs(low - rest) <= half_ulp(low), what + ": low word")


def check_sum(parts, exact, what):
    """Each part but the last leaves a rest smaller than itself; the last is nearest."""
    require(abs(sum(parts) - exact) <= half_ulp(parts[-1]), what)


def sine(n):
    n %= 256
    return {0: mpf(0), 64: mpf(1), 128: mpf(0), 192: mpf(-1)}.get(n, sin(pi * n / 128))


def check_log_row(t, j):
    c, high, low, unused = t.rows["log"][4 * j:4 * j + 4]
    value = mpf(0) if j in (0, 256) else -log(c) - (log(2) if j >= t.first else 0)
    m = 1 + mpf(j) / 256
    require(abs(c * m - 1) <= mpf(2) ** -9 and c * 512 == floor(c * 512), f"log row {j}: c")
    require(high * 2 ** 42 == floor(high * 2 ** 42) and abs(value - high) <= mpf(2) ** -43, f"log row {j}: high word")
    require(unused == 0 and abs(low - (value - high)) <= half_ulp(low), f"log row {j}: low word")


def check_all(t):
    """Every word of the file against its definition."""
    for k in range(3, 9):
        require(abs(t.value[f"FACTORIAL_{k}"] - 1 / factorial(k)) <= half_ulp(t.value[f"FACTORIAL_{k}"]), f"1/{k}!")
    for k in range(3, 12):
        require(abs(t.value[f"INVERSE_{k}"] - mpf(1) / k) <= half_ulp(t.value[f"INVERSE_{k}"]), f"1/{k}")
    for name, step in (("LN2_64", log(2) / 64), ("PI_128", pi / 128)):
        check_sum([t.value[f"{name}_{i}"] for i in (1, 2, 3)], step, name)
        inverse = t.value[name + "_INVERSE"]
        require(abs(inverse - 1 / step) <= half_ulp(inverse), name + " inverse")
    for part in (1, 2):  # 36 bits, so that products with 17-bit integers are exact
        value = t.value[f"LN2_64_{part}"]
        scaled = value * mpf(2) ** (35 - floor(log(value, 2)))
        require(scaled == floor(scaled), f"LN2_64_{part} is wider than 36 bits")
    check_pair(t.value["PI_HIGH"], t.value["PI_LOW"], pi, "pi")
    ln2 = t.value["LN2_HIGH"]
    require(ln2 * 2 ** 42 == floor(ln2 * 2 ** 42), "ln2: high word")
    check_sum([ln2, t.value["LN2_LOW"]], log(2), "ln2")
    for j in range(64):
        check_pair(*t.pair("exp", j), mpf(2) ** (mpf(j) / 64), f"exp row {j}")
    for j in range(257):
        check_log_row(t, j)
    for n in range(320):
        check_pair(*t.pair("sin", n), sine(n), f"sin row {n}")
    for j in range(33):
        check_pair(*t.pair("atan", j), atan(mpf(j) / 32), f"atan row {j}")
        check_pair(*t.pair("atan", 33 + j), pi / 2 - atan(mpf(j) / 32), f"atan row {33 + j}")
    for j in range(49):
        check_pair(*t.pair("sinh", 2 * j), sinh(mpf(j) / 64), f"sinh row {j}")
        check_pair(*t.pair("sinh", 2 * j + 1), cosh(mpf(j) / 64), f"cosh row {j}")


def mutations(text):
    """The same file with one hexadecimal digit changed: in every constant that stands for a number and in some rows of
    every table. Bounds and thresholds are not numbers to be hit; the proof judges them."""
    for match in re.finditer(r"0x1\.([0-9a-f]{13})p", text):
        line = text.count("\n", 0, match.start())
        start = text[text.rfind("\n", 0, match.start()) + 1:match.start()]
        if re.search(r"ERROR_|_LEAST|_MOST|_SMALL", start):
            continue
        if line % 13 == 0 or "#define" in start:
            digit = match.end(1) - 1
            yield line, text[:digit] + ("1" if text[digit] != "1" else "3") + text[digit + 1:]
