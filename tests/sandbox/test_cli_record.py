"""`tumble record`: a file only when it is whole, and one clear line for what cannot be."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from typing import Any

import pytest

import recordings
from sandbox.recorder import PartFile
from sandbox.simulation import Simulation
from tests.sandbox.commandline import Tumble, one_line
from tests.sandbox.watching import LARGEST


def test_record(tumble: Tumble, tmp_path: Path) -> None:
    file = tmp_path / "x.rrd"
    code, out, _ = tumble("record", "dominos", "-o", file, "--steps", 50, "--dt", "1/120", "--iterations", 4,
                          "--precision", "double", "--solver", "sequential_impulses")  # fmt: skip
    assert code == 0
    assert out.startswith(f"{file}: 50 steps")
    assert [path.name for path in tmp_path.iterdir()] == ["x.rrd"]
    recording = recordings.read(file)
    assert (recording.scene, recording.dt, len(recording.steps)) == ("The Talk/Dominos", 1 / 120, 50)
    assert (recording.settings["iterations"], recording.settings["precision"]) == (4, "double")
    simulation = Simulation("The Talk/Dominos", 1 / 120, iterations=4, precision="double", solver="sequential_impulses")
    for _ in range(50):
        simulation.step()
    assert recording.state(50).positions.tobytes() == simulation.world.positions.tobytes()


def test_record_as_json(tumble: Tumble, tmp_path: Path) -> None:
    file = tmp_path / "x.rrd"
    code, out, _ = tumble("record", "Teeter", "-o", file, "--json", "-")
    data = json.loads(out)
    assert code == 0
    assert (data["scene"], data["file"], data["steps"]) == ("The Talk/Teeter", str(file), 600)
    assert data["simulated_seconds"] == pytest.approx(10.0)
    assert data["bytes"] == file.stat().st_size
    simulation = Simulation("The Talk/Teeter")
    for _ in range(600):
        simulation.step()
    assert data["state_hash"] == simulation.world.state_hash()


def test_record_writes_a_part_first_and_replaces_an_old_file(
    tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, seen, finish = tmp_path / "x.rrd", [], PartFile.finish
    file.write_text("an old recording")

    def look(self: PartFile) -> Path:
        seen.append((file.read_text(), self.part.exists(), self.part.name))
        return finish(self)

    monkeypatch.setattr(PartFile, "finish", look)
    assert tumble("record", "Teeter", "-o", file, "--steps", 5)[0] == 0
    assert seen == [("an old recording", True, "x.rrd.part")]
    assert len(recordings.read(file).steps) == 5
    assert [path.name for path in tmp_path.iterdir()] == ["x.rrd"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_record_leaves_a_readable_part(
    tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    step = Simulation.step

    def interrupted(self: Simulation) -> None:
        step(self)
        if self.world.step_count == 30 and self.scene.name == "The Talk/Teeter":
            signal.raise_signal(number)

    monkeypatch.setattr(Simulation, "step", interrupted)
    line = one_line(tumble("record", "Teeter", "-o", tmp_path / "x.rrd"))
    assert "interrupted" in line
    assert "x.rrd.part" in line
    assert [path.name for path in tmp_path.iterdir()] == ["x.rrd.part"]
    assert len(recordings.read(tmp_path / "x.rrd.part").steps) == 30
    monkeypatch.undo()
    assert tumble("verify", tmp_path / "x.rrd.part")[:2] == (0, "30 steps identical\n")


def test_a_failing_step_leaves_a_readable_part(tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    step = Simulation.step

    def failing(self: Simulation) -> None:
        if self.world.step_count == 12:
            self.world.bodies[-1].velocity = (LARGEST, 0.0)
            self.world.bodies[-1].force = (LARGEST, 0.0)
        step(self)

    monkeypatch.setattr(Simulation, "step", failing)
    line = one_line(tumble("record", "Teeter", "-o", tmp_path / "x.rrd"))
    assert "no longer finite" in line
    assert len(recordings.read(tmp_path / "x.rrd.part").steps) == 12


def test_a_full_disk_leaves_no_whole_file(tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: PartFile, frame: Any) -> None:
        raise recordings.RecordingError("no space left on the disk")

    monkeypatch.setattr(PartFile, "show", full)
    assert "no space left on the disk" in one_line(tumble("record", "Teeter", "-o", tmp_path / "x.rrd"))
    assert not (tmp_path / "x.rrd").exists()


def test_record_into_what_cannot_be_written(tumble: Tumble, tmp_path: Path) -> None:
    assert "its folder does not exist" in one_line(tumble("record", "Teeter", "-o", tmp_path / "no" / "x.rrd"))
    assert "no file that could be written" in one_line(tumble("record", "Teeter", "-o", tmp_path))
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert "no file that could be written" in one_line(tumble("record", "Teeter", "-o", pipe))
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]
    (tmp_path / "x.rrd.part").mkdir()
    one_line(tumble("record", "Teeter", "-o", tmp_path / "x.rrd", "--steps", 3))


@pytest.mark.parametrize("verb", [["run", "--no-open"], ["record", "-o", "x.rrd"]])
def test_unknown_scene_gets_a_suggestion(tumble: Tumble, verb: list[str]) -> None:
    line = one_line(tumble(*verb, "The Talk/Piramid"))
    assert "no scene 'The Talk/Piramid'" in line
    assert "did you mean 'The Talk/Pyramid'" in line
