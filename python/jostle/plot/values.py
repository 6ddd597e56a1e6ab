"""Numbers as a physicist writes them: the same texts as the page and the program (tests/data/value_texts.json)."""

from __future__ import annotations

import math

MINUS = "\u2212"
ROUNDING = 1e-11  # errors below it, relative to their value, are rounding noise
_SUPERSCRIPTS = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


def superscript(n: int) -> str:
    return str(n).translate(_SUPERSCRIPTS)


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits; beyond 1e6 and below 1e-4 with a power of ten; whole numbers below 1e6
    as they are."""
    if value is None or math.isnan(value):
        return "\u2013"
    if math.isinf(value):
        return "no limit" if value > 0 else f"{MINUS} no limit"
    if value == 0:
        return "0"
    if float(value).is_integer() and abs(value) < 1e6:
        return f"{value:.0f}".replace("-", MINUS)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    if abs(value) >= 1e6 or abs(value) < 1e-4:
        if float(value).is_integer() and "." in mantissa:
            mantissa = mantissa.rstrip("0").rstrip(".")
        return f"{mantissa.replace('-', MINUS)}\u00d710{superscript(power)}"
    text = f"{float(f'{value:.{digits - 1}e}'):.{max(0, digits - 1 - power)}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace("-", MINUS)


def tick_text(value: float) -> str:
    """A place on an even axis, without the noise of its last digits."""
    return number(float(f"{value:.10g}"), 6)


def fixed(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}"
    return (text.removeprefix("-") if float(text) == 0 else text).replace("-", MINUS)


def with_error(value: float, error: float) -> str:
    """"0.5913(12)": the error's first two digits, in units of the value's last digit; the value alone where the error is
    not finite, not above zero, or rounding noise."""
    if not math.isfinite(value) or not math.isfinite(error) or error <= ROUNDING * abs(value):
        return number(value, 5)
    if error > 1e3 * max(abs(value), 1e-300):
        return f"{number(value, 2)} \u00b1 {number(error, 2)}"
    scale = math.floor(math.log10(max(abs(value), error)))
    if scale >= 6 or scale < -4:
        factor = 10.0 ** scale
        return f"{with_error(value / factor, error / factor)}\u00d710{superscript(scale)}"
    decimals = 1 - int(f"{error:.1e}".split("e")[1])
    if decimals <= 0:
        unit = 10 ** -decimals
        value, error = (unit * math.floor(x / unit + 0.5) for x in (value, error))
        return f"{f'{value:.0f}'.replace('-', MINUS)}({error:.0f})"
    shown = f"{error:.{decimals}f}" if error >= 1 else f"{math.floor(error * 10 ** decimals + 0.5):.0f}"
    return f"{f'{value:.{decimals}f}'.replace('-', MINUS)}({shown})"
