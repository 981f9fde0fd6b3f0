"""Softness: how a constraint is made a damped spring, stable at any stiffness."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from engine.constants import CONTACT_HERTZ, CONTACT_SUBSTEPS_A_CYCLE, JOINT_SUBSTEPS_A_CYCLE, STATIC_STIFFENING
from engine.jit import kernel
from engine.lanes import const, minimum, over, select

if TYPE_CHECKING:
    from engine.settings import Settings


class Softness(NamedTuple):
    """What the solver needs of a damped spring.

    With C the constraint's error and P the accumulated impulse, one pass gives the impulse
    -m (mass_scale (dC/dt + bias_rate C)) - impulse_scale P: an implicit Euler step of the spring, whose stiffness and
    damper are m omega^2 and 2 m zeta omega, m being the effective mass. Source: E. Catto, "Soft Constraints" (GDC 2011)
    and "Solver2D" (box2d.org, 2024).
    """

    bias_rate: Any  # [1/s]
    mass_scale: Any
    impulse_scale: Any


RIGID = Softness(0.0, 1.0, 0.0)


def softness(hertz: float, damping_ratio: float, h: float) -> Softness:
    """Of a spring of that frequency [Hz] over a substep h [s]."""
    if hertz == 0.0:
        return RIGID
    omega = 2.0 * math.pi * hertz
    a1 = 2.0 * damping_ratio + h * omega
    a2 = h * omega * a1
    return Softness(omega / a1, a2 / (1.0 + a2), 1.0 / (1.0 + a2))


class Stiffness(NamedTuple):
    """Softness of everything in one step."""

    contact: Softness
    static: Softness  # of contacts with a body that no impulse moves
    joint: Softness
    contact_hertz: float
    joint_hertz: float


def stiffness(settings: Settings, dt: float) -> Stiffness:
    """As the settings ask for it, in a step of dt [s].

    "follows": contacts get an eighth and joints a quarter of the substep rate. The damping ratio of contacts follows,
    too: overlap then goes away at the same rate, about 9 a second, at any number of substeps, and a heap that was made
    overlapping is not blown apart by stiff contacts. "fixed": what is set, at most those frequencies.
    """
    rate = settings.substeps / dt
    contact, joint = rate / CONTACT_SUBSTEPS_A_CYCLE, rate / JOINT_SUBSTEPS_A_CYCLE
    damping = settings.contact_damping_ratio
    if settings.stiffness == "fixed":
        contact, joint = min(contact, settings.contact_hertz), min(joint, settings.joint_hertz)
    else:
        damping *= contact / CONTACT_HERTZ
    h = dt / settings.substeps
    if not settings.position_correction:
        return Stiffness(RIGID, RIGID, RIGID, contact, joint)
    return Stiffness(
        softness(contact, damping, h),
        softness(STATIC_STIFFENING * contact, damping, h),
        softness(joint, settings.joint_damping_ratio, h),
        contact,
        joint,
    )


@kernel
def soft_lanes(hertz, damping_ratio, h):
    """The same in lanes, for springs that each have a frequency of their own; rigid where that is 0.

    At most as fast as joints are: what a faster spring asks for, several on one body could not agree upon in a substep,
    and would blow up.
    """
    step = const(h, hertz)
    one = const(1.0, hertz)
    fastest = over(const(2.0 * math.pi / JOINT_SUBSTEPS_A_CYCLE, hertz), step)
    omega = minimum(hertz * const(2.0 * math.pi, hertz), fastest)
    a1 = const(2.0, hertz) * damping_ratio + step * omega
    a2 = step * omega * a1
    a3 = one / (one + a2)
    there = hertz > const(0.0, hertz)
    return Softness(over(omega, a1), select(there, a2 * a3, one), select(there, a3, const(0.0, hertz)))
