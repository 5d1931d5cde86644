"""Numbers and text as LaTeX writes them."""

from __future__ import annotations

import math

NOT_MEASURED = r"\notmeasured{}"


def number(value: float, digits: int = 2) -> str:
    """A number rounded to significant digits; a power of ten if it is very large or small."""
    if not math.isfinite(value):
        return NOT_MEASURED
    if value == 0:
        return r"\num{0}"
    rounded = float(f"{value:.{digits - 1}e}")
    magnitude = math.floor(math.log10(abs(rounded)))
    if -3 <= magnitude < 6:
        return rf"\num{{{rounded:.{max(0, digits - 1 - magnitude)}f}}}"
    return rf"\num{{{value:.{digits - 1}e}}}"


def power(value: float) -> str:
    """A round number as a power of ten, 1e-06 as 10^-6."""
    if not math.isfinite(value) or value == 0:
        return number(value)
    mantissa, exponent = f"{value:.12e}".split("e")
    return rf"\num[print-unity-mantissa=false]{{{float(mantissa):g}e{int(exponent)}}}"


def count(value: float) -> str:
    """A whole number with all its digits."""
    return rf"\num{{{value:.0f}}}"


def quantity(value: float, unit: str, digits: int = 2) -> str:
    """A number with its unit, given as siunitx reads it."""
    plain = number(value, digits)
    return plain.replace(r"\num{", r"\qty{") + f"{{{unit}}}" if plain.startswith(r"\num{") else plain


def duration(seconds: float, digits: int = 2) -> str:
    """A time in the unit that keeps it between 1 and 1000, as far as there is one."""
    for scale, unit in ((1, r"\second"), (1e-3, r"\milli\second"), (1e-6, r"\micro\second")):
        if abs(seconds) >= 0.9995 * scale:
            return quantity(seconds / scale, unit, digits)
    return quantity(seconds, r"\second", digits)


def text(plain: str) -> str:
    """Text of a CSV file, with what LaTeX would read as commands escaped."""
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return "".join(special.get(c, "\\" + c if c in "&%$#_{}" else c) for c in plain)
