"""Every scene runs and shows what it says; the demos are Box2D Lite's, bit for bit in what they start from."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import recordings
from engine import Box, World
from engine.constants import JOINT_BIAS_FACTOR
from sandbox.lab.references import buckling_height
from sandbox.recorder import PartFile
from sandbox.repeat import repeat
from sandbox.scenes import SCENES, UnknownScene, find_scene, scene
from sandbox.scenes.criterion import Criterion, apply
from sandbox.simulation import TIME_STEP, Simulation
from sandbox.verbs.run import open_recorder
from tests.engine.trajectories import Reference, load, row
from tests.sandbox.watching import PRECISIONS

TALK = "sequential_impulses"
FOLDERS = ("The Talk", "Stacking", "Shapes", "Effects", "Joints", "Continuous", "Events", "Sleeping",
           "Robustness", "Benchmark")  # fmt: skip
BEFORE, STEPS = 60, 60  # that a recording begins, and that are in it
FEW = 4  # of both, of thousands of bodies
CRITERION = Criterion("it is at", lambda world: 0.0, "m", 1.0, at_most=1.0)
DEMOS = {
    "The Talk/Single Box": "demo1_single_box",
    "The Talk/Simple Pendulum": "demo2_simple_pendulum",
    "The Talk/Varying Friction": "demo3_varying_friction",
    "The Talk/Randomized Stacking": "demo4_randomized_stacking",
    "The Talk/Pyramid": "demo5_pyramid",
    "The Talk/Teeter": "demo6_teeter",
    "The Talk/Suspension Bridge": "demo7_suspension_bridge",
    "The Talk/Dominos": "demo8_dominos",
    "The Talk/Multi-Pendulum": "demo9_multi_pendulum",
}

BENCHMARK = {  # bodies and joints: Box2D's, but for the washer's empty body and the six joints between static discs
    "Benchmark/Large Pyramid": (5051, 0), "Benchmark/Many Pyramids": (22001, 0), "Benchmark/Joint Grid": (10000, 19794),
    "Benchmark/Smash": (9601, 0), "Benchmark/Tumbler": (2027, 1), "Benchmark/Compounds": (3001, 0),
    "Benchmark/Junkyard": (8002, 0), "Benchmark/Spinner": (6078, 1), "Benchmark/Washer": (8101, 0),
    "Benchmark/Pile 1000": (1001, 0), "Benchmark/Pile 5000": (5001, 0), "Benchmark/Pile 20000": (20001, 0),
    "Benchmark/Circles 5000": (5001, 0), "Benchmark/Mixed Pile": (3001, 0), "Benchmark/Rain": (2201, 2000),
}  # fmt: skip


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("name", SCENES)
def test_runs_and_stays_finite(name: str, precision: str) -> None:
    simulation = Simulation(name, precision=precision)
    before = row(simulation.world)
    steps = 12 if name.startswith("Benchmark/") else 120  # thousands of bodies
    for _ in range(steps):
        simulation.step()
    state = row(simulation.world)
    assert np.isfinite(state).all()
    assert simulation.world.step_count == steps
    assert np.abs(state - before).max() > 0.01, "nothing happens"


@pytest.mark.parametrize("name", SCENES)
def test_shows_what_it_says(name: str) -> None:
    """With the settings that it asks for; `tumble stability` tries others."""
    entry = SCENES[name]
    assert entry.defaults().solver == "soft_step"
    world = entry.make()
    claims = [criterion.claim(world, TIME_STEP) for criterion in entry.shows]
    readings = apply(entry.shows, world, TIME_STEP)
    missed = [
        f"{claim}: {reading.value:.6g}" for claim, reading in zip(claims, readings, strict=True) if not reading.passed
    ]
    assert not missed


@pytest.mark.parametrize("name", SCENES)
def test_what_is_recorded_is_computed_again(name: str, tmp_path: Path) -> None:
    """Begun while it moves; bit for bit."""
    simulation = Simulation(name)
    large = simulation.world.body_count > 1000
    for _ in range(FEW if large else BEFORE):
        simulation.step()
    file = PartFile(tmp_path / "x.rrd", open_recorder, simulation)
    for _ in range(FEW if large else STEPS):
        simulation.step()
        file.show(simulation.frame())
    recording = recordings.read(file.finish())
    again = list(repeat(recording))
    assert recordings.compare(recording, again) is None
    assert again[-1].step == simulation.world.step_count


@pytest.mark.parametrize("name", SCENES)
def test_is_described(name: str) -> None:
    entry = SCENES[name]
    assert entry.name == name
    assert name.partition("/")[0] in FOLDERS
    assert entry.summary.endswith(".")
    assert entry.view[2] > 0.0
    assert entry.shows
    world = entry.make()
    assert (world.body_count, world.joint_count) == BENCHMARK.get(name, (world.body_count, world.joint_count))
    for criterion in entry.shows:
        assert criterion.after > 0.0
        assert any(math.isfinite(limit) for limit in criterion.limits(world, TIME_STEP))


def test_every_benchmark_is_there() -> None:
    assert {name for name in SCENES if name.startswith("Benchmark/")} == set(BENCHMARK)


def test_scenes_are_listed_by_folder() -> None:
    folders = [name.partition("/")[0] for name in SCENES]
    assert list(dict.fromkeys(folders)) == list(FOLDERS)
    assert folders == sorted(folders, key=FOLDERS.index)


def test_every_effect_of_the_issue_has_a_scene() -> None:
    names = [name.partition("/")[2] for name in SCENES if name.startswith("Effects/")]
    assert set(names) >= {
        "Friction Ramp", "Restitution", "Rolling Resistance", "Conveyor", "Linear Damping", "Angular Damping",
        "Gravity Scale", "Drag", "Wind", "Buoyancy", "Magnets", "Point Gravity", "Explosion", "Filters",
        "Motors",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("name", "effect"),
    [
        ("Friction Ramp", "friction"), ("Restitution", "restitution"), ("Rolling Resistance", "rolling resistance"),
        ("Conveyor", "conveyor"), ("Linear Damping", "linear damping"), ("Angular Damping", "angular damping"),
        ("Gravity Scale", "gravity scale"), ("Drag", "drag"), ("Wind", "wind"), ("Buoyancy", "buoyancy"),
        ("Magnets", "magnets"), ("Point Gravity", "point gravity"), ("Explosion", "explosions"), ("Filters", "filters"),
        ("Motors", "joint motors"),
    ],
)  # fmt: skip
def test_scene_of_an_effect_calls_for_it(name: str, effect: str) -> None:
    found = {status.name: status.called_for for status in find_scene(f"Effects/{name}").make().effects}
    assert found[effect]


def test_the_scene_of_events_calls_for_them() -> None:
    world = find_scene("Events/Hail").make()
    assert [status.name for status in world.effects if status.called_for] == [
        "gravity", "friction", "continuous collision", "events", "sleeping",
    ]  # fmt: skip


@pytest.mark.parametrize("name", [name for name in SCENES if name.startswith("Stacking/Vertical")])
def test_a_stack_without_recycling_is_another_matter(name: str) -> None:
    """What the criterion is worth: it sees a tower that buckles, from Greenhill's 14 boxes on, unless it sleeps."""
    entry = SCENES[name]
    readings = apply(entry.shows, entry.make(recycling=False, sleeping=False), TIME_STEP)
    assert all(reading.passed for reading in readings) is (int(name.split()[-1]) <= buckling_height(30.0))


@pytest.mark.parametrize("name", SCENES)
def test_view_shows_what_moves(name: str) -> None:
    """The camera sees everything that can move, at a screen of 4:3: at once, or when it has fallen in from above."""
    center_x, center_y, height = SCENES[name].view
    world = SCENES[name].make()
    moving = [body for body in world.bodies if body.kind == "dynamic"]
    for body in moving:
        assert abs(body.position.x - center_x) <= height * 4 / 3 / 2, f"{body} is beside the view"
        assert body.position.y >= center_y - height / 2, f"{body} is below the view"
    above = [body for body in moving if body.position.y > center_y + height / 2]
    for _ in range(120 if above else 0):
        world.step(1 / 60)
    for body in above:
        assert abs(body.position.y - center_y) <= height / 2, f"{body} has not fallen into the view"
    assert len(above) <= len(moving) / 4


def test_all_demos_are_there() -> None:
    assert list(SCENES)[: len(DEMOS)] == list(DEMOS)
    assert "The Talk/Circles" in SCENES


def test_circles_has_circles_and_boxes_that_roll() -> None:
    kinds = {type(body.shape).__name__ for body in find_scene("Circles").make().bodies if body.kind == "dynamic"}
    assert kinds == {"Box", "Circle"}


@pytest.mark.parametrize("name", DEMOS)
def test_start_is_box2d_lites_bit_for_bit(name: str) -> None:
    start = load(DEMOS[name]).start
    world = SCENES[name].make(solver=TALK, precision="double")
    found = [
        {
            "width": [body.shape.width, body.shape.height],
            "mass": body.mass if body.kind == "dynamic" else -1,
            "I": body.inertia if body.kind == "dynamic" else -1,
            "friction": body.friction,
            "position": list(body.position),
            "rotation": body.angle,
        }
        for body in world.bodies
        if isinstance(body.shape, Box)
    ]
    still = {"velocity": [0, 0], "angular_velocity": 0}
    assert [{**body, **still} for body in found] == [{**still, **body} for body in start["bodies"]]
    assert all(body.velocity == (0, 0) and body.angular_velocity == 0 for body in world.bodies)
    assert joints_of(world) == [
        {key: joint[key] for key in ("body1", "body2", "localAnchor1", "localAnchor2", "softness", "biasFactor")}
        for joint in start["joints"]
    ]
    settings = world.settings
    assert list(settings.gravity) == start["gravity"]
    assert settings.iterations == start["iterations"]
    assert settings.accumulate_impulses
    assert settings.warm_starting
    assert settings.position_correction


def joints_of(world: World) -> list[dict]:
    """The joints as the references have them; local anchors from a snapshot, which hides nothing."""
    table = world.snapshot().tables["joints.joints"]
    rows = {int(entry["serial"]): entry for entry in table if entry["serial"] >= 0}
    return [
        {
            "body1": joint.body1.serial,
            "body2": joint.body2.serial,
            "localAnchor1": [rows[joint.serial]["anchor1_x"], rows[joint.serial]["anchor1_y"]],
            "localAnchor2": [rows[joint.serial]["anchor2_x"], rows[joint.serial]["anchor2_y"]],
            "softness": joint.softness,
            "biasFactor": JOINT_BIAS_FACTOR if joint.bias_factor is None else joint.bias_factor,
        }
        for joint in world.joints
    ]


@pytest.mark.parametrize("name", ["The Talk/Varying Friction", "The Talk/Dominos", "The Talk/Suspension Bridge"])
def test_goes_box2d_lites_way(name: str) -> None:
    """Through `Simulation`, as everything in the sandbox runs."""
    reference: Reference = load(DEMOS[name])
    simulation = Simulation(name, reference.start["dt"], solver=TALK, precision="double")
    for step in range(1, 301):
        simulation.step()
        error = np.abs(row(simulation.world)[:, :3] - reference.trajectory[step, :, :3]).max()
        assert error < 1e-8, f"step {step}: off by {error:.2g}"


# --- finding ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["The Talk/Pyramid", "the talk/pyramid", "Pyramid", "pYRAMID"])
def test_is_found_by_its_whole_name_or_the_part_after_the_folder(name: str) -> None:
    assert find_scene(name).name == "The Talk/Pyramid"


def test_of_several_of_a_name_the_first_listed_is_found() -> None:
    assert find_scene("compounds").name == "Shapes/Compounds"
    assert find_scene("benchmark/compounds").name == "Benchmark/Compounds"


@pytest.mark.parametrize(("name", "hint"), [("The Talk/Pyramids", "The Talk/Pyramid"), ("Domino", "The Talk/Dominos")])
def test_unknown_name_is_answered_with_those_that_come_close(name: str, hint: str) -> None:
    with pytest.raises(UnknownScene, match=f"did you mean .*'{hint}'"):
        find_scene(name)


@pytest.mark.parametrize("name", ["", "qqqqqqqq", "The Talk/", None, 5, True, ["x"], {}, b"Pyramid", "x" * 100_000])
def test_unknown_name_gets_one_short_line(name: object) -> None:
    with pytest.raises(UnknownScene) as refusal:
        find_scene(name)  # type: ignore[arg-type]
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 300


def test_a_name_is_taken_once() -> None:
    before = dict(SCENES)
    with pytest.raises(ValueError, match="not taken yet"):
        scene("The Talk/Pyramid", shows=CRITERION)(lambda world: None)
    assert before == SCENES


def test_a_new_scene_is_one_function() -> None:
    try:

        @scene("Test/Moon", shows=CRITERION, view=(0.0, 1.0, 2.0), gravity=(0.0, -1.62), iterations=7)
        def moon(world: World) -> None:
            """A box falls slowly.

            More words.
            """
            world.create_body(Box(1, 1), position=(0, 1))

        entry = find_scene("moon")
        assert (entry.summary, entry.view) == ("A box falls slowly.", (0.0, 1.0, 2.0))
        assert entry.shows == (CRITERION,)
        assert entry.make().settings.iterations == 7
        assert entry.make(iterations=3).settings.iterations == 3
        assert entry.make(iterations=3).gravity == (0.0, -1.62)
    finally:
        SCENES.pop("Test/Moon", None)


def test_a_scene_must_show_something() -> None:
    with pytest.raises(ValueError, match="must say what the scene shows"):
        scene("Test/Nothing", shows=())


# --- driving ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name, entry in SCENES.items() if entry.drives])
def test_drives_are_motors_of_the_scene(name: str) -> None:
    entry = SCENES[name]
    joints = entry.make().joints
    for drive in entry.drives:
        assert drive.joints
        assert drive.gain != 0.0
        for serial in drive.joints:
            assert getattr(joints[serial], "motor_speed", None) is not None
        assert all(-1.0 <= value <= 1.0 for value in drive.buttons.values())
        assert set(drive.keys) <= set(drive.buttons)
    labels = [label for drive in entry.drives for label in drive.buttons]
    keys = [key for drive in entry.drives for key in drive.keys.values()]
    assert len(set(labels)) == len(labels)
    assert len(set(keys)) == len(keys)


def test_the_scenes_of_the_issue_can_be_driven() -> None:
    assert {name for name, entry in SCENES.items() if entry.drives} == {
        "Joints/Car", "Joints/Pinball", "Joints/Scissor Lift",
    }  # fmt: skip
