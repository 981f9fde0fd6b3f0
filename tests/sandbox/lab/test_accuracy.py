"""`tumble accuracy`: what is swept, rows and their costs, the budget, workers that die, and the command."""

from __future__ import annotations

import json
import math
import os
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from engine import SOLVERS, Circle, Settings, TooLarge, World
from sandbox.lab.accuracy import (
    KEYS,
    Outcome,
    Point,
    Row,
    Series,
    Setting,
    all_series,
    over,
    passes,
    plan,
    series_of,
    sweep,
)
from sandbox.lab.accuracy.runs import begin, cost, follow
from sandbox.lab.accuracy.series import missing, peer_series
from sandbox.lab.accuracy.tasks import measure
from sandbox.lab.accuracy.workers import Cluster, Processes, Threads
from sandbox.lab.experiments import EXPERIMENTS
from tests.sandbox.commandline import Tumble, one_line, usage_error

TINY = (
    Series("soft_step, substeps", "soft_step", over("substeps", (1, 4))),
    Series("sequential_impulses, iterations", "sequential_impulses", over("iterations", (1,))),
)
SLIDING, BOUNCE = EXPERIMENTS["sliding"], EXPERIMENTS["bounce"]


@pytest.fixture
def tiny(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command, with next to nothing to measure, in this process."""
    monkeypatch.setattr("sandbox.verbs.accuracy.all_series", lambda *names: TINY)
    monkeypatch.setattr("sandbox.verbs.accuracy.Processes", Threads)


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    told: list[tuple[int, int]] = []
    found = sweep(
        [SLIDING, BOUNCE], TINY, Threads(), repeats=2, progress=lambda done, total, _: told.append((done, total))
    )
    assert told[-1] == (5, 5)
    return found


@pytest.fixture(scope="module")
def rows(outcome: Outcome) -> list[Row]:
    return outcome.rows


# --- what is swept ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_lines_follow_from_what_a_solver_has(name: str) -> None:
    solver = SOLVERS[name]
    lines = series_of(solver)
    varied = [line.name.removeprefix(f"{name}, ") for line in lines]
    assert ("substeps" in varied) == solver.has_substeps
    assert "steps in 1/60 s" in varied
    assert {line.precision for line in lines} == {"single", "double"}
    assert ("substeps" in missing(name)) == (not solver.has_substeps)
    found = [(setting.dt, line.world(setting).settings) for line in lines for setting in line.settings]
    assert all(found.count(one) == 1 for one in found)  # each is run once
    assert any(dt == 1 / 60 and settings == Settings(sleeping=False, solver=name) for dt, settings in found)


def test_a_new_solver_appears_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    new = replace(SOLVERS["soft_step"], name="new")
    monkeypatch.setitem(SOLVERS, "new", new)
    assert any(line.solver == "new" for line in all_series(SOLVERS))


def test_coarse_settings_of_all_come_before_finer_ones_of_any() -> None:
    tasks = list(plan([SLIDING, BOUNCE], all_series(["soft_step"])))
    assert [task.level for task in tasks] == sorted(task.level for task in tasks)
    assert {task.scene for task in tasks if task.level == 0} == {"sliding", "bounce"}
    coarse = {point.setting.label for task in tasks if task.level == 0 for point in task.points}
    assert coarse == {"1", "4", "16"}


def test_a_peer_has_its_own_knob() -> None:
    assert [line.name for line in peer_series("pymunk")] == ["pymunk, iterations", "pymunk, steps in 1/60 s"]
    assert "iterations" in missing("pyb2d3")


# --- rows -------------------------------------------------------------------------------------------------------------


def test_a_row_a_setting_and_measure(outcome: Outcome) -> None:
    assert [(row.scene, row.solver, row.label) for row in outcome.rows] == [
        ("sliding", "soft_step", "1"),
        ("sliding", "soft_step", "4"),
        ("sliding", "sequential_impulses", "1"),
        ("bounce", "soft_step", "1"),
        ("bounce", "soft_step", "4"),
    ]
    assert outcome.refused == {("bounce", "sequential_impulses"): "it has no restitution"}
    assert all(row.cost_ms > 0 and row.spread_ms >= 0 for row in outcome.rows)
    assert outcome.rows[0].error > 3 * outcome.rows[1].error
    assert not outcome.left
    assert not outcome.failures


def test_settings_say_what_it_was_run_with(rows: list[Row]) -> None:
    dt = pytest.approx(1 / 60)
    assert rows[1].settings == {"dt": dt, "substeps": 4, "iterations": 1, "stiffness": "follows"}
    assert rows[2].settings == {"dt": dt, "iterations": 1}
    assert {row.precision for row in rows} == {"single"}
    assert [row.setting for row in rows[:3]] == ["1 substeps", "4 substeps", "1 iterations"]
    many = replace(rows[1], settings={**rows[1].settings, "iterations": 2, "dt": 1 / 240}, precision="double")
    assert many.setting == "4 substeps, 2 iterations, dt 1/240, double"


def test_solves_are_passes_times_contacts(rows: list[Row]) -> None:
    # 60 boxes with two contacts each, in 180 steps: one pass, or one with bias and one without in each substep
    contacts = 60 * 2 * 180
    assert rows[0].solves == pytest.approx(2 * contacts, rel=0.02)
    assert rows[1].solves == pytest.approx(8 * contacts, rel=0.02)
    assert rows[2].solves == pytest.approx(contacts, rel=0.02)


@pytest.mark.parametrize(
    ("settings", "count"),
    [
        ({}, 8),
        ({"substeps": 3, "iterations": 2}, 12),
        ({"solver": "sequential_impulses"}, 10),
    ],
)
def test_passes(settings: dict, count: int) -> None:
    assert passes(World(**settings)) == count


def test_shorter_steps_are_more_of_them() -> None:
    series = Series("", "sequential_impulses", (Setting("4", {"iterations": 1}, 4),))
    (row,) = sweep([SLIDING], [series], Threads(), repeats=1).rows
    assert row.settings["dt"] == pytest.approx(1 / 240)
    assert row.solves == pytest.approx(4 * 60 * 2 * 180, rel=0.02)


def test_a_lost_run_has_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def build(world: World) -> Any:
        world.create_body(Circle(0.5))

        def watch(world: World) -> Any:
            world._state.bodies.tables["motions"]["vx"][0] = math.nan
            return world.positions[0]

        return watch

    lost = replace(SLIDING, build=build)
    monkeypatch.setitem(EXPERIMENTS, "sliding", lost)
    outcome = sweep([lost], TINY[:1], Threads(), repeats=1)
    assert [row.error for row in outcome.rows] == [math.inf, math.inf]
    assert {row.to_dict()["error"] for row in outcome.rows} == {None}


def test_what_is_timed_is_the_run_that_was_watched() -> None:
    """Taken back to its start it goes the same way: bit by bit."""
    for solver in SOLVERS:
        run = begin(EXPERIMENTS["pendulum"], Point(Series("", solver, ()), Setting("", {})))
        followed = follow(run)
        ended = run.world.state_hash()
        assert cost(run) > 0
        assert run.world.state_hash() == ended
        assert len(followed.history) == run.world.step_count


def test_what_a_solver_refuses_is_not_applicable(monkeypatch: pytest.MonkeyPatch) -> None:
    refused = replace(SLIDING, build=lambda world: world.set(substeps=7))
    monkeypatch.setitem(EXPERIMENTS, "sliding", refused)
    outcome = sweep([refused], TINY[1:], Threads(), repeats=1)
    assert not outcome.rows
    assert "substeps = 7" in outcome.refused["sliding", "sequential_impulses"]


def test_what_is_too_large_for_a_solver_is_not_applicable_and_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(world: World, dt: float) -> None:
        raise TooLarge("too much of it")

    monkeypatch.setattr(World, "step", refuse)
    outcome = sweep([SLIDING], TINY[1:], Threads(), repeats=1)
    assert not outcome.rows
    assert outcome.refused["sliding", "sequential_impulses"] == "too much of it"


def test_json_has_these_keys(rows: list[Row]) -> None:
    assert KEYS == ("scene", "solver", "settings", "precision", "measure", "error", "cost_ms", "solves")
    for row in rows:
        data = row.to_dict()
        assert tuple(data) == KEYS
        assert json.loads(json.dumps(data, allow_nan=False)) == data


# --- the budget and those who work ------------------------------------------------------------------------------------


class Slow(Threads):
    """Each task takes a while before it begins."""

    def submit(self, function: Any, *arguments: Any) -> Any:
        time.sleep(0.3)
        return super().submit(function, *arguments)


def test_the_budget_is_kept_and_what_was_left_out_is_counted() -> None:
    series = all_series(["soft_step", "sequential_impulses"])
    started = time.monotonic()
    outcome = sweep([SLIDING, BOUNCE], series, Slow(), seconds=0.4, repeats=1)
    assert time.monotonic() - started < 20
    total = sum(len(task.points) for task in plan([SLIDING, BOUNCE], series))
    assert len(outcome.rows) + sum(outcome.left.values()) == total
    assert sum(outcome.left.values()) > total / 2


def test_a_task_without_time_measures_nothing() -> None:
    task = next(plan([SLIDING], TINY))
    result = measure(task, -1.0)
    assert not result.rows
    assert result.left == len(task.points)


def test_a_run_that_takes_too_long_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.accuracy.tasks.LONGEST", -1.0)
    outcome = sweep([SLIDING], TINY[:1], Threads(), repeats=1)
    assert not outcome.rows
    assert sum(outcome.left.values()) == 2


def test_a_slow_run_is_timed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.accuracy.tasks.ONCE", 0.0)
    outcome = sweep([SLIDING], TINY[:1], Threads(), repeats=3)
    assert [row.spread_ms for row in outcome.rows] == [0.0, 0.0]


def test_what_a_scene_is_compared_with_is_made_first_and_once() -> None:
    made: list[str] = []
    compared = replace(SLIDING, prepare=lambda: made.append("sliding"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(EXPERIMENTS, "sliding", compared)
        assert len(sweep([compared, BOUNCE], TINY[:1], Threads(), repeats=1).rows) == 4
        assert made == ["sliding"]
        patch.setitem(EXPERIMENTS, "sliding", replace(compared, prepare=lambda: 1 / 0))
        outcome = sweep([EXPERIMENTS["sliding"], BOUNCE], TINY[:1], Threads(), repeats=1)
    assert {row.scene for row in outcome.rows} == {"bounce"}
    assert outcome.failures == ["sliding: ZeroDivisionError: division by zero"]
    assert sum(outcome.left.values()) == 2


class Dying(Threads):
    """The worker dies at some tasks, as a process does that was killed."""

    def __init__(self, deaths: int) -> None:
        super().__init__()
        self.deaths, self.restarts = deaths, 0

    def submit(self, function: Any, *arguments: Any) -> Any:
        if self.deaths:
            self.deaths -= 1
            return super().submit(_die)
        return super().submit(function, *arguments)

    def restart(self) -> None:
        self.restarts += 1


def _die() -> None:
    raise BrokenProcessPool("a process in the process pool was terminated abruptly")


def test_a_task_whose_worker_died_is_given_to_another() -> None:
    outcome = sweep([SLIDING], TINY, Dying(1), repeats=1)
    assert len(outcome.rows) == 3
    assert not outcome.failures


def test_a_task_that_kills_two_workers_is_left_out_and_named() -> None:
    outcome = sweep([SLIDING], TINY, Dying(2), repeats=1)
    assert len(outcome.rows) + sum(outcome.left.values()) == 3
    assert outcome.failures == ["sliding: its worker died, and another one with it"]


def test_what_a_worker_raises_is_a_line_and_the_others_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def build(world: World) -> Any:
        raise RuntimeError("first\nsecond") if world.iterations == 1 and world.substeps == 1 else ValueError("no")

    broken = replace(SLIDING, build=build)
    monkeypatch.setitem(EXPERIMENTS, "sliding", broken)
    outcome = sweep([broken], TINY[:1], Threads(), repeats=1)
    assert outcome.failures == ["sliding, soft_step, substeps 1: RuntimeError: first"]


def test_processes_measure_and_survive_a_kill() -> None:
    """One sweep in real processes, of which one is killed as soon as it is there."""
    workers = _Killed(1)
    outcome = sweep([SLIDING], TINY[:1], workers, repeats=1)
    assert workers.killed
    assert [row.label for row in outcome.rows] == ["1", "4"]
    assert [row.solves for row in outcome.rows] == [
        row.solves for row in sweep([SLIDING], TINY[:1], Threads(), repeats=1).rows
    ]


class _Killed(Processes):
    killed = False

    def submit(self, function: Any, *arguments: Any) -> Any:
        future = super().submit(function, *arguments)
        if not self.killed:
            self.killed = True
            for number in list(self._executor._processes or {}):
                os.kill(number, signal.SIGKILL)
        return future


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """The address of a Dask cluster on this machine, of one worker with two threads."""
    distributed = pytest.importorskip("distributed")
    local = distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None, protocol="tcp", host="127.0.0.1"
    )  # fmt: skip
    with local:
        yield local.scheduler_address


def test_a_cluster_measures_the_same(cluster: str, rows: list[Row]) -> None:
    workers = Cluster(cluster)
    assert workers.slots == 1  # however many threads it has: timed runs must not disturb each other
    found = sweep([SLIDING], TINY, workers, repeats=1).rows
    assert [(row.series, row.label, row.error, row.solves) for row in found] == [
        (row.series, row.label, row.error, row.solves) for row in rows if row.scene == "sliding"
    ]


# --- the command ------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("tiny")
def test_command_writes_json_and_folder(tumble: Tumble, tmp_path: Path) -> None:
    folder, file = tmp_path / "new" / "folder", tmp_path / "rows.json"
    code, out, _ = tumble("accuracy", "ballistic", "sliding", "-o", folder, "--json", file)
    assert code == 0
    assert "ballistic" in out
    assert "[m]" in out
    data = json.loads(file.read_text())
    assert [(row["scene"], row["measure"]) for row in data[::3]] == [
        ("ballistic", "height [m]"),
        ("sliding", "distance [m]"),
    ]
    assert all(tuple(row) == KEYS for row in data)
    assert sorted(path.name for path in folder.iterdir()) == ["accuracy", "accuracy.html", "accuracy.md"]
    pictures = ["ballistic.png", "ballistic.svg", "sliding.png", "sliding.svg"]
    assert sorted(path.name for path in (folder / "accuracy").iterdir()) == pictures


@pytest.mark.usefixtures("tiny")
def test_command_keeps_what_is_written_by_hand(tumble: Tumble, tmp_path: Path) -> None:
    page = tmp_path / "accuracy.md"
    page.write_text("Words.\n<!-- tumble accuracy -->\nfrom before\n<!-- end of tumble accuracy -->\nMore words.\n")
    assert tumble("accuracy", "ballistic", "-o", tmp_path)[0] == 0
    text = page.read_text()
    assert text.startswith("Words.\n")
    assert text.endswith("\nMore words.\n")
    assert "from before" not in text
    assert "| ballistic" in text


@pytest.mark.usefixtures("tiny")
def test_json_on_standard_output_stands_alone(tumble: Tumble) -> None:
    code, out, _ = tumble("accuracy", "ballistic", "--json", "-")
    assert code == 0
    assert {row["scene"] for row in json.loads(out)} == {"ballistic"}


@pytest.mark.parametrize("name", ["balistic", "Pyramid", "", "x" * 10_000, "ballistic\nbounce"])
def test_unknown_scene_is_one_short_line(tumble: Tumble, name: str) -> None:
    line = one_line(tumble("accuracy", "bounce", name))
    assert "there is no scene" in line
    assert len(line) < 600


def test_a_close_name_is_offered(tumble: Tumble) -> None:
    assert "did you mean 'ballistic'?" in one_line(tumble("accuracy", "balistic"))
    assert "did you mean 'soft_step'?" in one_line(tumble("accuracy", "--solvers", "soft"))


@pytest.mark.parametrize("budget", ["0", "-1", "nan", "inf", "soon", "1e7"])
def test_a_wrong_budget_is_one_line(tumble: Tumble, budget: str) -> None:
    assert "must be seconds above 0" in usage_error(tumble("accuracy", f"--budget={budget}"))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "", "tcp://127.0.0.1:999999", "bogus://x:1"])
def test_a_cluster_that_is_not_there_is_one_line(tumble: Tumble, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.accuracy.workers.CONNECTING", 0.5)
    assert f"--dask {address}: no Dask scheduler answers there" in one_line(tumble("accuracy", "--dask", address))


@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:1"])
def test_a_cluster_that_is_not_there_leaves_nothing_to_complain_later(address: str) -> None:
    """As a process: what is collected at its end must neither wait nor tell of itself."""
    command = [sys.executable, "-m", "sandbox.cli", "accuracy", "ballistic", "--dask", address]
    ended = subprocess.run(command, capture_output=True, text=True, cwd=Path(__file__).parents[3], check=False)
    assert "no Dask scheduler answers there" in one_line((ended.returncode, ended.stdout, ended.stderr))


def test_what_answers_but_is_no_scheduler_is_one_line(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.accuracy.workers.CONNECTING", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as mute:
        address = f"tcp://127.0.0.1:{mute.getsockname()[1]}"
        assert "it kept silent for 0.5 s" in one_line(tumble("accuracy", "--dask", address))


@pytest.mark.usefixtures("tiny")
def test_no_time_for_a_single_run_is_one_line(tumble: Tumble) -> None:
    code, out, err = tumble("accuracy", "ballistic", "--budget", "1e-6")
    assert (code, out) == (2, "")
    assert "nothing was measured: no run ended within 1e-06 s; give it a larger --budget" in err.splitlines()[-1]


@pytest.mark.usefixtures("tiny")
@pytest.mark.parametrize(
    ("outcome", "says"),
    [
        ({"compiled": 7}, "all of the 9 s went into compiling 7 kernels; compiled code is kept, so run it once more"),
        ({"unprepared": [""]}, "all of the 9 s went into compiling; compiled code is kept, so run it once more"),
        ({"unprepared": ["sliding"]}, "making what sliding is compared with took all of the 9 s; give it a larger"),
    ],
)
def test_where_the_time_went_is_told(
    tumble: Tumble, monkeypatch: pytest.MonkeyPatch, outcome: dict[str, Any], says: str
) -> None:
    found = Outcome(left=Counter({("sliding", 0): 3}), **outcome)
    monkeypatch.setattr("sandbox.verbs.accuracy.sweep", lambda *_, **__: found)
    code, _, err = tumble("accuracy", "sliding", "--budget", "9")
    assert code == 2
    assert f"nothing was measured: {says}" in err.splitlines()[-1]


def test_what_there_was_no_time_to_prepare_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    compared = replace(SLIDING, prepare=lambda: None)
    monkeypatch.setitem(EXPERIMENTS, "sliding", compared)
    outcome = sweep([compared, BOUNCE], TINY[:1], Threads(), seconds=1e-9, repeats=1)
    assert outcome.unprepared == ["sliding", ""]


class Compiling(Threads):
    """Each task takes longer than there is time."""

    def submit(self, function: Any, *arguments: Any) -> Any:
        return super().submit(time.sleep, 2.0)


def test_a_run_that_does_not_end_when_its_time_is_over_is_compiling(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.accuracy.running.GRACE", 0.1)
    outcome = sweep([SLIDING], TINY[:1], Compiling(), seconds=0.2, repeats=1)
    assert outcome.unprepared == [""]
    assert sum(outcome.left.values()) == 2


@pytest.mark.usefixtures("tiny")
def test_what_no_solver_can_run_is_one_line(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.verbs.accuracy.all_series", lambda *names: TINY[1:])
    code, out, err = tumble("accuracy", "bounce")
    assert (code, out) == (2, "")
    assert err.splitlines()[-1].endswith("nothing was measured: it has no restitution")


@pytest.mark.usefixtures("tiny")
def test_folder_that_cannot_be_used_is_one_line_and_measures_nothing(
    tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setattr("sandbox.verbs.accuracy.sweep", None)
    assert "cannot be made" in one_line(tumble("accuracy", "-o", tmp_path / "file" / "folder"))
    new, none = tmp_path / "new", "tcp://127.0.0.1:1"
    assert f"--json {tmp_path}: it is a folder" in one_line(tumble("accuracy", "-o", new, "--json", tmp_path))
    assert "its folder does not exist" in one_line(tumble("accuracy", "-o", new, "--json", new / "rows.json"))
    monkeypatch.setattr("sandbox.lab.accuracy.workers.CONNECTING", 0.5)
    rows = tmp_path / "rows.json"
    assert "no Dask scheduler" in one_line(tumble("accuracy", "-o", new, "--json", rows, "--dask", none))
    (tmp_path / "accuracy.html").mkdir()
    assert "accuracy.html cannot be written: it is a folder" in one_line(tumble("accuracy", "-o", tmp_path))
    assert sorted(file.name for file in tmp_path.iterdir()) == ["accuracy.html", "file"]
    (tmp_path / "accuracy.html").rmdir()
    (tmp_path / "accuracy.md").write_text("a page without the marks")
    assert "must have the lines" in one_line(tumble("accuracy", "-o", tmp_path))
