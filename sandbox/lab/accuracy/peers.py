"""A peer in place of our solver: it steps its copy of an experiment, and our world is put where its bodies are.

An experiment watches our world, so that one definition serves all engines. What it watches beyond the motion of bodies,
such as the impulses of contacts, a peer does not tell; which numbers these are is found by trying, with our own run:
those that come out otherwise when a world that was never stepped is put where the stepped one is.
"""

from __future__ import annotations

import math
import time
from functools import cache
from typing import Any, cast

import numpy as np

from engine import World
from sandbox.lab.accuracy.runs import NotApplicable, TooSlow, Watched, built, step_count
from sandbox.lab.accuracy.series import Point, Setting, all_series
from sandbox.lab.experiments import EXPERIMENTS, Experiment
from sandbox.lab.peers import INSTALLABLE, CannotMirror, Peer, WatchedWorld

LOOKS = 20  # moments at which the two are compared
SAME = 1e-4  # relative, and in the unit of what is watched: beyond it a number rests on more than the motion


@cache
def peer(name: str) -> Peer:
    """The engine of that name. PeerError if it is not to be had here."""
    return next(kind for kind in INSTALLABLE if getattr(kind, "name", "") == name)(1)


def copied(experiment: Experiment, point: Point) -> tuple[World, Any, WatchedWorld]:
    """The filled world, what to watch in it, and the peer's copy. NotApplicable if there can be none."""
    world, observe = built(experiment, own_point(point))
    try:
        copy = cast(WatchedWorld, peer(point.series.solver).mirror(world, point.setting.dt))
    except CannotMirror as error:
        raise NotApplicable(str(error)) from None
    if "iterations" in point.setting.world:
        copy.space.iterations = point.setting.world["iterations"]  # type: ignore[attr-defined]
    return world, observe, copy


def own_point(point: Point) -> Point:
    """The point as our world has it, from which the peer is told: its stiffness is fixed, as the peer's own is."""
    setting = point.setting
    known = {name: value for name, value in setting.world.items() if name == "substeps"}
    return Point(point.series, Setting(setting.label, {**known, "stiffness": "fixed"}, setting.steps, setting.level))


def watch_peer(experiment: Experiment, point: Point, until: float = math.inf) -> Watched:
    """A run's history, NaN where it rests on more than motion. TooSlow if it has not ended by then."""
    world, observe, copy = copied(experiment, point)
    history = []
    try:
        for _ in range(step_count(experiment, point)):
            if time.monotonic() > until:
                raise TooSlow
            copy.step(1)
            motions = copy.motions()
            if not np.isfinite(motions).all():
                break
            put(world, motions)
            history.append(seen(observe, world))
    finally:
        copy.close()
    found = np.array(history, np.float64)
    if len(found):
        found[:, beyond_motion(experiment.name, found.shape[1])] = np.nan
    return Watched(found, None)


def cost_of_peer(experiment: Experiment, point: Point) -> float:
    """CPU time of a simulated second [ms]."""
    _, _, copy = copied(experiment, point)
    steps = step_count(experiment, point)
    try:
        return float(copy.step(steps).cpu.sum()) / (steps * point.setting.dt)
    finally:
        copy.close()


def put(world: World, motions: np.ndarray) -> None:
    """Places the bodies and gives them velocities, as `motions` (N, 6) has them. Angles go on without a jump."""
    bodies, moving = (world._state.bodies.tables[name] for name in ("bodies", "motions"))
    order = world._state.bodies.order
    x, y, angle, vx, vy, w = motions.T
    old = bodies["angle"][order]
    angle = old + np.remainder(angle - old + np.pi, 2.0 * np.pi) - np.pi
    cosine, sine = np.cos(angle), np.sin(angle)
    local_x, local_y = bodies["local_x"][order], bodies["local_y"][order]
    values = {"x": x, "y": y, "angle": angle}
    values["center_x"], values["center_y"] = (
        x + cosine * local_x - sine * local_y,
        y + sine * local_x + cosine * local_y,
    )
    for name, column in values.items():
        bodies[name][order] = column
    for name, column in {"cosine": cosine, "sine": sine, "vx": vx, "vy": vy, "w": w}.items():
        moving[name][order] = column


def motions_of(world: World) -> np.ndarray:
    """(N, 6) of our own world."""
    return np.column_stack([world.positions, world.angles, world.velocities, world.angular_velocities])


def seen(observe: Any, world: World) -> np.ndarray:
    """What is watched. NotApplicable if that cannot be looked at where no step was made."""
    try:
        return np.atleast_1d(np.asarray(observe(world), np.float64))
    except (ValueError, IndexError, KeyError, ZeroDivisionError):
        raise NotApplicable("it does not tell the impulses of contacts and joints that are watched") from None


@cache
def beyond_motion(scene: str, width: int) -> np.ndarray:
    """(width,) bool: which of the numbers watched rest on more than the motion of bodies."""
    experiment = EXPERIMENTS[scene]
    line = all_series(("soft_step",))[0]
    point = Point(line, Setting("", {}))
    world, observe = built(experiment, point)
    other, observe_other = built(experiment, point)
    steps = step_count(experiment, point)
    differ = np.zeros(width, np.bool_)
    for step in range(steps):
        world.step(point.setting.dt)
        if step % max(1, steps // LOOKS) == 0 or step == steps - 1:
            put(other, motions_of(world))
            stepped, placed = seen(observe, world), seen(observe_other, other)
            differ |= ~np.isclose(placed, stepped, rtol=SAME, atol=SAME)
    return differ
