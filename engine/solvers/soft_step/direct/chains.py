"""The joints of a world that are solved at once: the plan for them, and the tables that it works on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine.softness import stiffness
from engine.solvers.soft_step.direct import choose, rows, system
from engine.solvers.soft_step.direct.plan import Plan, make_plan
from engine.solvers.soft_step.tables import mover_dtype
from engine.tables import empty

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.solvers.soft_step.direct.choose import Island
    from engine.state import State


class Chains:
    """A plan with the tables that its kernels work on; nothing in them lasts beyond a step."""

    def __init__(self, plan: Plan, precision: str) -> None:
        self.plan = plan
        joints, blocks = len(plan.order), len(plan.places)
        self.rows = empty(joints, rows.direct_dtype(precision))
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
        hertz = stiffness(settings, float(state.steps["dt"][0])).joint_hertz
        islands = [one for one in islands if _stretch(state, settings, *one, hertz) > choose.MOST_STRETCH]
    if not islands:
        return None
    return Chains(_plan(state, [order for _, order in islands]), state.precision)


def _plan(state: State, orders: list) -> Plan:
    joints = state.joints.tables["joints"]
    bodies = np.stack([joints["body1"], joints["body2"]], axis=1)
    return make_plan(orders, bodies, state.bodies.tables["motions"]["inverse_mass"] > 0.0)


def _stretch(state: State, settings: Settings, island: Island, order: Any, hertz: float) -> float:
    """How far its joints would give way under the loads of gravity, visited one by one [m]."""
    chains = Chains(_plan(state, [order]), state.precision)
    motions = state.bodies.tables["motions"].copy()
    if not island.hangs:
        mass = state.bodies.tables["bodies"]["mass"][island.bodies]
        held = island.bodies[int(np.argmax(mass))]
        motions["inverse_mass"][held] = motions["inverse_inertia"][held] = 0.0
    falling = empty(len(motions), mover_dtype(state.precision))
    falling["cosine"] = 1.0
    moves = motions["inverse_mass"] > 0.0
    tables, last = state.joints.tables, len(chains.plan.order)
    c, p = chains, chains.plan
    rows.prepare(
        0, last, p.order, tables["joints"], tables["turns"], tables["slides"], state.bodies.tables["bodies"], motions,
        c.rows, c.errors, c.jacobians,
    )  # fmt: skip
    system.write_diagonals(0, last, c.rows, c.jacobians, c.diagonals, 1e-6)
    system.write_couplings(0, len(p.couplings), p.couplings, c.rows, c.jacobians, c.blocks)
    stiff = np.einsum("kii->ki", c.diagonals).copy()
    system.factor(0, last, p.columns, p.updates, c.diagonals, c.blocks, c.factors)
    linear = np.abs(c.jacobians[:, :, :2]).sum(axis=2) > 0.0  # a turn gives way by an angle, which is no length
    most = 0.0
    for x, y in (settings.gravity, settings.gravity[::-1]):  # as it hangs, and as it will when it has swung
        falling["vx"][moves], falling["vy"][moves] = x, y
        system.write_wanted(0, last, c.rows, c.errors, c.jacobians, falling, 0.0, c.wanted)
        system.substitute(0, last, p.columns, p.places, c.diagonals, c.factors, c.wanted)
        most = max(most, choose.gives_way(np.where(linear, c.wanted, 0.0), stiff, hertz))
    return most
