"""What the bench asks of another engine."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from engine import SOLVERS, RevoluteJoint, World
from engine.constants import JOINT_BIAS_FACTOR
from sandbox.lab.timing import Times


class PeerError(Exception):
    """The engine cannot be used; the message is one line for the user."""


class CannotMirror(PeerError):
    """The engine has no counterpart for something in this scene."""


class PeerWorld(Protocol):
    """A copy of one of our worlds in another engine."""

    def step(self, count: int) -> Times:
        """Makes `count` steps and times each."""

    def positions(self) -> np.ndarray:
        """(N, 2) of the bodies, in our order of creation [m]."""

    def close(self) -> None:
        """Frees what it holds; it is not stepped again."""


class WatchedWorld(PeerWorld, Protocol):
    """One that tells all of how its bodies move, too."""

    def motions(self) -> np.ndarray:
        """(N, 6) of the bodies: x, y [m], angle [rad], unwrapped or within half a turn, and the centre's vx, vy [m/s],
        w [rad/s].
        """


class Peer(Protocol):
    """Another engine. Making one raises PeerError if it is not to be had here."""

    @property
    def name(self) -> str:
        """As the report calls it."""

    def mirror(self, world: World, dt: float) -> PeerWorld:
        """Copies the world as it stands now; its steps are dt [s]. CannotMirror if that is not possible."""

    def close(self) -> None:
        """Frees what it holds; it is not asked for worlds again."""


def passes(world: World) -> int:
    """Passes a step for an engine without substeps: ours, or the talk's ten where ours come in substeps."""
    return world.iterations if world.solver == "sequential_impulses" else SOLVERS["sequential_impulses"].iterations


def bias_factor(joint: RevoluteJoint) -> float:
    """Part of a joint's separation that a step removes: the talk's where it has none of its own."""
    return JOINT_BIAS_FACTOR if joint.bias_factor is None else joint.bias_factor


ON_REQUEST = frozenset({"diagnostics", "events", "explosions"})  # move nothing in a step
UNASKED = ON_REQUEST | {"chains", "continuous collision", "sleeping"}  # others do it their way, or go without


def refuse_effects(world: World, known: frozenset[str]) -> None:
    """CannotMirror if the world calls for an effect that the engine is not known to have."""
    for effect in world.effects:
        if effect.called_for and effect.name not in known | UNASKED:
            raise CannotMirror(f"it has no {effect.name}: {effect.because}")


def refuse_switches(world: World) -> None:
    """CannotMirror if one of the talk's switches is off that such engines have not."""
    for name in ("accumulate_impulses", "warm_starting"):
        if not getattr(world.settings, name):
            raise CannotMirror(f"{name} cannot be switched off in it")
