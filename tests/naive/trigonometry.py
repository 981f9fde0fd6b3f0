"""Sine and cosine to sixty digits, by their series."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

DIGITS = 60


def _arctan_of_inverse(n: int) -> Decimal:
    """arctan(1/n) by its series."""
    power = total = Decimal(1) / n
    k = 1
    while abs(power) > Decimal(10) ** -(DIGITS + 5):
        power /= -n * n
        k += 2
        total += power / k
    return total


with localcontext() as _context:
    _context.prec = DIGITS + 10
    PI = 4 * (4 * _arctan_of_inverse(5) - _arctan_of_inverse(239))  # Machin


def cos_sin(angle: float) -> tuple[Decimal, Decimal]:
    """Cosine and sine of exactly this double [rad]; sixty digits less those of the angle before its point."""
    with localcontext() as context:
        context.prec = DIGITS + 10
        x = Decimal(angle)
        x -= 2 * PI * (x / (2 * PI)).to_integral_value()
        sums = [Decimal(0), Decimal(0)]
        term, k = Decimal(1), 0
        while k < 10 or abs(term) > Decimal(10) ** -DIGITS:
            sums[k % 2] += term if k % 4 < 2 else -term
            k += 1
            term = term * x / k
        return sums[0], sums[1]


def ulps_off(value: float, exact: Decimal) -> float:
    """How far a double is from a number, in spacings of doubles there."""
    with localcontext() as context:
        context.prec = DIGITS
        return float(abs(Decimal(value) - exact) / Decimal(math.ulp(float(exact))))
