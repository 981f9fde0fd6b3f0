"""`tumble verify`: identical, different, or one clear line."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recordings
from engine import Settings, Snapshot, StepError
from sandbox.commands import Set, SetAll
from sandbox.recorder import PartFile
from sandbox.simulation import Simulation
from sandbox.verbs import replay
from sandbox.verbs.run import open_recorder
from tests.sandbox.commandline import VERBS_OF_A_FILE, StoppedAtOnce, Tumble, Visit, one_line


def test_verify(tumble: Tumble, recorded: Path) -> None:
    assert tumble("verify", recorded)[:2] == (0, "20 steps identical\n")
    code, out, _ = tumble("verify", recorded, "--json", "-")
    assert code == 0
    assert json.loads(out) == {
        "file": str(recorded),
        "scene": "The Talk/Teeter",
        "whole": True,
        "steps": 20,
        "identical": True,
        "difference": None,
    }


def test_verify_tells_the_first_step_body_and_field_that_differ(tumble: Tumble, tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Teeter")
    file = PartFile(tmp_path / "x.rrd", open_recorder, simulation)
    for step in range(1, 21):
        simulation.step()
        frame = simulation.frame()
        if step >= 7:
            angles = np.array(frame.angles)
            angles[3] = np.nextafter(angles[3], 9.0)
            frame = replace(frame, angles=angles)
        file.show(frame)
    file.finish()
    code, out, _ = tumble("verify", tmp_path / "x.rrd")
    assert code == 1
    assert out.startswith("different: step 7, body 3: angle was ")
    assert out.count("\n") == 1
    code, out, _ = tumble("verify", tmp_path / "x.rrd", "--json", "-")
    assert code == 1
    data = json.loads(out)
    assert (data["identical"], data["steps"]) == (False, 20)
    was = simulation_at(7).frame().angles[3]
    expected = {"step": 7, "body": 3, "field": "angle", "recorded": np.nextafter(was, 9.0), "computed": was}
    assert data["difference"] == expected


def simulation_at(step: int) -> Simulation:
    simulation = Simulation("The Talk/Teeter")
    for _ in range(step):
        simulation.step()
    return simulation


def test_verify_tells_at_which_step_the_computing_failed(
    tumble: Tumble, recorded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = Simulation.step

    def failing(self: Simulation) -> None:
        if self.world.step_count == 8 and self.scene.name == "The Talk/Teeter":
            raise StepError("body 3 is no longer finite")
        step(self)

    monkeypatch.setattr(Simulation, "step", failing)
    assert tumble("verify", recorded)[:2] == (1, "different: body 3 is no longer finite\n")
    code, out, _ = tumble("verify", recorded, "--json", "-")
    assert code == 1
    assert json.loads(out)["difference"] == {"step": 9, "message": "body 3 is no longer finite"}


def test_what_is_not_finite_is_text_in_json(tumble: Tumble, tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Teeter")
    file = PartFile(tmp_path / "x.rrd", open_recorder, simulation)
    simulation.step()
    frame = simulation.frame()
    file.show(replace(frame, angles=np.full_like(frame.angles, np.inf)))
    code, out, _ = tumble("verify", file.finish(), "--json", "-")
    assert code == 1
    found = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))["difference"]
    assert (found["field"], found["recorded"], found["computed"]) == ("angle", "inf", 0.0)


@pytest.fixture
def bad_files(tmp_path: Path, recorded: Path) -> dict[str, Path]:
    whole = recorded.read_bytes()
    files = {name: tmp_path / f"{name}.rrd" for name in ("missing", "empty", "foreign", "cut at once", "corrupt")}
    files["empty"].write_bytes(b"")
    files["foreign"].write_bytes(b"GIF89a" * 1000)
    files["cut at once"].write_bytes(whole[:100])
    corrupt = bytearray(whole)
    for place in range(1000, len(corrupt), 997):
        corrupt[place] ^= 0x10
    files["corrupt"].write_bytes(corrupt)
    files["folder"] = tmp_path
    return files


@pytest.mark.parametrize("verb", ["verify", "replay"])
@pytest.mark.parametrize("kind", ["missing", "empty", "foreign", "cut at once", "corrupt", "folder"])
def test_bad_file_gets_one_line(
    tumble: Tumble, bad_files: dict[str, Path], verb: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replay, "stop_requested", StoppedAtOnce)  # should it serve after all
    options = ["--no-open", "--port", "0"] if verb == "replay" else ["--json", "-"]
    assert str(bad_files[kind]) in one_line(tumble(verb, bad_files[kind], *options))


@pytest.mark.parametrize("verb", VERBS_OF_A_FILE)
def test_a_truncated_file_gets_one_line(
    tumble: Tumble, tmp_path: Path, blocks: bytes, verb: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replay, "stop_requested", StoppedAtOnce)  # should it serve after all
    monkeypatch.setattr(replay.subprocess, "run", lambda command, **more: pytest.fail("opened"))
    file = tmp_path / "cut.rrd"
    kept = set()
    for length in (*(int(part * len(blocks)) for part in (0.2, 0.4, 0.5, 0.8, 0.99)), len(blocks) - 1):
        file.write_bytes(blocks[:length])
        line = one_line(tumble(*verb, file))
        steps = len(recordings.read(file).steps)
        if steps:
            assert line == f"tumble: {file}: truncated; its first {steps} steps can be read (--partial takes them)\n"
        else:
            assert line == f"tumble: {file}: truncated; none of its steps can be read\n"
            assert one_line(tumble(*verb, file, "--partial")) == line
        kept.add(steps)
    assert {0, 40} < kept


def test_partial_takes_what_can_be_read(
    tumble: Tumble, tmp_path: Path, blocks: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "cut.rrd"
    file.write_bytes(blocks[: int(0.4 * len(blocks))])
    steps = len(recordings.read(file).steps)
    assert 0 < steps < 40
    assert tumble("verify", file, "--partial")[:2] == (0, f"{steps} steps identical (of a file cut short)\n")
    data = json.loads(tumble("verify", file, "--partial", "--json", "-")[1])
    assert (data["steps"], data["whole"], data["identical"]) == (steps, False, True)
    visit = Visit(monkeypatch)
    assert tumble("replay", file, "--partial", "--port", 0)[0] == 0
    assert "<html" in visit.page
    file.write_bytes(blocks)
    assert tumble("verify", file, "--partial")[:2] == (0, "40 steps identical\n")


def test_a_recording_of_an_older_tumble_is_played_but_not_computed(tumble: Tumble, tmp_path: Path) -> None:
    """Its settings are followed, though commands had other names."""
    older = Path(__file__).parents[1] / "data" / "recordings" / "version1.rrd.gz"
    file = tmp_path / "version1.rrd"
    file.write_bytes(gzip.decompress(older.read_bytes()))
    assert one_line(tumble("verify", file)).endswith("it can be played, but not be computed again\n")
    frames = replay.RecordedFrames(recordings.read(file))
    settings = [frames.frame(index).settings for index in (0, 1)]
    assert [one.gravity for one in settings] == [(0.0, -10.0), (1.0, -9.5)]
    assert [(one.solver, one.iterations) for one in settings] == [("sequential_impulses", n) for n in (10, 7)]
    assert [one.warm_starting for one in settings] == [True, False]


def test_settings_are_followed_one_by_one_or_several_at_once() -> None:
    settings = replay._changed(Settings(), Set("gravity", (1, 2)).to_dict())
    settings = replay._changed(settings, SetAll({"solver": "avbd", "iterations": 7}).to_dict())
    assert (settings.gravity, settings.solver, settings.iterations) == ((1.0, 2.0), "avbd", 7)


def tampered(recording: Any, **changes: Any) -> Callable[[Path], Any]:
    return lambda path: replace(recording, **changes)


@pytest.mark.parametrize(
    "changes",
    [{"snapshot": b"rubbish"}, {"hands": {}}, {"hands": {"bomb": 0, "hands": []}},
     {"commands": {5: ["not a mapping"]}}, {"commands": {5: [{"command": "set_gravity", "x": 1e9, "y": 0}]}}],
)  # fmt: skip
def test_a_recording_that_cannot_be_computed_gets_one_line(
    tumble: Tumble, recorded: Path, monkeypatch: pytest.MonkeyPatch, changes: dict[str, Any]
) -> None:
    """Whole and unharmed, but not of this tumble."""
    monkeypatch.setattr(recordings, "read", tampered(recordings.read(recorded), **changes))
    assert "cannot be computed again" in one_line(tumble("verify", recorded))


def test_a_snapshot_that_no_world_can_have_gets_one_line(
    tumble: Tumble, recorded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = recordings.read(recorded)
    snapshot = Snapshot.from_bytes(recording.snapshot)
    shapes = snapshot.tables["shapes.shapes"].copy()
    shapes["kind"] = 77
    crafted = Snapshot(snapshot.settings, snapshot.tables | {"shapes.shapes": shapes}).to_bytes()
    monkeypatch.setattr(recordings, "read", tampered(recording, snapshot=crafted))
    line = one_line(tumble("verify", recorded))
    assert "cannot be computed again" in line
    assert "shapes.shapes" in line
