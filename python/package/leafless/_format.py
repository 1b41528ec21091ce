"""Formatting of intervals."""

from __future__ import annotations

import math
import re
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext


def outward(lower: float, upper: float, spec: str) -> str:
    """Formats both ends like numbers, rounded outward, so that the text contains the interval."""
    return f"{_rounded(lower, spec, ROUND_FLOOR)} to {_rounded(upper, spec, ROUND_CEILING)}"


def _rounded(value: float, spec: str, rounding: str) -> str:
    found = re.fullmatch(r"(.*?)(\.\d+)?([eEfFgGn%]?)", spec, re.DOTALL)
    # Nothing is rounded without digits and a type, or at infinity. The number itself reports a wrong format.
    if found is None or not (found[2] or found[3]) or math.isinf(value):
        return format(value, spec)
    before, digits, kind = found[1], found[2] or ".6", found[3] or "g"
    # Decimals are exact, and their formatting follows the rounding of the context.
    with localcontext(Context(rounding=rounding)):
        return format(Decimal(value), before + digits + kind)
