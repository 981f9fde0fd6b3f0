"""Peers in `tumble accuracy`: our world is put where their bodies are, and what they do not tell is not applicable."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from engine import Box, World
from sandbox.lab.accuracy import Setting, all_series, sweep
from sandbox.lab.accuracy.peers import beyond_motion, motions_of, peer, put, watch_peer
from sandbox.lab.accuracy.series import GRAVITY, Point, Series
from sandbox.lab.accuracy.workers import Threads
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.lab.peers import INSTALLABLE, KNOBS, PeerError
from tests.sandbox.commandline import Tumble, one_line

DT = 1 / 60


def point(name: str, **settings: Any) -> Point:
    return Point(Series(f"{name}, one", name, ()), Setting("1", settings))


def tumbling() -> World:
    """A body whose centre of mass is off its origin, thrown and turning fast."""
    world = World(gravity=GRAVITY, sleeping=False)
    world.create_body(Box(1, 1), position=(0, -9), kind="static")
    body = world.create_body(position=(1.0, 2.0), angle=3.0, velocity=(2.0, 5.0), angular_velocity=8.0)
    body.add_shape(Box(1, 0.5))
    body.add_shape(Box(0.4, 0.4), offset=(1.0, 0.0))
    return world


@pytest.mark.parametrize("name", KNOBS)
def test_motions_are_those_of_free_flight(name: str) -> None:
    world, other = tumbling(), tumbling()
    copy: Any = peer(name).mirror(world, DT)
    np.testing.assert_allclose(copy.motions()[1], motions_of(world)[1], atol=1e-5)
    steps = 90  # 12 rad: the angle goes on without a jump
    center, velocity = world.bodies[1].center, world.bodies[1].velocity
    for _ in range(steps):
        copy.step(1)
        put(other, copy.motions())
    copy.close()
    body, t = other.bodies[1], steps * DT
    assert body.angle == pytest.approx(3.0 + 8.0 * t, abs=0.02)  # Box2D turns a little too slowly
    assert body.velocity.y == pytest.approx(velocity.y - 10.0 * t, abs=0.2)
    assert body.center.x == pytest.approx(center.x + velocity.x * t, abs=1e-3)
    assert body.center.y == pytest.approx(center.y + velocity.y * t - 5.0 * t * t, abs=0.3)
    c, s = math.cos(body.angle), math.sin(body.angle)
    assert (body.direction.x, body.direction.y) == pytest.approx((c, s), abs=1e-6)


def test_put_back_where_it_was_nothing_changes() -> None:
    world = tumbling()
    for _ in range(30):
        world.step(DT)
    before = world.state_hash()
    center = world.bodies[1].center
    put(world, motions_of(world))
    assert world.bodies[1].center == pytest.approx(center, abs=1e-6)
    assert world.state_hash() == before


def test_what_rests_on_contacts_is_found() -> None:
    stack = EXPERIMENTS["stack"]
    width = 11  # an impulse a box, and the sag
    assert list(beyond_motion(stack.name, width)) == [True] * 10 + [False]
    assert not beyond_motion("sliding", 1).any()


@pytest.mark.parametrize("name", KNOBS)
def test_a_measure_of_impulses_is_not_applicable_and_that_of_motion_is(name: str) -> None:
    outcome = sweep([EXPERIMENTS["stack"]], [Series(f"{name}, one", name, (Setting("4", {}),))], Threads(), repeats=1)
    assert [row.measure for row in outcome.rows] == ["sag [m]"]
    assert outcome.rows[0].solves is None
    assert outcome.rows[0].solver == name
    assert 0.0 <= outcome.rows[0].error < 0.5


@pytest.mark.parametrize(("name", "settings"), [("pyb2d3", {"substeps": 8}), ("pymunk", {"iterations": 10})])
def test_sliding_stops_where_friction_says(name: str, settings: dict) -> None:
    experiment = EXPERIMENTS["sliding"]
    watched = watch_peer(experiment, point(name, **settings))
    error = experiment.measures[0].error(watched.history, DT)
    assert error < 0.1  # of 10 m; v h / 2 = 0.08 with one step


def test_a_knob_is_turned() -> None:
    stack = EXPERIMENTS["stack"]
    few, many = (watch_peer(stack, point("pymunk", iterations=count)).history[-1, -1] for count in (1, 50))
    assert abs(few) > 10 * abs(many)


def test_lines_of_peers_follow_ours() -> None:
    lines = all_series(["soft_step"], ["pyb2d3"])
    assert [line.solver for line in lines[-2:]] == ["pyb2d3", "pyb2d3"]


def test_a_peer_that_is_not_installed_is_one_line(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(name: str) -> None:
        raise PeerError("pymunk is not installed: pip install 'tumble[peers]'")

    monkeypatch.setattr("sandbox.verbs.accuracy.peer", lacking)
    assert "pip install 'tumble[peers]'" in one_line(tumble("accuracy", "--peers"))


def test_every_peer_has_a_knob() -> None:
    assert {kind.name for kind in INSTALLABLE} == set(KNOBS)  # type: ignore[attr-defined]
