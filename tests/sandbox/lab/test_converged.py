"""Converged references: right where the answer is known, kept on disk, and never taken for what they are not."""

from __future__ import annotations

import math
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from engine import Box, Circle, World
from sandbox.lab import converged
from sandbox.lab.converged import Reference, key_of, reference_of
from sandbox.lab.experiments import CONVERGED, EXPERIMENTS, hard
from sandbox.lab.references import flight, flight_lag
from tests.sandbox.lab.experimenting import empty_world

DT = 1 / 60


@pytest.fixture(autouse=True)
def cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of its own, empty on disk and in memory."""
    monkeypatch.setattr(converged, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(converged, "_memory", {})
    return tmp_path / "cache"


def throw(world: World) -> None:
    world.create_body(Box(1, 1), position=(9, -9), kind="static")
    world.create_body(Circle(0.5), velocity=(1.0, 5.0))


def never(*arguments: object) -> Reference:
    raise AssertionError("it was made again")


# --- what a reference is ----------------------------------------------------------------------------------------------


def test_reference_and_its_uncertainty_are_those_of_a_parabola() -> None:
    reference = reference_of("ball", throw, 0.5)
    t = np.arange(1, 31) * DT
    h = DT / (8 * 32)
    exact = np.array([flight(0.0, 5.0, 10.0, moment) for moment in t])
    lag = np.array([flight_lag(10.0, h, moment) for moment in t])
    assert reference.positions.shape == (30, 1, 2)
    assert reference.positions[:, 0, 0] == pytest.approx(t)
    assert exact - reference.positions[:, 0, 1] == pytest.approx(lag, rel=1e-6)
    assert reference.uncertainty == pytest.approx(lag, rel=1e-6)  # of twice as long steps, twice as much
    assert reference.known(lag[9] * 1.0001) == 10
    assert reference.known(1.0) == 30
    assert reference.known(0.0) == 0


@pytest.mark.parametrize(("parts", "frames"), [(1, range(30)), (4, range(30)), (0.5, range(1, 30, 2))])
def test_distances_are_taken_where_both_have_a_frame(parts: float, frames: range) -> None:
    reference = Reference(np.zeros((30, 2, 2)), np.zeros(30))
    dt = DT / parts
    steps = round(0.5 / dt)
    positions = np.zeros((steps, 2, 2))
    positions[:, 1, 0] = np.arange(1, steps + 1) * dt  # moves away with 1 m/s
    found = reference.distances(positions, dt)
    assert list(np.flatnonzero(np.isfinite(found))) == list(frames)
    assert found[list(frames)] == pytest.approx((np.array(frames) + 1) * DT)
    assert np.isnan(found[sorted(set(range(30)) - set(frames))]).all()
    ended = reference.distances(positions[: steps // 2], dt)  # it stopped half-way: it is lost from there on
    assert np.isinf(ended[15:]).all()
    assert not np.isinf(ended[:14]).any()


# --- the cache --------------------------------------------------------------------------------------------------------


def test_made_once(cache_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = reference_of("ball", throw, 0.2)
    (path,) = cache_folder.iterdir()
    assert path.name.startswith("ball-")
    monkeypatch.setattr(converged, "make", never)
    assert reference_of("ball", throw, 0.2) is first  # from memory
    converged._memory.clear()
    again = reference_of("ball", throw, 0.2)  # from disk
    assert again is not first
    assert np.array_equal(again.positions, first.positions)
    assert np.array_equal(again.uncertainty, first.uncertainty)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 half a file", b"something else"])
def test_damaged_files_are_made_again(content: bytes, cache_folder: Path) -> None:
    first = reference_of("ball", throw, 0.2)
    (path,) = cache_folder.iterdir()
    path.write_bytes(content)
    converged._memory.clear()
    assert np.array_equal(reference_of("ball", throw, 0.2).positions, first.positions)
    converged._memory.clear()
    assert converged.remembered(path) is not None  # and whole again


def test_key_holds_all_that_a_reference_depends_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def faster(world: World) -> None:
        throw(world)
        world.bodies[1].velocity = (1.0, 5.1)

    def rougher(world: World) -> None:
        world.create_body(Box(1, 1), position=(9, -9), kind="static", friction=0.3)
        world.create_body(Circle(0.5), velocity=(1.0, 5.0))

    def lighter(world: World) -> None:
        world.gravity = (0.0, -9.0)
        throw(world)

    keys = [key_of(throw, 0.2), key_of(throw, 0.3), key_of(faster, 0.2), key_of(rougher, 0.2), key_of(lighter, 0.2)]
    assert key_of(throw, 0.2) == keys[0]
    monkeypatch.setattr(converged, "engine_hash", lambda: "another engine")
    keys.append(key_of(throw, 0.2))
    assert len(set(keys)) == 6


def test_engine_hash_is_that_of_its_text(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    before = converged.engine_hash.__wrapped__()
    assert before == converged.engine_hash()
    (tmp_path / "engine").mkdir()
    (tmp_path / "engine" / "__init__.py").write_text("changed = True\n")
    monkeypatch.setattr(converged.engine, "__file__", str(tmp_path / "engine" / "__init__.py"))
    assert converged.engine_hash.__wrapped__() != before


def test_without_a_folder_it_is_kept_in_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setattr(converged, "cache_folder", lambda: tmp_path / "file" / "cache")
    first = reference_of("ball", throw, 0.1)
    monkeypatch.setattr(converged, "make", never)
    assert reference_of("ball", throw, 0.1) is first


@pytest.mark.skipif(sys.platform != "linux", reason="the folder is another one elsewhere")
def test_the_folder_is_the_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.undo()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path))
        assert converged.cache_folder() == tmp_path / "tumble" / "references"
        patch.delenv("XDG_CACHE_HOME")
        patch.setenv("HOME", "/home/somebody")
        assert converged.cache_folder() == Path("/home/somebody/.cache/tumble/references")


# --- the scenes -------------------------------------------------------------------------------------------------------


def test_scenes() -> None:
    asked = {"pyramid", "arch", "card_house", "mass_ratio", "heavy_chain", "ball_and_chain", "bridge_160", "heap"}
    assert set(CONVERGED) >= asked
    assert {name for name, one in EXPERIMENTS.items() if one.prepare is not None} == set(CONVERGED)
    with pytest.raises(ValueError, match="'arch': must be an experiment's name that is not taken yet"):
        hard.converged("arch", "", 1.0, throw)
    for name, one in CONVERGED.items():
        assert one.name == name
        assert one.prepare is not None
        assert {measure.what for measure in one.measures} >= {"distance", "diverged"}


@pytest.mark.parametrize("name", CONVERGED)
def test_what_is_watched(name: str) -> None:
    world = World(precision="double")
    watch = CONVERGED[name].build(world)
    found = watch(world)
    bodies = int((world.body_records()["kind"] == 1).sum())
    assert found.shape == (2 * bodies + hard.OTHERS,)
    assert found[hard.JOINT_ERROR] < 1e-9  # joints begin closed
    history = np.array([found, found + 0.25])
    assert hard.way(history).shape == (2, bodies, 2)
    values = {
        m.what: m.error(history, DT) for m in CONVERGED[name].measures if m.what in ("penetration", "joint error")
    }
    assert all(value == pytest.approx(0.25) for value in values.values())


@pytest.mark.parametrize("name", ["heavy_chain", "ball_and_chain", "hanging_chain", "bridge", "cantilever", "atwood"])
def test_what_hangs_touches_nothing(name: str) -> None:
    world = empty_world()
    EXPERIMENTS[name].build(world)
    for _ in range(90):
        world.step(DT)
        assert len(world.contact_records()) == 0


@cache
def history_of(name: str, substeps: int) -> np.ndarray:
    world = World(precision="double", sleeping=False, substeps=substeps)
    watch = CONVERGED[name].build(world)
    rows = []
    for _ in range(round(CONVERGED[name].seconds * 60)):
        world.step(DT)
        rows.append(watch(world))
    return np.array(rows)


def test_an_arch_comes_nearer_with_every_substep() -> None:
    distance, diverged, *_ = CONVERGED["arch"].measures
    errors = {substeps: distance.error(history_of("arch", substeps=substeps), DT) for substeps in (4, 16)}
    # it sinks by what its contacts give way: a sixteenth with four times the substeps
    assert errors[4] == pytest.approx(16 * errors[16], rel=0.1)
    assert diverged.error(history_of("arch", substeps=16), DT) == 0.0


def test_what_stands_is_still_and_its_contacts_are_complementary() -> None:
    jitter, complementarity = CONVERGED["arch"].measures[-2:]
    history = history_of("arch", substeps=16)
    assert (jitter.what, complementarity.what) == ("jitter", "complementarity")
    assert 0.0 < jitter.error(history, DT) < 1e-4
    assert 0.0 < complementarity.error(history, DT) < 1e-4 * complementarity.scale
    assert history[:10, hard.COMPLEMENTARITY].max() > 1e-3  # while it sinks into its contacts


def test_distance_and_divergence(monkeypatch: pytest.MonkeyPatch) -> None:
    reference = Reference(np.zeros((100, 3, 2)), np.linspace(0.0, 2.0 * hard.CERTAIN, 100))  # 50 are known
    monkeypatch.setattr(hard, "reference_of", lambda *arguments: reference)
    monkeypatch.setattr(hard, "CONVERGED", {})
    monkeypatch.setattr(hard, "EXPERIMENTS", {})
    hard.converged("hand-made", "", 1.0, throw)
    distance, diverged = hard.CONVERGED["hand-made"].measures
    history = np.zeros((100, 3 * 2 + hard.OTHERS))
    history[60:, 2] = 9.0  # when nothing is known any more
    assert distance.error(history, DT) == diverged.error(history, DT) == 0.0
    history[24:, 2] = 0.05
    assert distance.error(history, DT) == pytest.approx(0.05)
    assert diverged.error(history, DT) == 0.0
    history[39:, 3] = 3.0
    assert distance.error(history, DT) == pytest.approx(math.hypot(3.0, 0.05))
    assert diverged.error(history, DT) == pytest.approx(1.0 - 40 / 50)
    history[10, 0] = math.nan
    assert distance.error(history, DT) == math.inf
    assert diverged.error(history, DT) == pytest.approx(1.0 - 11 / 50)


def test_a_heap_is_compared_for_no_longer_than_is_said() -> None:
    heap = CONVERGED["heap"]
    reference = reference_of("heap", hard.fill_heap, heap.seconds)
    assert reference.known(hard.CERTAIN) * DT == pytest.approx(0.45, abs=0.05)
    distance, diverged, *_ = heap.measures
    assert distance.says.endswith("at worst, in the first 0.45 s of 3: of what comes after nothing is known")
    assert diverged.says.startswith("the part of the first 0.45 s of 3, after which nothing is known, after a body")
    assert diverged.against == "about 0.45 s, while the reference is certain"


@pytest.mark.parametrize("name", ["arch", "card_house", "mass_ratio"])
def test_what_stands_is_compared_all_of_the_time(name: str) -> None:
    one = CONVERGED[name]
    reference = one.prepare() if one.prepare else None
    assert isinstance(reference, Reference)
    assert reference.known(hard.CERTAIN) == round(one.seconds / DT)
    assert one.measures[1].against == "all of the time"
