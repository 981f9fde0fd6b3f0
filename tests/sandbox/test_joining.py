"""Bodies joined and set free by commands: each kind as asked, between the bodies asked for, and again from a file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from engine import Box
from engine.vec2 import Vec2, rotate
from sandbox import commands as ask
from sandbox import simulation as simulations
from sandbox.commands import LIMITED, POINT, Join, Unjoin
from sandbox.rewind import History
from sandbox.scenes import Scene
from sandbox.simulation import Simulation
from tests.sandbox.test_repeat import recorded_by_hand, verify
from tests.sandbox.watching import bits


@pytest.fixture
def simulation() -> Simulation:
    """The ground, a box in the middle, and two free ones, turned."""
    simulation = Simulation("The Talk/Single Box")
    simulation.apply(ask.Spawn("box", -3.0, 6.0, angle=0.5))
    simulation.apply(ask.Spawn("box", 3.0, 6.0, angle=-0.25))
    return simulation


def joined(simulation: Simulation, command: Join) -> Any:
    simulation.apply(command)
    return simulation.world.joints[-1]


def point_of(simulation: Simulation, place: int, x: float, y: float) -> tuple[float, float]:
    body = simulation.world.bodies[place]
    px, py = body.position + rotate(body.direction, Vec2(x, y))
    return px, py


def near(point: tuple[float, float]) -> Any:
    return pytest.approx(point, abs=1e-5)


@pytest.mark.parametrize("kind", ask.JOINS)
def test_joins_two_bodies_where_they_were_clicked(simulation: Simulation, kind: str) -> None:
    first, second = point_of(simulation, 2, 0.5, 0.25), point_of(simulation, 3, -0.25, 0.5)
    joint = joined(simulation, Join(kind, 2, 0.5, 0.25, 3, -0.25, 0.5))
    assert (joint.kind, joint.body1.serial, joint.body2.serial) == (kind, 2, 3)
    assert not joint.collide_connected
    one, other = joint.anchors
    if kind == "distance":
        assert (tuple(one), tuple(other)) == (near(first), near(second))
        assert joint.length == pytest.approx(math.dist(one, other))
    elif kind in ("revolute", "weld", "prismatic", "wheel"):
        assert (tuple(one), tuple(other)) == (near(second), near(second))
    if kind in ("prismatic", "wheel"):
        x, y = second[0] - first[0], second[1] - first[1]
        assert tuple(joint.axis) == near((x / math.hypot(x, y), y / math.hypot(x, y)))
    for _ in range(5):
        simulation.step()


def test_numbers_are_those_of_the_kind(simulation: Simulation) -> None:
    numbers: dict[str, Any] = {
        "hertz": 2.0, "damping_ratio": 0.5, "limited": True, "lower": -1.0, "upper": 0.5, "speed": 3.0,
        "strength": 40.0, "break_force": 900.0, "collide": True,
    }  # fmt: skip
    for kind in ask.JOINS:
        joint = joined(simulation, Join(kind, 2, 0.0, 0.0, 3, 0.0, 0.0, **numbers))
        if kind == "filter":
            assert not joint.collide_connected
            continue
        assert (joint.break_force, joint.collide_connected) == (900.0, True)
        names = ("",) if kind in LIMITED else ("linear_", "angular_")
        for name in names:
            assert (getattr(joint, f"{name}hertz"), getattr(joint, f"{name}damping_ratio")) == (2.0, 0.5)
        if kind in LIMITED:
            now = joint.length if kind == "distance" else 0.0
            assert (joint.lower, joint.upper) == pytest.approx((now - 1.0, now + 0.5))
            most = joint.max_motor_torque if kind in ("revolute", "wheel") else joint.max_motor_force
            assert (joint.motor_speed, most) == (3.0, 40.0)
        elif kind == "motor":
            assert (joint.max_force, joint.max_torque) == (40.0, 40.0)


def test_what_is_not_asked_for_is_not_there(simulation: Simulation) -> None:
    for kind in LIMITED:
        joint = joined(simulation, Join(kind, 2, 0.0, 0.0, 3, 0.0, 0.0, lower=-1.0, upper=1.0, speed=2.0))
        assert (joint.hertz, joint.lower, joint.upper, joint.motor_speed, joint.break_force) == (None,) * 5


def test_a_rope_gives_way_to_nothing_but_a_pull(simulation: Simulation) -> None:
    rope = joined(simulation, Join("distance", POINT, -3.0, 9.0, 2, 0.0, 0.0, limited=True, lower=-100.0))
    assert (rope.lower, rope.upper) == (0.0, 3.0)


@pytest.mark.parametrize("order", [1, -1])
def test_a_point_of_the_world_is_the_grounds(simulation: Simulation, order: int) -> None:
    ends = [(2, 0.5, 0.0), (POINT, -2.0, 7.0)][::order]
    joint = joined(simulation, Join("distance", *ends[0], *ends[1]))
    assert [joint.body1.serial, joint.body2.serial] == [2, 0][::order]
    assert tuple(joint.anchors[1 if order == 1 else 0]) == pytest.approx((-2.0, 7.0))
    assert joint.collide_connected, "or it would fall through the ground"
    assert simulation.world.body_count == 4


def falling() -> Simulation:
    """A single box in empty space."""

    def fill(world: Any) -> None:
        world.create_body(Box(1.0, 1.0), mass=1.0, position=(0.0, 5.0))

    return Simulation(Scene("Empty", fill, "", (0.0, 5.0, 20.0)))


def test_without_a_static_body_one_is_made_and_only_one() -> None:
    simulation = falling()
    content = simulation.content
    joint = joined(simulation, Join("revolute", 0, 0.0, 0.0, POINT, 0.0, 8.0))
    anchor = joint.body2
    assert (anchor.kind, len(anchor.shapes), simulation.content) == ("static", 0, content + 1)
    joined(simulation, Join("distance", POINT, 2.0, 8.0, 0, 0.0, 0.0))
    assert simulation.world.body_count == 2
    for _ in range(60):
        simulation.step()
    box = simulation.world.bodies[0]
    assert math.dist(box.position, (0.0, 8.0)) == pytest.approx(3.0, abs=0.02), "it hangs"
    assert len(simulation.frame().joints) == 2


REFUSED = [
    (Join("weld", 0, 0.0, 0.0, 9, 0.0, 0.0), "body2 = 9"),
    (Join("weld", 9, 0.0, 0.0, POINT, 0.0, 0.0), "body1 = 9"),
    (Join("weld", 0, 0.0, 0.0, 0, 0.0, 0.0), "body2 = "),
    (Join("prismatic", 0, 0.0, 1.0, POINT, 0.0, 6.0), "axis = "),  # the same point
]


@pytest.mark.parametrize(("command", "reason"), REFUSED)
def test_what_cannot_be_done_changes_nothing(command: Join, reason: str) -> None:
    simulation, untouched = falling(), falling()
    with pytest.raises(ValueError, match=f"^{reason}"):
        simulation.apply(command)
    assert simulation.content == untouched.content
    assert simulation.world.body_count == 1, "no anchor is left"
    for each in (simulation, untouched):
        joined(each, Join("revolute", 0, 0.0, 0.0, POINT, 0.0, 8.0))
        each.step()
    assert simulation.world.state_hash() == untouched.world.state_hash()


def test_a_solver_that_lacks_the_kind_refuses_it(simulation: Simulation) -> None:
    simulation.apply(ask.Set("solver", "sequential_impulses"))
    with pytest.raises(ValueError, match="solver = "):
        simulation.apply(Join("weld", 2, 0.0, 0.0, 3, 0.0, 0.0))
    joined(simulation, Join("revolute", 2, 0.0, 0.0, 3, 0.0, 0.0))
    simulation.step()


def test_pairs_that_join_nothing_are_refused_at_once() -> None:
    with pytest.raises(ValueError, match=r"^body2 = -1: must be a body"):
        Join("weld", POINT, 0.0, 0.0, POINT, 0.0, 0.0)
    for ends in ((1, POINT), (POINT, 1)):
        with pytest.raises(ValueError, match=r"^body2 = .*joint filter"):
            Join("filter", ends[0], 0.0, 0.0, ends[1], 0.0, 0.0)


def test_no_more_joints_than_there_is_room_for(simulation: Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulations, "MOST_JOINTS", 1)
    joined(simulation, Join("weld", 2, 0.0, 0.0, 3, 0.0, 0.0))
    with pytest.raises(ValueError, match=r"^joints = 2: must be at most 1"):
        simulation.apply(Join("weld", 2, 0.0, 0.0, 3, 0.0, 0.0))


def test_unjoin_takes_all_joints_of_that_body_and_no_others(simulation: Simulation) -> None:
    for one, other in ((2, 3), (3, 1), (1, 2), (2, POINT)):
        simulation.apply(Join("weld", one, 0.0, 0.0, other, 0.0, 0.0))
    simulation.apply(Unjoin(2))
    assert [(joint.body1.serial, joint.body2.serial) for joint in simulation.world.joints] == [(3, 1)]
    before = bits(simulation)
    for nobody in (2, 99):
        simulation.apply(Unjoin(nobody))
    assert bits(simulation) == before


def test_joins_are_repeated_from_a_recording(tmp_path: Path) -> None:
    commands: dict[int, list[Any]] = {
        1: [Join("revolute", 0, 0.0, 0.5, POINT, 1.0, 7.0, speed=2.0, strength=30.0)],
        3: [ask.Spawn("circle", 2.0, 8.0, 0.5), Join("distance", 0, 0.0, 0.0, 2, 0.0, 0.0, hertz=3.0)],
        20: [Unjoin(0)],
    }
    simulation = falling()
    snapshot, extras = simulation.world.snapshot(), simulation.extras()
    for _ in range(2):  # the second time bodies and joints have other serials
        recording = recorded_by_hand(tmp_path / "joined.rrd", simulation, commands, 30)
        assert verify(recording) is None
        assert [len(given) for given in recording.commands.values()] == [1, 2, 1]
        simulation.restore(snapshot, extras)


def test_a_session_that_goes_back_joins_the_same_bodies_again() -> None:
    simulation = falling()
    history = History(simulation)
    for command in (ask.Spawn("circle", 2.0, 8.0, 0.5), Join("distance", 0, 0.0, 0.0, 1, 0.0, 0.0)):
        simulation.apply(command)
        history.applied(command)
    simulation.step()
    before = simulation.world.state_hash()
    history.go_back()
    assert simulation.world.state_hash() == before
