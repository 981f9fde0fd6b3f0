"""The joints of a world that are solved at once: the plan for them, and the tables that it works on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from engine.softness import stiffness
from engine.solvers.soft_step.direct import choose, system
from engine.solvers.soft_step.direct.plan import Order, Plan, make_plan
from engine.solvers.soft_step.direct.rows import direct_dtype
from engine.solvers.soft_step.tables import mover_dtype
from engine.solvers.solver import rounded_step
from engine.tables import DYNAMIC, LINE, POINT, STIFF, empty

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.solvers.soft_step.direct.choose import Island
    from engine.state import State


class Chains:
    """A plan with the tables that its kernels work on; nothing in them lasts beyond a step."""

    def __init__(self, plan: Plan, precision: str) -> None:
        self.plan = plan
        joints, blocks = len(plan.order), len(plan.places)
        self.rows = empty(joints, direct_dtype(precision))
        self.errors, self.wanted, self.accumulated, self.given = (np.zeros((joints, 3)) for _ in range(4))
        self.jacobians = np.zeros((joints, 3, 4))
        self.diagonals = np.zeros((joints, 3, 3))
        self.blocks, self.factors = np.zeros((blocks, 3, 3)), np.zeros((blocks, 3, 3))

    @property
    def count(self) -> int:
        """How many islands."""
        return len(self.plan.islands)

    def tables(self) -> tuple:
        """What the kernels of a step take."""
        plan = self.plan
        return (
            plan.islands, plan.order, plan.couplings, plan.columns, plan.places, plan.updates, self.rows, self.errors,
            self.jacobians, self.diagonals, self.blocks, self.factors, self.wanted, self.accumulated, self.given,
        )  # fmt: skip


def find_chains(state: State, settings: Settings, order: np.ndarray) -> Chains | None:
    """Which of the joints in these rows are to be solved at once, as the settings say; None where none are."""
    if settings.joint_solving == "iterated" or "chains" in state.suppressed or not len(order):
        return None
    candidates = choose.islands_of(state, choose.rigid_joints(state, order), settings.joint_solving == "auto")
    found = [(island, choose.order_of(state, island)) for island in candidates]
    islands = [(island, order) for island, order in found if order is not None]
    if settings.joint_solving == "auto" and islands:
        hertz = stiffness(settings, rounded_step(float(state.steps["dt"][0]))).joint_hertz
        islands = [one for one in islands if _stretch(state, settings, *one, hertz) > choose.MOST_STRETCH]
    if not islands:
        return None
    return Chains(_plan(state, [order for _, order in islands]), state.precision)


def _plan(state: State, orders: list) -> Plan:
    joints = state.joints.tables["joints"]
    bodies = np.stack([joints["body1"], joints["body2"]], axis=1)
    return make_plan(orders, bodies, state.bodies.tables["motions"]["inverse_mass"] > 0.0)


def _stretch(state: State, settings: Settings, island: Island, order: Order, hertz: float) -> float:
    """How far the joint that would give way most would, visited one by one under the loads of gravity [m].

    As if all hung in a line: so it depends on what there is, not on how it stands, and is the same after a restore.
    """
    chains = Chains(_plan(state, [order]), "double")
    joints, bodies = state.joints.tables["joints"], state.bodies.tables["bodies"]
    inverse_mass = state.bodies.tables["motions"]["inverse_mass"].astype(np.float64)
    if not island.hangs:
        inverse_mass[island.bodies[int(np.argmin(bodies["mass"][island.bodies]))]] = 0.0
    c, p, last = chains, chains.plan, len(chains.plan.order)
    for number in "12":
        rows = joints[f"body{number}"][p.order]
        c.rows[f"body{number}"], c.rows[f"inverse_mass{number}"] = rows, inverse_mass[rows]
    c.jacobians[:, 0, 0] = 1.0
    falling = empty(len(inverse_mass), mover_dtype("double"))
    falling["vx"] = np.where(inverse_mass > 0.0, max(math.hypot(*settings.gravity), choose.LEAST_GRAVITY), 0.0)
    system.write_diagonals(0, last, c.rows, c.jacobians, c.diagonals, 1e-9)
    system.write_couplings(0, len(p.couplings), p.couplings, c.rows, c.jacobians, c.blocks)
    gives = c.diagonals[:, 0, 0].copy()
    system.factor(0, last, p.columns, p.updates, c.diagonals, c.blocks, c.factors)
    system.write_wanted(0, last, c.rows, c.errors, c.jacobians, falling, 0.0, c.wanted)
    system.substitute(0, last, p.columns, p.places, c.diagonals, c.factors, c.wanted)
    loads = np.abs(c.wanted[:, 0])  # [N]
    give = loads * gives
    turns = joints["held"][p.order] == LINE
    turns |= (joints["held"][p.order] == POINT) & (state.joints.tables["turns"]["spring"][p.order] == STIFF)
    if turns.any():  # a beam gives way by angles, and its end by their sum
        reach = _reach(state, p.order)
        inverse_inertia = state.bodies.tables["motions"]["inverse_inertia"].astype(np.float64)
        easy = inverse_inertia[joints["body1"][p.order]] + inverse_inertia[joints["body2"][p.order]]
        give += np.where(turns, loads * reach * easy * reach, 0.0)
    return float(give.max()) / (2.0 * math.pi * hertz) ** 2


def _reach(state: State, rows: np.ndarray) -> float:
    """How far an island would reach in a line: the ways from centres of mass to anchors, summed up [m]."""
    joints, bodies = state.joints.tables["joints"], state.bodies.tables["bodies"]
    total = 0.0
    for number in "12":
        owners = joints[f"body{number}"][rows]
        x = joints[f"anchor{number}_x"][rows] - bodies["local_x"][owners]
        y = joints[f"anchor{number}_y"][rows] - bodies["local_y"][owners]
        total += float(np.where(bodies["kind"][owners] == DYNAMIC, np.hypot(x, y), 0.0).sum())
    return total
