"""What a world's state adds up to: energy, momentum, overlap."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.jit import kernel
from engine.state import State
from engine.tables import DYNAMIC
from engine.vec2 import Vec2


class Diagnostics(NamedTuple):
    """Sums over all dynamic bodies and all contacts."""

    kinetic_energy: float  # sum of m v^2 / 2 + I w^2 / 2 [J]
    potential_energy: float  # sum of -m g . x, zero at the origin [J]
    momentum: Vec2  # [kg m/s]
    angular_momentum: float  # about the origin [kg m^2/s]
    max_penetration: float  # deepest overlap of a contact, >= 0 [m]
    contact_count: int

    @property
    def energy(self) -> float:
        """Kinetic and potential [J]."""
        return self.kinetic_energy + self.potential_energy


@kernel
def sum_bodies(order, bodies, motions, gravity_x, gravity_y):
    """(kinetic, potential, momentum x, momentum y, angular momentum), summed in the order of creation, in float64."""
    kinetic = potential = momentum_x = momentum_y = angular = 0.0
    for rank in range(len(order)):
        body = bodies[order[rank]]
        if body.kind == DYNAMIC:
            motion = motions[order[rank]]
            vx = np.float64(motion.vx)
            vy = np.float64(motion.vy)
            w = np.float64(motion.w)
            kinetic += 0.5 * body.mass * (vx * vx + vy * vy) + 0.5 * body.inertia * w * w
            potential -= body.mass * (gravity_x * body.center_x + gravity_y * body.center_y)
            momentum_x += body.mass * vx
            momentum_y += body.mass * vy
            angular += body.mass * (body.center_x * vy - body.center_y * vx) + body.inertia * w
    return kinetic, potential, momentum_x, momentum_y, angular


@kernel
def sum_contacts(arbiters, contacts, count):
    """(deepest overlap, number of contacts) of the first `count` arbiters."""
    deepest = 0.0
    total = 0
    for index in range(count):
        for i in range(arbiters[index].count):
            total += 1
            depth = -np.float64(contacts[index, i].separation)
            if depth > deepest:
                deepest = depth
    return deepest, total


def diagnose(state: State, gravity: tuple[float, float]) -> Diagnostics:
    """The diagnostics of a state, contacts being those of its last step."""
    state.diagnosed_at = state.step_count
    tables = state.bodies.tables
    kinetic, potential, px, py, angular = sum_bodies(
        state.bodies.order, tables["bodies"], tables["motions"], gravity[0], gravity[1]
    )
    table = state.arbiters
    deepest, total = sum_contacts(table.rows, table.contacts, table.count)
    return Diagnostics(
        float(kinetic), float(potential), Vec2(float(px), float(py)), float(angular), float(deepest), int(total)
    )
