"""Bodies that joints hold together stop together: one that went on would tear them, by as much as it went further."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.tables import NEVER, NOTHING, STIFF

if TYPE_CHECKING:
    from engine.state import State


@kernel
def stop_joined(pairs, until):
    """Lets both bodies of each pair (J, 2) of rows stop when the first of them does, and who is joined to them."""
    changed = True
    while changed:
        changed = False
        for k in range(len(pairs)):
            one, other = pairs[k, 0], pairs[k, 1]
            first = min(until[one], until[other])
            if until[one] != first or until[other] != first:
                until[one] = until[other] = first
                changed = True


def rigid_pairs(state: State) -> np.ndarray:
    """(J, 2) int64: rows of the bodies, both of which impulses move, that a joint holds whatever force it takes."""
    joints, order = state.joints.tables["joints"], state.joints.order
    held = (joints["held"][order] != NOTHING) & (joints["hertz"][order] == 0.0) & (joints["max_force"][order] == NEVER)
    held |= state.joints.tables["slides"]["spring"][order] == STIFF
    pairs = np.stack([joints["body1"][order[held]], joints["body2"][order[held]]], axis=1)
    return pairs[(state.bodies.tables["motions"]["inverse_mass"][pairs] > 0.0).all(axis=1)]
