"""What the joints of an island bear, and how far they would give way if they were visited one by one.

Loads are those of gravity, as if all hung in a line, and those of motors: a force along a slide, and a torque over the
lever by which it acts, the anchor's distance from the centre of mass and the body's radius of gyration. They depend on
what there is and not on how it stands or moves, and so are the same after a restore.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.solvers.soft_step.direct import choose, system
from engine.solvers.soft_step.tables import mover_dtype
from engine.tables import ALONG_NOTHING, DYNAMIC, LINE, POINT, STIFF, empty, rounded_up

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.solvers.soft_step.direct.chains import Chains
    from engine.solvers.soft_step.direct.choose import Island
    from engine.state import State


def stretch(
    state: State, settings: Settings, island: Island, chains: Chains, driven_at: np.ndarray, hertz: float
) -> float:
    """How far the joint that would give way most would [m].

    chains: made for this island alone, and worked on. driven_at: of `motor_loads`. hertz: of all joints [1/s].
    """
    rows = chains.plan.order
    joints = state.joints.tables["joints"][rows]
    weights = gravity_loads(state, settings, island, chains)
    driven = driven_at[joints["body1"]] + driven_at[joints["body2"]]
    easy = sum(inverse_masses(state, joints[f"body{number}"]) for number in (1, 2))
    turning = sum(inverse_inertias(state, joints[f"body{number}"]) for number in (1, 2))
    give = weights * easy + driven * (easy + sum(leverage(state, joints, number) for number in (1, 2)))
    turns = joints["held"] == LINE
    turns |= (joints["held"] == POINT) & (state.joints.tables["turns"]["spring"][rows] == STIFF)
    if turns.any():  # a beam gives way by angles, and its end by their sum
        far = reach(state, joints)
        give += np.where(turns, (weights + driven) * far * turning * far, 0.0)
    return float(give.max()) / (2.0 * math.pi * hertz) ** 2


def gravity_loads(state: State, settings: Settings, island: Island, chains: Chains) -> Any:
    """The force in each joint of an island that hangs in a line from what it is joined to [N].

    What is joined to nothing that holds it hangs on its lightest body.
    """
    c, p, last = chains, chains.plan, len(chains.plan.order)
    joints, bodies = state.joints.tables["joints"], state.bodies.tables["bodies"]
    inverse_mass = state.bodies.tables["motions"]["inverse_mass"].astype(np.float64)
    if not island.hangs:
        inverse_mass[island.bodies[int(np.argmin(bodies["mass"][island.bodies]))]] = 0.0
    for number in "12":
        rows = joints[f"body{number}"][p.order]
        c.rows[f"body{number}"], c.rows[f"inverse_mass{number}"] = rows, inverse_mass[rows]
    c.jacobians[:, 0, 0] = 1.0
    falling = empty(len(inverse_mass), mover_dtype("double"))
    falling["vx"] = np.where(inverse_mass > 0.0, max(math.hypot(*settings.gravity), choose.LEAST_GRAVITY), 0.0)
    system.write_diagonals(0, last, c.rows, c.jacobians, c.diagonals, 1e-9)
    system.write_couplings(0, len(p.couplings), p.couplings, c.rows, c.jacobians, c.blocks)
    system.factor(0, last, p.columns, p.updates, c.diagonals, c.blocks, c.factors)
    system.write_wanted(0, last, c.rows, c.errors, c.jacobians, falling, 0.0, c.wanted)
    system.substitute(0, last, p.columns, p.places, c.diagonals, c.factors, c.wanted)
    return np.abs(c.wanted[:, 0])


def motor_loads(state: State, order: np.ndarray) -> np.ndarray:
    """The force that motors of the joints in these rows may ask of the joints at each body, by its row [N]."""
    bodies = state.bodies.tables["bodies"]
    joints, turns, slides = (state.joints.tables[name][order] for name in ("joints", "turns", "slides"))
    torque = np.where(motored(turns), rounded_up(turns["max_motor"]), 0.0)
    force = np.where(motored(slides), rounded_up(slides["max_motor"]), 0.0)
    at_body = np.zeros(len(bodies))
    for number in (1, 2):
        owner = joints[f"body{number}"]
        lever = np.sqrt(arm2_of(state, joints, number)) + gyration(state, owner)
        np.add.at(at_body, owner, force + np.divide(torque, lever, out=np.zeros(len(order)), where=lever > 0.0))
    return np.where(bodies["kind"] == DYNAMIC, at_body, 0.0)


def motored(parts: np.ndarray) -> Any:
    """Which of these turns or slides have a motor."""
    return (parts["along"] != ALONG_NOTHING) & (parts["motored"] != 0)


def inverse_masses(state: State, rows: np.ndarray) -> Any:
    """Of the bodies in these rows [1/kg]."""
    return state.bodies.tables["motions"]["inverse_mass"][rows].astype(np.float64)


def inverse_inertias(state: State, rows: np.ndarray) -> Any:
    """Of the bodies in these rows [1/(kg m^2)]."""
    return state.bodies.tables["motions"]["inverse_inertia"][rows].astype(np.float64)


def arm2_of(state: State, joints: np.ndarray, number: int) -> Any:
    """Squares of the distances from the centres of mass of body1, or body2, to the anchors [m^2]."""
    bodies = state.bodies.tables["bodies"][joints[f"body{number}"]]
    x = joints[f"anchor{number}_x"] - bodies["local_x"]
    y = joints[f"anchor{number}_y"] - bodies["local_y"]
    return np.where(bodies["kind"] == DYNAMIC, x * x + y * y, 0.0)


def leverage(state: State, joints: np.ndarray, number: int) -> Any:
    """What turning adds to how easily an anchor moves [1/kg]."""
    return arm2_of(state, joints, number) * inverse_inertias(state, joints[f"body{number}"])


def gyration(state: State, rows: np.ndarray) -> Any:
    """Radii of gyration of the bodies in these rows [m]; 0 of what does not turn."""
    mass, inertia = inverse_masses(state, rows), inverse_inertias(state, rows)
    return np.sqrt(np.divide(mass, inertia, out=np.zeros(len(rows)), where=inertia > 0.0))


def reach(state: State, joints: np.ndarray) -> float:
    """How far an island would reach in a line: the ways from centres of mass to anchors, summed up [m]."""
    return float(sum(np.sqrt(arm2_of(state, joints, number)).sum() for number in (1, 2)))
