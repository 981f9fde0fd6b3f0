"""Who touches whom, from the contacts that the outside sees, and what follows of it by difference of sets."""

from __future__ import annotations

import numpy as np

from engine import World

Pair = tuple[int, int]
PARTING = 0.005  # [m]


def touching(world: World, before: set[Pair]) -> set[Pair]:
    """Pairs of bodies, of one shape each, that touch after a step; before: those that did after the step before."""
    now = set()
    for contact in world.contact_records():
        pair = (int(contact["body1"]), int(contact["body2"]))
        pressed = contact["normal_impulse"] > 0 or contact["separation"] <= 0
        if pressed or (pair in before and contact["separation"] <= PARTING):
            now.add(pair)
    return now


def pairs(rows: np.ndarray) -> list[Pair]:
    """The bodies of events, in their order."""
    return [(int(row["body1"]), int(row["body2"])) for row in rows]


def poses(world: World) -> dict[int, tuple[float, float, float]]:
    """Position and angle of every body, by serial."""
    return {body.serial: (body.position.x, body.position.y, body.angle) for body in world.bodies}
