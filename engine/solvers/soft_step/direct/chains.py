"""The joints of a world that are solved at once: the plan for them, and the tables that it works on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.softness import stiffness
from engine.solvers.soft_step.direct import choose
from engine.solvers.soft_step.direct.loads import motor_loads, stretch
from engine.solvers.soft_step.direct.plan import Order, Plan, make_plan
from engine.solvers.soft_step.direct.rows import direct_dtype
from engine.solvers.solver import rounded_step
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
    driven = motor_loads(state, order) if settings.joint_solving == "auto" else None
    candidates = choose.islands_of(state, choose.rigid_joints(state, order), driven)
    found = [(island, choose.order_of(state, island)) for island in candidates]
    islands = [(island, order) for island, order in found if order is not None]
    if driven is not None and islands:
        hertz = stiffness(settings, rounded_step(float(state.steps["dt"][0]))).joint_hertz

        def gives_way(island: Island, order: Order) -> bool:
            alone = Chains(_plan(state, [order]), "double")
            return stretch(state, settings, island, alone, driven, hertz) > choose.MOST_STRETCH

        islands = [one for one in islands if gives_way(*one)]
    if not islands:
        return None
    return Chains(_plan(state, [order for _, order in islands]), state.precision)


def _plan(state: State, orders: list) -> Plan:
    joints = state.joints.tables["joints"]
    bodies = np.stack([joints["body1"], joints["body2"]], axis=1)
    return make_plan(orders, bodies, state.bodies.tables["motions"]["inverse_mass"] > 0.0)
