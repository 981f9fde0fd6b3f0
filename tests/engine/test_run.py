"""World.run: many steps in compiled code are, bit for bit, what as many calls of World.step are."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest

from engine import STAGES, Box, Circle, StepError, World
from engine import run as running
from tests.engine import tiny_worlds
from tests.engine.worlds import DT, busy, fingerprint, floor, run, tables_of

compiled = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="without compilation, run is a loop over step")


def seen(world: World) -> dict[str, Any]:
    """Every bit that a later step depends on, and all that the outside sees."""
    return {
        **tables_of(world),
        "records": world.contact_records().tobytes() + world.joint_records().tobytes(),
        "bounds": world.bounds.tobytes(),
        "positions": world.positions.tobytes(),
        "hash": world.state_hash(),
        "time": (world.step_count, world.time, world.colours, world.overflow),
        "diagnostics": world.diagnostics(),
    }


def agree(make: Callable[[], World], lengths: tuple[int, ...] = (1, 2, 30, 3, 24), dt: float = DT) -> World:
    """Runs one world step by step and one in pieces of so many steps; returns the latter."""
    stepped, ran = make(), make()
    for steps in lengths:
        run(stepped, steps, dt)
        ran.run(steps, dt)
        assert seen(ran) == seen(stepped), f"after {ran.step_count} steps"
    return ran


def rain(**settings: Any) -> World:
    """Boxes and circles fall on a heap, whose pairs change all the time."""
    world = World(**settings)
    floor(world)
    rng = np.random.default_rng(3)
    for k in range(24):
        shape = Circle(0.3) if k % 3 == 0 else Box(0.5, 0.4)
        world.create_body(shape, position=(rng.uniform(-1.5, 1.5), 0.5 + 0.5 * k), angle=rng.uniform(0, 3))
    return world


def resting(height: float = 0.0, **settings: Any) -> World:
    """A box that lies on the ground, or falls that far [m]."""
    world = World(**settings)
    floor(world)
    world.create_body(Box(1, 1), position=(0, 0.5 + height))
    return world


def turning() -> World:
    """A wheel that a motor turns, on a floor that is a belt."""
    world = World()
    ground = floor(world, tangent_speed=0.5)
    axle = world.create_body(Box(1, 0.3), position=(0, 1.0))
    wheel = world.create_body(Circle(0.4), position=(0, 0.41), rolling_resistance=0.1)
    world.create_joint_revolute(axle, wheel, anchor=(0, 0.41), motor_speed=-3.0, max_motor_torque=5.0)
    world.create_joint_revolute(ground, axle, anchor=(0, 2.0), softness=0.05)
    return world


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """How many steps stayed in compiled code each time, and from which stage Python went on."""
    found: list[tuple[int, int]] = []

    def note(*arguments: Any) -> tuple[int, int]:
        found.append(running.run_quietly(*arguments))
        return found[-1]

    monkeypatch.setattr("engine.world.run_quietly", note)
    return found


@pytest.mark.parametrize("name", tiny_worlds.WORLDS)
def test_every_kind_of_world(name: str) -> None:
    agree(lambda: tiny_worlds.fill(name, "soft_step", "single"))


@pytest.mark.parametrize("name", ["boxes", "joined", "outlines", "lively"])
def test_in_double_precision(name: str) -> None:
    agree(lambda: tiny_worlds.fill(name, "soft_step", "double"))


def test_worlds_that_python_steps() -> None:
    agree(lambda: tiny_worlds.fill("mixed", "sequential_impulses", "single"))
    agree(lambda: rain(broad_phase="all_pairs"), (20, 20))

    def windy() -> World:
        world = resting(wind=(3, 0))
        world.create_body(Circle(0.4), position=(2, 1), drag=0.5)
        return world

    agree(windy)


@compiled
def test_a_heap_whose_pairs_change(taken: list[tuple[int, int]]) -> None:
    agree(rain, (100, 1, 99))
    assert any(done > 0 and stage == running.FIND_PAIRS for done, stage in taken)
    assert (0, running.FIND_PAIRS) in taken, "where it is not worth while, Python takes the steps"


@compiled
def test_a_body_that_begins_to_touch_within_its_fat_box(taken: list[tuple[int, int]]) -> None:
    agree(lambda: resting(height=0.06), (100,))
    assert any(done > 0 and stage == running.GIVE_COLOURS for done, stage in taken)


def test_a_motor_and_a_belt() -> None:
    agree(turning)


@compiled
def test_a_box_at_rest_stays_in_compiled_code(taken: list[tuple[int, int]]) -> None:
    world = agree(resting, (100, 5000))
    assert taken[-1] == (running.AT_MOST, running.NOWHERE)
    assert sum(done for done, _ in taken) > world.step_count - 10


@compiled
def test_where_python_goes_on() -> None:
    names = [name for name, _ in STAGES]
    assert names[running.FIND_PAIRS] == "broad phase"
    assert names[running.GIVE_COLOURS] == "apply forces", "the first stage after contacts were found"


def test_another_time_step_between_runs() -> None:
    stepped, ran = rain(), rain()
    for dt in (DT, DT / 2, DT / 2, DT, 0.02):
        run(stepped, 30, dt)
        ran.run(30, dt)
        assert seen(ran) == seen(stepped)


def test_settings_and_content_may_change_between_runs() -> None:
    stepped, ran = rain(), rain()
    for world, go in ((stepped, lambda n: run(stepped, n)), (ran, lambda n: ran.run(n, DT))):
        go(40)
        world.gravity = (2, -8)
        go(10)
        world.create_body(Box(0.3, 0.3), position=(0, 14), restitution=0.5)
        go(40)
        world.bodies[3].destroy()
        world.bodies[5].position = (0, 9)
        world.bodies[6].apply_force((0, 300))
        go(10)
        world.bodies[7].velocity = (0, 5)
        world.explode((0, 0.5), radius=2, impulse=0.5)
        world.substeps = 2
        go(40)
    assert seen(ran) == seen(stepped)


def test_a_snapshot_between_runs() -> None:
    whole = rain()
    whole.run(90, DT)
    half = rain()
    half.run(45, DT)
    other = World()
    other.restore(half.snapshot())
    other.run(45, DT)
    half.run(45, DT)
    assert other.state_hash() == half.state_hash() == whole.state_hash()


@pytest.mark.parametrize("threads", [1, 2])
def test_many_bodies_with_threads(threads: int) -> None:
    def many() -> World:
        world = World(threads=threads)
        floor(world)
        places = np.array([(1.2 * (k % 20) - 12, 0.6 + 1.1 * (k // 20)) for k in range(300)])
        world.create_bodies(Box(1, 1), positions=places)
        return world

    agree(many, (12,))


def test_an_empty_world() -> None:
    agree(World, (3, 3))


def test_no_steps_and_no_time() -> None:
    world = run(busy(), 3)
    before = fingerprint(world)
    world.run(0, DT)
    world.run(10, 0.0)
    assert fingerprint(world) == before


@pytest.mark.parametrize(
    ("steps", "dt", "message"),
    [
        (-1, DT, "steps = -1: must be a whole number from 0 "),
        (True, DT, "steps = True: must be a whole number"),
        (2.0, DT, "steps = 2.0: must be a whole number"),
        ("2", DT, "steps = '2': must be a whole number"),
        (2, math.nan, "dt = nan: must be a finite number >= 0"),
        (2, -DT, "dt = -0.01"),
        (2, True, "dt = True: must be"),
        (0, math.inf, "dt = inf: must be"),
    ],
)
def test_bad_input_is_refused(steps: Any, dt: Any, message: str) -> None:
    world = run(resting(), 2, 1.0)
    before = fingerprint(world)
    with pytest.raises(ValueError, match=f"^{message}"):
        world.run(steps, dt)
    assert fingerprint(world) == before


def test_step_refuses_what_equals_a_time_step_but_is_none() -> None:
    world = run(resting(), 2, 1.0)
    with pytest.raises(ValueError, match=r"^dt = True: must be"):
        world.step(True)


@pytest.mark.parametrize("speed", [1e305, 1.5e307])
def test_a_lost_body_is_named_as_in_a_step(speed: float) -> None:
    def falling() -> World:
        world = World(gravity=(0, 0), precision="double", maximum_speed=1e308)
        world.create_body(Circle(0.5), position=(0, 50))
        world.create_body(Circle(0.5), position=(1.0e308, 0), velocity=(speed, 0))
        return world

    stepped, ran = falling(), falling()
    with pytest.raises(StepError, match="stage 'update positions': body 1 is no longer finite") as told:
        run(stepped, 1000, 1.0)
    with pytest.raises(StepError) as same:
        ran.run(1000, 1.0)
    assert str(same.value) == str(told.value)
    assert (ran.step_count, ran.time) == (stepped.step_count, stepped.time)


@compiled
def test_a_body_lost_in_compiled_code(monkeypatch: pytest.MonkeyPatch) -> None:
    def pulled() -> World:
        world = resting(precision="double", gravity=(0, -10), continuous=False)  # what is fast is Python's
        world.run(20, DT)
        world.bodies[1].torque = 1e308
        return world

    stepped, ran = pulled(), pulled()
    with pytest.raises(StepError) as told:
        stepped.step(DT)
    monkeypatch.setattr(World, "_finish_step", lambda *_: pytest.fail("Python took a step"))
    with pytest.raises(StepError) as same:
        ran.run(5, DT)
    assert str(same.value) == str(told.value)
