"""`tumble run` and `tumble replay`, without waiting for anybody."""

from __future__ import annotations

import signal
import socket
import subprocess
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recordings
from engine import Events, World
from sandbox import cli
from sandbox import commands as ask
from sandbox.recorder import PartFile
from sandbox.session import Session
from sandbox.simulation import Simulation
from sandbox.verbs import replay
from sandbox.verbs import run as run_verb
from sandbox.verbs.run import open_recorder
from tests.sandbox.commandline import VERBS_OF_A_FILE, StoppedAtOnce, Tumble, Visit, one_line
from tests.sandbox.watching import make_unwritable, until
from web import Cost


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
    monkeypatch.setattr(run_verb, "stop_requested", StoppedAtOnce)
    code, out, _ = tumble("run", "Teeter", "--port", 0, "--no-open")
    assert code == 0
    assert visit.url == ""
    assert "http://127.0.0.1:" in out


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
        2: [ask.Set("gravity", (1.0, -4.0)), ask.Set("iterations", 4)],
        5: [ask.Spawn("box", 0.0, 15.0)],
        6: [ask.Set("warm_starting", False), ask.Set("solver", "sequential_impulses")],
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
            if name in ("stage_ms", "content", "bounds", "effects"):
                continue  # a recording does not hold them
            if isinstance(value, Events):
                assert [rows.tobytes() for rows in found.events] == [rows.tobytes() for rows in value]
            elif isinstance(value, np.ndarray):
                assert getattr(found, name).tobytes() == value.tobytes(), name
            else:
                assert getattr(found, name) == value, name
    contents = [frames.frame(index).content for index in range(8)]
    assert len(set(contents[:4])) == 1
    assert len(set(contents[4:])) == 1
    assert contents[3] != contents[4], "a body came"


def test_effects_are_measured_in_a_world_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """That of the scene which runs, with its settings; the session's own is left alone."""
    measured: list[World] = []

    def measure(world: World) -> dict[str, float]:
        measured.append(world)
        return {"gravity": 1.5}

    monkeypatch.setattr(run_verb, "measure", measure)
    monkeypatch.setattr(run_verb, "compile_costs", lambda snapshot: {"friction": 0.5})
    session = Session("The Talk/Teeter", substeps=7)
    first, costs = run_verb.effect_costs(session)
    assert (first["gravity"], first["friction"]) == (Cost(1.5, None), Cost(None, None))
    assert (costs["gravity"], costs["friction"]) == (Cost(1.5, None), Cost(None, 0.5))
    assert set(costs) == {effect.name for effect in session.frame.effects}
    (world,) = measured
    assert (world.body_count, world.substeps, world.step_count) == (5, 7, run_verb.SETTLED)
    assert session.frame.step == 0
