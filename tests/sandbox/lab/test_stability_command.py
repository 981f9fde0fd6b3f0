"""`tumble stability`: the command, its report, its page and its picture."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from engine import SOLVERS
from sandbox.lab import stability_baseline
from sandbox.lab.accuracy.workers import WorkersError
from sandbox.lab.hard_cases import CASES
from sandbox.lab.stability import Row
from sandbox.lab.stability_baseline import BASELINE, steps_back
from sandbox.lab.stability_page import as_markdown
from sandbox.lab.stability_picture import draw
from sandbox.lab.stability_report import as_text, cell_text, share
from sandbox.lab.stability_sweep import sweep
from sandbox.verbs.stability import named
from tests.sandbox.commandline import Tumble, one_line

HOLDS = Row("arch", "soft_step", {"dt": 1 / 60}, True, True, 0.5, 1.0, "m", 2.0, "default", "it sinks [m]", at_most=1.0)
CHEAPER = replace(HOLDS, default=False, ms=1.0, label="substeps 2")
FAILS = replace(HOLDS, case="seams", passed=False, value=2.0)
DEARER = replace(FAILS, default=False, passed=True, value=0.1, ms=9.0, label="substeps 8")
LACKS = replace(
    HOLDS, solver="pymunk", passed=None, value=math.nan, limit=math.nan, ms=math.nan, settings={}, claim="why"
)
LOST = replace(FAILS, solver="pymunk", value=math.inf)
ROWS = [HOLDS, CHEAPER, LACKS, FAILS, DEARER, LOST]
ROOT = Path(__file__).parents[3]
QUICK = ("single_box", "mass_ratio_10")


def test_text_has_a_line_a_case_and_what_fails() -> None:
    text = as_text(ROWS)
    assert "substeps 2: 1 ms" in text
    assert "substeps 8: 9 ms" in text
    assert "not applicable" in text
    assert "seams, soft_step: it sinks [m]: 2, limit 1" in text
    assert "With the defaults of soft_step: 1 of 2 hold, 50 %; 0 not applicable." in text
    assert "With the defaults of pymunk: 0 of 1 hold, 0 %; 1 not applicable." in text
    assert share(ROWS, "soft_step") == (1, 2, 2)
    assert "fails" in cell_text([LOST])


def test_page_tells_each_failure_with_its_cause() -> None:
    page = as_markdown(ROWS)
    assert "**seams**: it sinks [m]: 2, limit 1." in page
    assert "Holds with substeps 8." in page
    assert "| arch | substeps 2: 1 ms | not applicable |" in page
    assert "| seams | substeps 8: 9 ms; default **fails** | **fails** |" in page
    assert max(len(line) for line in page.splitlines() if not line.startswith("|")) <= 120


def test_picture_is_drawn_twice_alike(tmp_path: Path) -> None:
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        draw(ROWS, tmp_path / name)
    for kind in ("png", "svg"):
        one, other = ((tmp_path / name / f"stability.{kind}").read_bytes() for name in ("one", "other"))
        assert one == other
        assert len(one) > 5000
    assert b"<svg" in one


# --- what held --------------------------------------------------------------------------------------------------------


def test_a_step_back_is_what_held_and_fails_now(tmp_path: Path) -> None:
    file = tmp_path / "stability.json"
    file.write_text(json.dumps([row.to_dict() for row in (HOLDS, CHEAPER, FAILS, LACKS)]))
    worse, gone = replace(HOLDS, passed=False), replace(HOLDS, passed=None)
    assert steps_back([HOLDS, FAILS, LOST], file) == []
    assert steps_back([worse, FAILS], file) == [worse]
    assert steps_back([gone], file) == [gone]
    assert steps_back([replace(CHEAPER, passed=False)], file) == []  # not its default
    assert steps_back([worse], tmp_path / "none.json") == []


def test_the_committed_figures_are_those_of_the_cases() -> None:
    rows = json.loads(BASELINE.read_text())
    assert {row["case"] for row in rows} == set(CASES)
    assert {"soft_step", "pymunk", "pyb2d3"} <= {row["solver"] for row in rows}


def test_more_hold_than_with_either_peer() -> None:
    rows = [row for row in json.loads(BASELINE.read_text()) if row["default"] and row["passed"] is not None]
    parts = {}
    for solver in ("soft_step", "pymunk", "pyb2d3"):
        own = [row["passed"] for row in rows if row["solver"] == solver]
        parts[solver] = sum(own) / len(own)
    assert parts["soft_step"] >= 0.93
    assert parts["soft_step"] > max(parts["pymunk"], parts["pyb2d3"])


# --- the command ------------------------------------------------------------------------------------------------------


def test_command_writes_all_that_it_says(tumble: Tumble, tmp_path: Path) -> None:
    folder, file = tmp_path / "new" / "folder", tmp_path / "rows.json"
    code, out, _ = tumble(
        "stability",
        *QUICK,
        "--solvers",
        "soft_step",
        "--peers",
        "--defaults",
        "--jobs",
        "1",
        "-o",
        folder,
        "--json",
        file,
    )
    assert code == 0
    assert "With the defaults of soft_step: 2 of 2 hold" in out
    data = json.loads(file.read_text())
    assert [(row["case"], row["solver"]) for row in data] == [
        (case, solver) for case in QUICK for solver in ("soft_step", "pymunk", "pyb2d3")
    ]
    assert all(row["default"] for row in data)
    assert sorted(path.name for path in folder.iterdir()) == [
        "stability.json", "stability.md", "stability.png", "stability.svg",
    ]  # fmt: skip
    assert [row["case"] for row in json.loads((folder / "stability.json").read_text())] == [row["case"] for row in data]


def test_exit_code_tells_of_a_step_back(tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "held.json").write_text(json.dumps([replace(HOLDS, case="seams").to_dict()]))
    monkeypatch.setattr(
        "sandbox.verbs.stability.steps_back", lambda rows: stability_baseline.steps_back(rows, tmp_path / "held.json")
    )
    code, out, err = tumble("stability", "seams", "--solvers", "soft_step", "--defaults", "--jobs", "1", "--json", "-")
    assert code == 1
    assert json.loads(out)[0]["passed"] is False
    assert "seams held with the defaults of soft_step when docs/stability.json was written, and fails now" in err


def test_processes_give_the_same_rows_in_the_same_order() -> None:
    cells = [(case, solver) for solver in ("soft_step", "pymunk") for case in QUICK]
    told: list[int] = []
    alone = sweep(cells, 60.0, lambda: told.append(1), defaults_only=True)
    together = sweep(cells, 60.0, lambda: told.append(1), defaults_only=True, jobs=2)
    assert len(told) == 2 * len(cells)
    assert list(alone) == list(together) == cells
    for cell in cells:
        assert [replace(row, ms=0.0) for row in alone[cell]] == [replace(row, ms=0.0) for row in together[cell]]


@pytest.fixture
def baseline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Stands in for docs/stability.json: single_box held with soft_step."""
    file = tmp_path / "stability.json"
    file.write_text(json.dumps([replace(HOLDS, case="single_box").to_dict()]))
    monkeypatch.setattr(stability_baseline, "BASELINE", file)
    return file


class NoTime:
    """Stands in for compiling and trying: of all cells only the last so many are tried, and fail."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, kernels: int, tried: int = 0) -> None:
        self.tried = tried
        monkeypatch.setattr("sandbox.verbs.stability.sweep", self.sweep)
        monkeypatch.setattr("sandbox.verbs.stability.compile_all", lambda *_: (kernels, 31.2))

    def sweep(self, cells: list, *_: object, **__: object) -> dict:
        places = dict(zip(cells, range(len(cells), 0, -1), strict=True))
        return {
            cell: [replace(FAILS, case=cell[0], solver=cell[1])] if places[cell] <= self.tried else [] for cell in cells
        }


def test_what_held_and_was_not_tried_counts_as_failing(
    tumble: Tumble, baseline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    NoTime(monkeypatch, 0)
    code, out, err = tumble("stability", *QUICK, "--solvers", "soft_step", "--budget", "5", "--json", "-")
    assert (code, json.loads(out)) == (1, [])
    assert "the 5 s were not enough for 2 of 2 (--budget): loading what is compiled alone took 31 s; give it a" in err
    assert "single_box with soft_step held when docs/stability.json was written, and there was no time" in err
    assert "mass_ratio_10" not in err  # it did not hold
    NoTime(monkeypatch, 0, tried=1)
    assert tumble("stability", *QUICK, "--solvers", "soft_step", "--budget", "50")[0] == 1
    assert tumble("stability", *QUICK[::-1], "--solvers", "xpbd", "--budget", "50")[0] == 0  # which held nothing


def test_nothing_tried_of_what_never_held_is_refused(
    tumble: Tumble, baseline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    NoTime(monkeypatch, 0)
    before = baseline.read_text()
    code, out, err = tumble("stability", QUICK[1], "--solvers", "soft_step", "-o", baseline.parent)
    assert (code, out) == (2, "")
    assert err.endswith("tumble: nothing was tried\n")
    assert baseline.read_text() == before  # figures of nothing replace none


def test_compiling_that_took_all_the_time_is_told(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    for tried, says in ((0, ": all went into compiling 7 kernels"), (1, ", for compiling 7 kernels took 31 s of them")):
        NoTime(monkeypatch, 7, tried)
        code, _, err = tumble("stability", *QUICK, "--solvers", "soft_step", "--budget", "5")
        assert code == 1
        assert f"{says}; compiled code is kept, so run it once more, or give it a larger --budget" in err


def test_a_step_back_is_seen_where_the_figures_are_written_anew(
    tumble: Tumble, baseline: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    NoTime(monkeypatch, 0, tried=1)
    assert tumble("stability", "single_box", "--solvers", "soft_step", "-o", baseline.parent)[0] == 1


def test_many_are_counted() -> None:
    cells = [(f"case {number}", "soft_step") for number in range(9)]
    assert named(cells[:1]) == "case 0 with soft_step"
    assert named(cells).startswith("9 cases and solvers, case 0 with soft_step, case 1")
    assert "case 8" not in named(cells)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_at_once_when_asked(number: signal.Signals) -> None:
    """In the midst of cases that would take minutes, and leaves no process behind."""
    code = """
import sys, time
from sandbox.lab import stability_sweep
from sandbox.verbs import stability
from sandbox.cli import main
class Told(stability_sweep.Processes):
    def submit(self, function, *arguments):
        future = super().submit(time.sleep, 60.0)
        print(*self._executor._processes, flush=True)
        return future
stability_sweep.Processes = Told
stability.compile_all = lambda *_: (0, 0.0)
sys.exit(main(["stability", "single_box", "mass_ratio_10", "--solvers", "soft_step", "--jobs", "2"]))
"""
    command = [sys.executable, "-c", code]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        assert process.stdout is not None
        process.stdout.readline()
        workers = [int(one) for one in process.stdout.readline().split()]
        process.send_signal(number)
        started = time.monotonic()
        _, err = process.communicate(timeout=30)
    finally:
        process.kill()
    assert time.monotonic() - started < 20
    assert (process.returncode, err) == (130, "")
    assert len(workers) == 2
    for worker in workers:
        with pytest.raises(ProcessLookupError):
            os.kill(worker, 0)


def test_a_process_that_dies_is_one_line(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    def die(*_: object, **__: object) -> None:
        raise WorkersError("a process that tried cases was ended")

    NoTime(monkeypatch, 0)
    monkeypatch.setattr("sandbox.verbs.stability.sweep", die)
    assert "was ended" in one_line(tumble("stability", "arch"))


@pytest.mark.parametrize("name", ["stack_11", "Pyramid", "", "x" * 10_000, "arch\npyramid"])
def test_unknown_case_is_one_line(tumble: Tumble, name: str) -> None:
    assert "there is no case" in one_line(tumble("stability", "arch", name))


def test_unknown_solver_is_one_line(tumble: Tumble) -> None:
    assert f"it must be one of {', '.join(SOLVERS)}" in one_line(tumble("stability", "arch", "--solvers", "qq"))


def test_folder_that_cannot_be_made_is_one_line(tumble: Tumble, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot be made" in one_line(tumble("stability", "arch", "-o", tmp_path / "file" / "folder"))


def test_what_cannot_be_written_is_refused_before_anything_is_tried(
    tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sandbox.verbs.stability.compile_all", None)
    (tmp_path / "stability.svg").mkdir()
    new = tmp_path / "new"
    assert f"--json {tmp_path}: it is a folder" in one_line(tumble("stability", "--json", tmp_path, "-o", new))
    assert "its folder does not exist" in one_line(tumble("stability", "--json", new / "rows.json", "-o", new))
    assert "stability.svg cannot be written: it is a folder" in one_line(tumble("stability", "-o", tmp_path))
    assert [file.name for file in tmp_path.iterdir()] == ["stability.svg"]
