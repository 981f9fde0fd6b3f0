"""The verbs, called in this process: exit codes, one clear line, no traceback."""

from __future__ import annotations

import json
import logging
import os
import signal
import socket
import subprocess
import urllib.request
import webbrowser
from collections.abc import Callable
from dataclasses import replace
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recordings
from engine import Snapshot, StepError
from sandbox import cli
from sandbox import commands as ask
from sandbox.recorder import PartFile
from sandbox.scenes import SCENES
from sandbox.simulation import Simulation
from sandbox.verbs import VERBS, replay
from sandbox.verbs import run as run_verb
from sandbox.verbs.run import open_recorder
from tests.sandbox.watching import LARGEST, make_unwritable, until

Result = tuple[int, str, str]
Tumble = Callable[..., Result]


@pytest.fixture
def tumble(capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture) -> Tumble:
    """Runs a command line: its exit code, standard output, standard error."""
    caplog.set_level(logging.CRITICAL)

    def run(*arguments: object) -> Result:
        capsys.readouterr()
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as exit_:  # argparse
            code = int(exit_.code or 0)
        out, err = capsys.readouterr()
        assert "Traceback" not in out + err
        return code, out, err

    return run


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of 20 steps."""
    file = tmp_path_factory.mktemp("recorded") / "teeter.rrd"
    assert cli.main(["record", "Teeter", "-o", str(file), "--steps", "20"]) == 0
    return file


def one_line(result: Result) -> str:
    """The one line of a refusal."""
    code, out, err = result
    assert (code, out) == (2, ""), result
    assert err.startswith("tumble: ")
    assert err.count("\n") == 1
    assert err.endswith("\n")
    return err


def usage_error(result: Result) -> str:
    """The one line about wrong arguments."""
    code, out, err = result
    assert (code, out) == (2, ""), result
    assert err.startswith("tumble")
    (line,) = err.splitlines()
    return line


# --- the command ------------------------------------------------------------------------------------------------------


def test_help_names_every_verb(tumble: Tumble) -> None:
    code, out, _ = tumble("--help")
    assert code == 0
    for verb in VERBS:
        assert f"\n    {verb.NAME} " in out
        code, text, _ = tumble(verb.NAME, "--help")
        assert code == 0
        assert (verb.__doc__ or "").split("\n")[0] in text


def test_version(tumble: Tumble) -> None:
    assert tumble("--version")[:2] == (0, "tumble 0.1.0\n")


@pytest.mark.parametrize("arguments", [[], ["fly"], ["run", "--nope"], ["record", "Teeter"], ["verify"], ["replay"]])
def test_wrong_usage(tumble: Tumble, arguments: list[str]) -> None:
    usage_error(tumble(*arguments))


@pytest.mark.parametrize(
    ("option", "value"),
    [("--dt", text) for text in ("0", "-1/60", "nan", "inf", "1/0", "1e400", "1e999999999", "0/0", "x", "", "2", "1/",
                                 "1e-6", "1/60/2", "9" * 5000)]
    + [("--steps", text) for text in ("0", "-1", "1.5", "x", "", "10000001", "9" * 5000)]
    + [("--iterations", text) for text in ("0", "-1", "nan", "1e9", "10000000000")]
    + [("--solver", "magic"), ("--precision", "half")],
)  # fmt: skip
def test_wrong_options(tumble: Tumble, tmp_path: Path, option: str, value: str) -> None:
    line = usage_error(tumble("record", "Teeter", "-o", tmp_path / "x.rrd", f"{option}={value}"))
    assert option in line
    assert list(tmp_path.iterdir()) == []


# --- scenes -----------------------------------------------------------------------------------------------------------


def test_scenes_lists_all(tumble: Tumble) -> None:
    code, out, err = tumble("scenes")
    assert (code, err) == (0, "")
    for name in SCENES:
        assert name in out
    assert "\x1b" not in out


def test_scenes_as_json(tumble: Tumble, tmp_path: Path) -> None:
    code, out, err = tumble("scenes", "--json", "-")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert [entry["scene"] for entry in data] == list(SCENES)
    assert data[4] == {
        "scene": "The Talk/Pyramid",
        "bodies": 79,
        "joints": 0,
        "summary": "Seventy-eight boxes fall into a pyramid of base twelve.",
    }
    code, out, _ = tumble("scenes", "--json", tmp_path / "scenes.json")
    assert code == 0
    assert "The Talk/Pyramid" in out
    assert json.loads((tmp_path / "scenes.json").read_text()) == data


def test_json_that_cannot_be_written(tumble: Tumble, tmp_path: Path) -> None:
    code, _, err = tumble("scenes", "--json", tmp_path / "no" / "folder.json")
    assert code == 2
    assert err.count("\n") == 1
    assert "cannot be written" in err


# --- record -----------------------------------------------------------------------------------------------------------


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
    simulation = Simulation("The Talk/Dominos", 1 / 120, iterations=4, precision="double")
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


# --- verify -----------------------------------------------------------------------------------------------------------


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
    monkeypatch.setattr(replay, "stop_requested", _stopped_at_once)  # should it serve after all
    options = ["--no-open", "--port", "0"] if verb == "replay" else ["--json", "-"]
    assert str(bad_files[kind]) in one_line(tumble(verb, bad_files[kind], *options))


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a recording of 40 steps in several blocks."""
    file = tmp_path_factory.mktemp("blocks") / "teeter.rrd"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("recordings.mailbox.BLOCK_BYTES", 20_000)
        assert cli.main(["record", "Teeter", "-o", str(file), "--steps", "40"]) == 0
    return file.read_bytes()


VERBS_OF_A_FILE = [["verify"], ["replay", "--no-open", "--port", "0"], ["replay", "--viewer", "rerun"]]


@pytest.mark.parametrize("verb", VERBS_OF_A_FILE)
def test_a_truncated_file_gets_one_line(
    tumble: Tumble, tmp_path: Path, blocks: bytes, verb: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replay, "stop_requested", _stopped_at_once)  # should it serve after all
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


def tampered(recording: Any, **changes: Any) -> Callable[[Path], Any]:
    return lambda path: replace(recording, **changes)


@pytest.mark.parametrize(
    "changes",
    [{"snapshot": b"rubbish"}, {"hands": {}}, {"hands": {"bomb": 0, "hands": []}}, {"settings": {"precision": "half"}},
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
    bodies = snapshot.tables["bodies.bodies"].copy()
    bodies["shape_kind"] = 77
    crafted = Snapshot(snapshot.settings, snapshot.tables | {"bodies.bodies": bodies}).to_bytes()
    monkeypatch.setattr(recordings, "read", tampered(recording, snapshot=crafted))
    line = one_line(tumble("verify", recorded))
    assert "cannot be computed again" in line
    assert "bodies.bodies" in line


# --- run and replay ---------------------------------------------------------------------------------------------------


class Visit:
    """Stands in for the browser: looks at the page once, then ends the server as Ctrl-C would."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, number: signal.Signals = signal.SIGINT) -> None:
        self.url = self.page = ""
        self._number = number
        monkeypatch.setattr(webbrowser, "open", self)

    def __call__(self, url: str) -> bool:
        with urllib.request.urlopen(url, timeout=10) as answer:
            assert answer.status == 200
            self.page = answer.read().decode()
        self.url = url
        signal.raise_signal(self._number)
        return True


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_run_serves_opens_a_browser_and_ends_cleanly(
    tumble: Tumble, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, number: signal.Signals
) -> None:
    started: list[Any] = []

    class Noted(run_verb.Session):
        def start(self) -> None:
            started.append(self)
            super().start()

    monkeypatch.setattr(run_verb, "Session", Noted)
    visit = Visit(monkeypatch, number)
    code, out, _ = tumble("run", "--port", 0, "--iterations", 5, "--record-dir", tmp_path)
    assert code == 0
    assert visit.url.startswith("http://127.0.0.1:")
    assert visit.url in out
    assert "<html" in visit.page
    assert started[0].frame.scene == "The Talk/Pyramid", "the one it begins with"
    assert started[0].frame.settings.iterations == 5


def test_run_finishes_the_recording_under_way(tumble: Tumble, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    class Records(run_verb.Session):
        def start(self) -> None:
            super().start()
            self.submit(ask.StartRecording())
            until(lambda: self.frame.status.recording and self.frame.step > 5)

    monkeypatch.setattr(run_verb, "Session", Records)
    Visit(monkeypatch)
    assert tumble("run", "Teeter", "--port", 0, "--record-dir", tmp_path)[0] == 0
    (file,) = tmp_path.iterdir()
    assert file.suffix == ".rrd"
    code, out, _ = tumble("verify", file)
    assert code == 0
    assert out.endswith(" steps identical\n")


def test_run_without_a_browser(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    visit = Visit(monkeypatch)
    monkeypatch.setattr(run_verb, "stop_requested", _stopped_at_once)
    code, out, _ = tumble("run", "Teeter", "--port", 0, "--no-open")
    assert code == 0
    assert visit.url == ""
    assert "http://127.0.0.1:" in out


class _stopped_at_once:
    """sandbox.signals.stop_requested, after a Ctrl-C."""

    requested = True

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def wait(self) -> None:
        pass


def test_run_with_a_folder_that_cannot_be_written_runs_all_the_same(
    tumble: Tumble, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    Visit(monkeypatch)
    assert tumble("run", "Teeter", "--port", 0, "--record-dir", make_unwritable(tmp_path))[0] == 0


@pytest.mark.parametrize("verb", ["run", "replay"])
def test_a_busy_port_gets_one_line(tumble: Tumble, recorded: Path, verb: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as busy:
        port = busy.getsockname()[1]
        what = ["run", "Teeter"] if verb == "run" else ["replay", recorded]
        line = one_line(tumble(*what, "--no-open", "--port", port))
    assert f"port {port}" in line
    assert "already in use" in line


@pytest.mark.parametrize("host", ["256.1.1.1", "no.such.host.invalid", "203.0.113.7"])
def test_a_host_that_is_not_ours_gets_one_line(tumble: Tumble, host: str) -> None:
    one_line(tumble("run", "Teeter", "--no-open", "--host", host, "--port", 0))


def test_replay_serves_the_recording(tumble: Tumble, monkeypatch: pytest.MonkeyPatch, recorded: Path) -> None:
    visit = Visit(monkeypatch)
    code, out, _ = tumble("replay", recorded, "--port", 0)
    assert code == 0
    assert visit.url in out
    assert "<html" in visit.page


@pytest.mark.parametrize("verb", VERBS_OF_A_FILE)
@pytest.mark.parametrize("more", [[], ["--partial"]])
def test_a_recording_of_no_step_gets_one_line(tumble: Tumble, tmp_path: Path, verb: list[str], more: list[str]) -> None:
    file = PartFile(tmp_path / "x.rrd", open_recorder, Simulation("The Talk/Teeter")).finish()
    assert one_line(tumble(*verb, file, *more)) == f"tumble: {file}: holds no step\n"


def test_replay_in_the_rerun_viewer(tumble: Tumble, monkeypatch: pytest.MonkeyPatch, recorded: Path) -> None:
    called = []

    class Ended:
        returncode = 0

    run = subprocess.run
    monkeypatch.setattr(replay.subprocess, "run", lambda command, **more: called.append(command) or Ended)
    assert tumble("replay", recorded, "--viewer", "rerun")[0] == 0
    assert called[0][1:] == ["--bind", "127.0.0.1", str(recorded)], "not for other machines to reach"
    assert run([*called[0][:-1], "--version"], capture_output=True, check=False).returncode == 0


def test_rerun_is_handed_what_it_would_not_open_by_its_path(
    tumble: Tumble, monkeypatch: pytest.MonkeyPatch, recorded: Path, blocks: bytes, tmp_path: Path
) -> None:
    called = []

    def run(command: list[str], stdin: Any, **_: Any) -> Any:
        called.append((command[-1], stdin.read()))
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(replay.subprocess, "run", run)
    cut, interrupted = tmp_path / "cut.rrd", tmp_path / "x.rrd.part"
    cut.write_bytes(blocks[: int(0.4 * len(blocks))])
    interrupted.write_bytes(blocks)
    assert tumble("replay", cut, "--partial", "--viewer", "rerun")[0] == 0
    assert tumble("replay", interrupted, "--viewer", "rerun")[0] == 0
    assert called == [("-", cut.read_bytes()), ("-", blocks)]


LOG = """\
\x1b[2m2026-01-01T00:00:00Z\x1b[0m \x1b[32m INFO\x1b[0m \x1b[2mre_grpc_server\x1b[0m: Listening on 127.0.0.1:9876.
\x1b[31mError: winit: os error at /src/winit-0.30.13/src/linux/mod.rs:765: DISPLAY is not set.\x1b[0m
note: run with `RUST_BACKTRACE=1`
"""


@pytest.mark.parametrize(
    ("log", "reason"),
    [(LOG, "winit: os error: DISPLAY is not set."), ("one\nlast words\n\n", "last words"), ("", "exit code 1")],
)
def test_a_rerun_viewer_that_fails_gets_one_line(
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    recorded: Path,
    tmp_path: Path,
    log: str,
    reason: str,
) -> None:
    package = tmp_path / "rerun_cli"
    package.mkdir()
    (package / "log").write_text(log)
    viewer = package / "rerun"
    viewer.write_text(f'#!/bin/sh\ncat "{package}/log" >&2\nexit 1\n')
    viewer.chmod(0o755)
    monkeypatch.setattr(replay, "find_spec", lambda name: ModuleSpec(name, None, origin=str(package / "__init__.py")))
    capfd.readouterr()  # not capsys: the viewer would write past it
    code = cli.main(["replay", str(recorded), "--viewer", "rerun"])
    assert (code, *capfd.readouterr()) == (2, "", f"tumble: the rerun viewer failed: {reason}\n")


def test_replayed_frames_are_the_recorded_ones(tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Circles")
    file = PartFile(tmp_path / "x.rrd", open_recorder, simulation)
    expected = []
    given: dict[int, list[Any]] = {
        2: [ask.SetGravity(1.0, -4.0), ask.SetIterations(4)],
        5: [ask.Spawn("box", 0.0, 15.0)],
        6: [ask.SetSwitch("warm_starting", False), ask.SetSolver("sequential_impulses")],
    }
    for step in range(1, 9):
        for command in given.get(step, []):
            simulation.apply(command)
        simulation.step()
        expected.append(simulation.frame(tuple(command.to_dict() for command in given.get(step, []))))
        file.show(expected[-1])
    frames = replay.RecordedFrames(recordings.read(file.finish()))
    assert len(frames) == len(expected)
    for index, frame in enumerate(expected):
        found = frames.frame(index)
        for name, value in vars(frame).items():
            if isinstance(value, np.ndarray):
                assert getattr(found, name).tobytes() == value.tobytes(), name
            elif name not in ("stage_ms", "content"):
                assert getattr(found, name) == value, name
    contents = [frames.frame(index).content for index in range(8)]
    assert len(set(contents[:4])) == 1
    assert len(set(contents[4:])) == 1
    assert contents[3] != contents[4], "a body came"


# --- warmup -----------------------------------------------------------------------------------------------------------


def test_warmup_leaves_nothing_to_compile(tumble: Tumble) -> None:
    assert tumble("warmup")[0] == 0
    code, out, err = tumble("warmup", "--json", "-")
    assert (code, err) == (0, "")
    assert json.loads(out)["kernels_compiled"] == 0
