"""Sine and cosine that give the same bits on every machine, with and without compilation.

The C library's differ by an ulp between platforms, and an ulp moves a run of dominos by nanometres within ten
seconds. These use only + - * and rounding to an integer, each of which IEEE 754 fixes to the last bit.
"""

from __future__ import annotations

import math

import numpy as np

from engine.jit import kernel
from engine.lanes import maximum, minimum, select

# pi/2 as a sum of three doubles, the first two of 33 bits, so that k times each is exact for |k| < 2^20
# (W. Cody and W. Waite, Software Manual for the Elementary Functions, 1980).
HALF_PI_1 = float.fromhex("0x1.921fb544p+0")
HALF_PI_2 = float.fromhex("0x1.0b4611a6p-34")
HALF_PI_3 = float.fromhex("0x1.3198a2e037073p-69")
TWO_OVER_PI = 2.0 / math.pi
QUARTER_PI = math.pi / 4.0
LARGEST_TAIL = 2.0**-53

# Taylor coefficients; on |r| <= pi/4 the first term left out is below 1e-19 for the sine and 4e-18 for the cosine.
S3, S5, S7, S9, S11, S13, S15, S17 = ((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 9))
C4, C6, C8, C10, C12, C14, C16 = ((-1.0) ** k / math.factorial(2 * k) for k in range(2, 9))


@kernel
def reduce_angle(angle):
    """The angle less a whole number of quarter turns: (quarters mod 4, r, tail), r + tail in [-pi/4, pi/4].

    The tail holds what rounding r left out, so that the polynomials start from about 100 bits.
    """
    quarters = np.rint(angle * TWO_OVER_PI)
    first = angle - quarters * HALF_PI_1
    second = quarters * HALF_PI_2
    rough = first - second
    rest = quarters * HALF_PI_3 - ((first - rough) - second)
    r = rough - rest
    tail = (rough - r) - rest
    # these bite only beyond 1e6 rad, where neither is exact any longer
    r = maximum(-QUARTER_PI, minimum(QUARTER_PI, r))
    tail = maximum(-LARGEST_TAIL, minimum(LARGEST_TAIL, tail))
    quadrant = quarters - 4.0 * np.floor(quarters * 0.25)
    return quadrant, r, tail


@kernel
def cos_sin(angle):
    """Cosine and sine of a float64 angle [rad], within 0.75 ulp of the true value for |angle| < 1e6 rad.

    Beyond that the error grows as the spacing of the angle's own bits does; both stay finite and within [-1, 1].
    """
    quadrant, r, tail = reduce_angle(angle)
    z = r * r
    s = S3 + z * (S5 + z * (S7 + z * (S9 + z * (S11 + z * (S13 + z * (S15 + z * S17))))))
    c = C4 + z * (C6 + z * (C8 + z * (C10 + z * (C12 + z * (C14 + z * C16)))))
    half = 0.5 * z
    sine = r + (r * z * s + tail * (1.0 - half))
    rough = 1.0 - half
    cosine = rough + (((1.0 - rough) - half) + (z * z * c - r * tail))

    odd = (quadrant == 1.0) | (quadrant == 3.0)
    along = select(odd, sine, cosine)
    across = select(odd, cosine, sine)
    along = select((quadrant == 1.0) | (quadrant == 2.0), -along, along)
    across = select(quadrant >= 2.0, -across, across)
    return along, across
