"""Makes the vectors: arguments, correctly rounded values, and what rounding took off them (mpmath, 60 digits); and the tables.

    python3 make.py        writes FUNCTION.txt beside itself, and src/table_of_*.rs
"""

import math
import random
import struct
from pathlib import Path

import mpmath

mpmath.mp.dps = 60
MOST = 1.7976931348623157e308
LEAST = 5e-324


def bits(x):
    return format(struct.unpack("<Q", struct.pack("<d", x))[0], "016x")


def rounded(x):
    """The nearest double, ties to even, denormalised ones included."""
    if x == 0:
        return 0.0
    exponent = max(mpmath.floor(mpmath.log(abs(x), 2)), -1022)
    unit = mpmath.mpf(2) ** (exponent - 52)
    return float(mpmath.nint(x / unit) * unit)


def near(values, random, many=8):
    """Numbers next to those, on either side."""
    found = []
    for value in values:
        for _ in range(many):
            found.append(value * (1 + random.uniform(-1, 1) * 2.0 ** -random.randint(1, 50)))
    return found


def logarithmic(random, low, high, many):
    return [math.exp(random.uniform(math.log(low), math.log(high))) for _ in range(many)]


LEAST_MANTISSA = 0x3FE6000000000000
ENTRIES = 128


def number(of):
    return struct.unpack("<d", struct.pack("<Q", of))[0]


def intervals():
    """Ends of the intervals of mantissas."""
    step = 2**52 // ENTRIES
    return [(number(LEAST_MANTISSA + i * step), number(LEAST_MANTISSA + (i + 1) * step - 1)) for i in range(ENTRIES)]


def logarithms():
    rows = []
    for low, high in intervals():
        c = mpmath.nint(2 / (mpmath.mpf(low) + mpmath.mpf(high)) * 2**11) / 2**11
        # On either side of 1.
        if low <= 1 <= high + 2.0**-52:
            c = mpmath.mpf(1)
        ln_high = mpmath.nint(-mpmath.log(c) * 2**42) / 2**42
        rows.append((float(c), float(ln_high), float(-mpmath.log(c) - ln_high)))
    lines = "".join(f"    [{c!r}, {high!r}, {low!r}],\n" for c, high, low in rows)
    return rows


def powers():
    rows = []
    for i in range(ENTRIES):
        power = mpmath.mpf(2) ** (mpmath.mpf(i) / ENTRIES)
        high = float(power)
        rows.append((high, float(power - mpmath.mpf(high))))
    return rows


def write_table(name, title, rows):
    lines = "".join(f"    [{', '.join(repr(number) for number in row)}],\n" for row in rows)
    text = f"""//! {title} Made by tests/vectors/make.py: do not edit.

/// Bits of the number of an entry.
pub(crate) const ENTRY_BITS: u32 = {ENTRIES.bit_length() - 1};
/// Entries.
pub(crate) const ENTRIES: usize = 1 << ENTRY_BITS;

#[rustfmt::skip]
#[allow(clippy::approx_constant, reason = "entries of a table have no names")]
pub(crate) static TABLE: [[f64; {len(rows[0])}]; ENTRIES] = [
{lines}];
"""
    (Path(__file__).parents[2] / "src" / f"table_of_{name}.rs").write_text(text)


def main():
    write_table("logarithms", "The table of logarithms: c, and −ln c in two parts, for each interval of mantissas.", logarithms())
    write_table("powers", "The table of powers: 2^(i/128) in two parts.", powers())

    # Seeds by name: a function more changes no other.
    def source(name):
        return random.Random("fairflight/elementary/" + name)

    def both(values):
        return values + [-value for value in values]

    def arguments(name):
        draw = source(name)
        if name == "ln":
            lattice = [1 - draw.getrandbits(53) * 2.0**-53 for _ in range(150)]
            everywhere = [draw.uniform(*ends) * 2.0 ** draw.randint(-3, 3) for ends in intervals() for _ in range(2)]
            return everywhere + near([1.0, 2.0, 0.5, math.sqrt(0.5)], draw) + lattice + logarithmic(draw, LEAST, 1e308, 100) + [MOST, LEAST, 2.2250738585072014e-308]
        if name == "ln_1p":
            small = both(logarithmic(draw, 1e-300, 0.9, 120))
            return small + near([-0.5, 1.0, 0.41421356, -0.29289322], draw) + logarithmic(draw, 1, 1e308, 60) + [-1 + 2.0**-53, MOST]
        if name == "exp":
            return both(logarithmic(draw, 1e-20, 700, 140)) + near(both([math.log(2) / 2, 0.5, 709.7, 744.0]), draw, 4) + [709.782712893384, -745.1332191019411, -708.5]
        if name == "exp_m1":
            return both(logarithmic(draw, 1e-300, 1, 60) + logarithmic(draw, 0.1, 60, 100)) + near(both([math.log(2) / 2, 1.5 * math.log(2)]), draw) + [700.0, 709.78]
        far = logarithmic(draw, 1e-10, 1.6e6, 200) + [k * math.pi / 2 for k in range(1, 40)]
        return both(far + [1e7, 1e22, MOST])

    functions = {
        "ln": mpmath.log,
        "ln_1p": lambda x: mpmath.log(1 + x) if abs(x) > 1e-3 else mpmath.log1p(x),
        "exp": mpmath.exp,
        "exp_m1": mpmath.expm1,
        "sin": mpmath.sin,
        "cos": mpmath.cos,
    }
    for name, function in functions.items():
        lines = ["# argument, correctly rounded value, value less that; binary64 in hexadecimal. Made by make.py."]
        for x in arguments(name):
            # Of the greatest arguments all digits count.
            with mpmath.workdps(400 if abs(x) > 1e10 and name in ("sin", "cos") else 60):
                value = function(mpmath.mpf(x))
                if abs(value) > MOST:
                    continue
                nearest = rounded(value)
                lines.append(f"{bits(x)} {bits(nearest)} {bits(float(value - mpmath.mpf(nearest)))}")
        Path(__file__).with_name(name + ".txt").write_text("\n".join(lines) + "\n")


main()
