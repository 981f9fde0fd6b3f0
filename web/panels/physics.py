"""The settings of the world: gravity, and what the solver does."""

from __future__ import annotations

from functools import partial

from engine import SOLVERS
from sandbox.commands import SetGravity, SetIterations, SetSolver, SetSwitch
from sandbox.frame import Frame
from web.panels.desk import Desk, Follower

STRONGEST_GRAVITY = 30.0  # m/s^2
MOST_ITERATIONS = 50
SWITCHES = {
    "accumulate_impulses": "clamp the sum of a contact's impulses, not each alone",
    "warm_starting": "start from the impulses of the step before",
    "position_correction": "push bodies apart that have sunk into each other",
}


class PhysicsPanel:
    def __init__(self, desk: Desk) -> None:
        self._follower = Follower()
        with desk.gui.add_folder("Physics"):
            self._add_gravity(desk)
            self._add_solver(desk)
            for name, hint in SWITCHES.items():
                self._add_switch(desk, name, hint)

    def _add_gravity(self, desk: Desk) -> None:
        limit = STRONGEST_GRAVITY
        x = desk.gui.add_slider("gravity x", -limit, limit, 0.1, 0.0, hint="m/s²")
        y = desk.gui.add_slider("gravity y", -limit, limit, 0.1, -10.0, hint="m/s²")
        for axis, slider in enumerate((x, y)):
            desk.on_change(slider, lambda: SetGravity(x.value, y.value))
            self._follower.add(slider, partial(_gravity, axis))

    def _add_solver(self, desk: Desk) -> None:
        solver = desk.gui.add_dropdown("solver", tuple(SOLVERS))
        desk.on_change(solver, lambda: SetSolver(solver.value))
        self._follower.add(solver, lambda frame: frame.settings.solver)
        iterations = desk.gui.add_slider("iterations", 1, MOST_ITERATIONS, 1, 10, hint="passes of the solver in a step")
        desk.on_change(iterations, lambda: SetIterations(iterations.value))
        self._follower.add(iterations, lambda frame: frame.settings.iterations)

    def _add_switch(self, desk: Desk, name: str, hint: str) -> None:
        switch = desk.gui.add_checkbox(name.replace("_", " "), True, hint=hint)
        desk.on_change(switch, lambda: SetSwitch(name, switch.value))
        self._follower.add(switch, lambda frame: bool(getattr(frame.settings, name)))

    def update(self, frame: Frame) -> None:
        self._follower.update(frame)


def _gravity(axis: int, frame: Frame) -> float:
    return float(frame.settings.gravity[axis])
