"""`tumble stability`: what it runs, how it judges, and the command."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from engine import StepError, World
from sandbox.lab import stability
from sandbox.lab.stability import CASES, LARGE, VARIANTS, Clock, Row, Variant, check, check_all, variants_of, worst
from sandbox.lab.stability_report import as_markdown, as_text, settings_of
from sandbox.scenes import find_scene
from sandbox.scenes.criterion import Criterion, Reading
from sandbox.scenes.stacking.dominoes import REACHED, WATCHED, wave_front
from tests.sandbox.commandline import Tumble, one_line

KEYS = ["case", "solver", "settings", "default", "passed", "value", "limit", "unit", "ms"]
SOFT, TALK = Variant("soft_step"), Variant("sequential_impulses")
ASKED_FOR = [
    "stack_10", "stack_20", "stack_40", "pyramid", "mass_ratio_400",
    "overlap_recovery", "card_house", "arch", "dominoes", "friction_ramp",
]  # fmt: skip


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    return [check(case, variant) for case in ("mass_ratio_400", "overlap_recovery") for variant in (SOFT, TALK)]


def test_these_are_the_cases() -> None:
    assert list(CASES) == ASKED_FOR
    assert all(find_scene(scene).shows for scene in CASES.values())


def test_every_solver_is_tried_with_its_defaults_and_others() -> None:
    defaults = [variant.solver for variant in VARIANTS if variant.default]
    assert defaults == ["soft_step", "sequential_impulses"]
    for solver in defaults:
        assert sum(variant.solver == solver for variant in VARIANTS) >= 3
    assert [variants_of(case) for case in LARGE] == [[SOFT, TALK]] * len(LARGE)
    assert variants_of("arch") == list(VARIANTS)


def test_soft_step_holds_what_the_talk_does_not(rows: list[Row]) -> None:
    assert [row.passed for row in rows] == [True, False, True, False]
    assert [row.value <= row.limit for row in rows] == [True, False, True, False]


def test_the_heavy_box_sinks_as_predicted(rows: list[Row]) -> None:
    assert 1.2 / 1.05 < rows[0].limit / rows[0].value < 1.2 * 1.05  # the limit is the prediction and a fifth


@pytest.mark.parametrize("substeps", [4, 8, 16])
@pytest.mark.parametrize("case", ["stack_10", "mass_ratio_400", "arch"])
def test_piles_sink_as_predicted_whatever_the_substeps(case: str, substeps: int) -> None:
    row = check(case, Variant("soft_step", (("substeps", substeps),)))
    assert row.value == pytest.approx(row.limit / 1.2, rel=0.04)
    assert row.passed


def test_settings_say_what_it_was_run_with(rows: list[Row]) -> None:
    dt = pytest.approx(1 / 60)
    soft = {"dt": dt, "substeps": 4, "iterations": 1, "stiffness": "follows", "recycling": True}
    assert rows[0].settings == soft
    assert rows[1].settings == {"dt": dt, "iterations": 10}
    row = check("mass_ratio_400", Variant("sequential_impulses", (("iterations", 3),), 2))
    assert row.settings == {"dt": pytest.approx(1 / 120), "iterations": 3}
    assert row.value < 0.9 * check("mass_ratio_400", Variant("sequential_impulses", (("iterations", 3),))).value
    assert not row.default
    assert rows[0].default
    assert rows[1].default


def test_json_has_these_keys(rows: list[Row]) -> None:
    for row in rows:
        data = row.to_dict()
        assert list(data) == KEYS
        assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert replace(rows[0], value=math.inf).to_dict()["value"] is None


def test_time_is_that_of_the_steps(rows: list[Row]) -> None:
    assert all(0.0 < row.ms < 1000.0 for row in rows)


def test_clock_counts_steps_alone() -> None:
    world = World()
    clock = Clock(world)
    assert clock.ms_a_second() == 0.0
    clock.step(0.1)
    sum(range(2_000_000))  # not a step
    assert world.time == pytest.approx(0.1)
    assert clock.ms_a_second() > 0.0


def test_a_failed_step_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(world: World, dt: float) -> None:
        raise StepError("body 1 is lost")

    monkeypatch.setattr(World, "step", fail)
    row = check("stack_10", SOFT)
    assert (row.passed, row.value, row.to_dict()["value"]) == (False, math.inf, None)
    assert "lost" in as_text([row])


def test_what_is_missed_by_most_is_reported() -> None:
    def measure(world: World) -> float:
        return 0.0

    criteria = [Criterion(name, measure, "m", 1.0, at_most=1.0) for name in "abc"]
    good, bad, worse = Reading(0.5, -math.inf, 1.0), Reading(2.0, -math.inf, 1.0), Reading(9.0, -math.inf, 1.0)
    assert worst(criteria, [good, bad, worse])[0].says == "c"
    assert worst(criteria, [good, worse, bad])[0].says == "b"
    assert worst(criteria, [good, good, good])[0].says == "a"


def test_dominoes_reach_what_both_solvers_converge_to() -> None:
    """With contacts found anew in every step: kept ones, whose normals stand still, make the wave 3 % slower."""
    for settings, parts in (
        ({"substeps": 32, "precision": "double", "recycling": False}, 1),
        ({"solver": "sequential_impulses", "iterations": 40, "precision": "double"}, 8),
    ):
        world = find_scene(CASES["dominoes"]).make(**settings)
        for _ in range(round(WATCHED * 60) * parts):
            world.step(1 / 60 / parts)
        assert wave_front(world) == pytest.approx(REACHED, rel=0.02), settings


# --- report -----------------------------------------------------------------------------------------------------------


def test_text_says_what_holds_and_what_fails(rows: list[Row]) -> None:
    text = as_text(rows)
    assert text.count(" holds ") == 2
    assert text.count(" fails ") == 2
    assert "2 of 4 hold." in text
    assert "With the defaults of soft_step: all hold." in text
    assert "With the defaults of sequential_impulses: mass_ratio_400, overlap_recovery fail." in text


def test_page_has_a_line_a_run(rows: list[Row]) -> None:
    page = as_markdown(rows)
    assert sum(line.startswith("| soft_step") for line in page.splitlines()) == 2
    assert page.count("**fails**") == 2
    assert max(len(line) for line in page.splitlines() if not line.startswith("|")) <= 144
    for line in page.splitlines():
        assert line.count("|") in (0, 6)


@pytest.mark.parametrize(
    ("variant", "text"),
    [
        (SOFT, "soft_step"),
        (Variant("soft_step", (("recycling", False),)), "soft_step, no recycling"),
        (Variant("sequential_impulses", (("iterations", 40),)), "sequential_impulses, iterations 40"),
        (Variant("sequential_impulses", (), 4), "sequential_impulses, dt 1/240"),
    ],
)
def test_settings_are_named(variant: Variant, text: str) -> None:
    assert settings_of(variant) == text


# --- the command ------------------------------------------------------------------------------------------------------


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command, with the defaults only."""
    monkeypatch.setattr(stability, "VARIANTS", (SOFT, TALK))


@pytest.mark.usefixtures("few")
def test_command_writes_json_and_page(tumble: Tumble, tmp_path: Path) -> None:
    folder, file = tmp_path / "new" / "folder", tmp_path / "rows.json"
    code, out, _ = tumble("stability", "mass_ratio_400", "-o", folder, "--json", file)
    assert code == 0  # the talk's solver fails, and it is not what a world has by default
    assert "1 of 2 hold" in out
    data = json.loads(file.read_text())
    assert [(row["case"], row["solver"], row["default"], row["passed"]) for row in data] == [
        ("mass_ratio_400", "soft_step", True, True),
        ("mass_ratio_400", "sequential_impulses", True, False),
    ]
    assert all(list(row) == KEYS for row in data)
    assert [path.name for path in folder.iterdir()] == ["stability.md"]


@pytest.mark.usefixtures("few")
def test_exit_code_tells_if_a_default_fell(tumble: Tumble, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.verbs.stability.check_all", lambda cases, progress: FAKES)
    code, out, _ = tumble("stability", "--json", "-")
    assert code == 1
    assert len(json.loads(out)) == len(FAKES)


CRITERION = Criterion("it sinks by", lambda world: 0.0, "m", 1.0, at_most=1.0)
FAKES = [
    Row("arch", "soft_step", {}, True, False, 2.0, 1.0, "m", 1.0, CRITERION, Reading(2.0, -math.inf, 1.0), SOFT),
]


def test_check_all_runs_case_after_case(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr(stability, "VARIANTS", (SOFT, TALK))
    monkeypatch.setattr(stability, "check", lambda case, variant: seen.append((case, variant)))
    told: list[int] = []
    check_all(["arch", "pyramid"], lambda: told.append(1))
    assert seen == [("arch", SOFT), ("arch", TALK), ("pyramid", SOFT), ("pyramid", TALK)]
    assert len(told) == 4


@pytest.mark.parametrize("name", ["stack_11", "Pyramid", "", "x" * 10_000, "arch\npyramid"])
def test_unknown_case_is_one_short_line(tumble: Tumble, name: str) -> None:
    line = one_line(tumble("stability", "arch", name))
    assert "there is no case" in line
    assert len(line) < 300


def test_folder_that_cannot_be_made_is_one_line(tumble: Tumble, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot be made" in one_line(tumble("stability", "arch", "-o", tmp_path / "file" / "folder"))
