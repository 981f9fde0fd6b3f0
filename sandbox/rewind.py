"""The way back: snapshots now and then, and the commands since, so that a failing step loses nothing."""

from __future__ import annotations

from typing import Any

from engine import Snapshot
from sandbox.commands import PhysicsCommand
from sandbox.simulation import Simulation

EVERY = 60  # steps between snapshots: copying each step would cost more than stepping a small world


class History:
    """The last snapshot of a simulation, and what was done to it since."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._since: list[tuple[int, PhysicsCommand]] = []
        self._keep()

    def applied(self, command: PhysicsCommand) -> None:
        """A command was applied."""
        self._since.append((self._simulation.world.step_count, command))

    def stepped(self) -> None:
        """A step was taken, and was good."""
        if self._simulation.world.step_count - self._step >= EVERY:
            self._keep()

    def go_back(self) -> None:
        """Brings back the state after the last good step, commands given since then left out."""
        simulation, good = self._simulation, self._simulation.world.step_count
        commands = [entry for entry in self._since if entry[0] < good]
        simulation.restore(self._snapshot, self._extras)
        while simulation.world.step_count < good:
            for _, command in (entry for entry in commands if entry[0] == simulation.world.step_count):
                simulation.apply(command)
            try:
                simulation.step()
            except Exception:  # noqa: BLE001 - cannot be: these were good before; an older state is better than none
                simulation.restore(self._snapshot, self._extras)
                break
        self._keep()

    def _keep(self) -> None:
        self._snapshot: Snapshot = self._simulation.world.snapshot()
        self._extras: dict[str, Any] = self._simulation.extras()
        self._step = self._simulation.world.step_count
        self._since.clear()
