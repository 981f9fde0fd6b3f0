"""`tumble accuracy`: rows, report, picture, and the command."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from engine import World
from sandbox.lab import accuracy, accuracy_picture
from sandbox.lab.accuracy import SERIES, Row, Series, Setting, measure, over, passes, runs_of
from sandbox.lab.accuracy_picture import LEAST, LINES, draw, labels
from sandbox.lab.accuracy_report import as_markdown, as_text, measure_of
from sandbox.lab.experiments import EXPERIMENTS
from tests.sandbox.commandline import Tumble, one_line
from web import theme

TINY = (
    Series("soft_step, substeps", "soft_step", over("substeps", (1, 4))),
    Series("sequential_impulses, iterations", "sequential_impulses", over("iterations", (1,))),
)
KEYS = ["scene", "solver", "settings", "precision", "measure", "error", "cost_ms", "solves"]


@pytest.fixture
def tiny(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command, with next to nothing to measure."""
    monkeypatch.setattr("sandbox.verbs.accuracy.SERIES", TINY)


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    told: list[int] = []
    experiments = [EXPERIMENTS["sliding"], EXPERIMENTS["bounce"]]
    found = measure(experiments, TINY, repeats=1, progress=lambda: told.append(1))
    assert len(told) == runs_of(experiments, TINY, 1) == 2 * (3 + 2)
    return found


def test_a_row_a_setting_and_measure(rows: list[Row]) -> None:
    found = [(row.scene, row.solver, row.label) for row in rows]
    assert found == [
        ("sliding", "soft_step", "1"),
        ("sliding", "soft_step", "4"),
        ("sliding", "sequential_impulses", "1"),
        ("bounce", "soft_step", "1"),  # sequential_impulses have no restitution
        ("bounce", "soft_step", "4"),
    ]
    assert all(row.cost_ms > 0 for row in rows)
    assert rows[0].error > 3 * rows[1].error


def test_settings_say_what_it_was_run_with(rows: list[Row]) -> None:
    dt = pytest.approx(1 / 60)
    assert rows[1].settings == {"dt": dt, "substeps": 4, "iterations": 1, "stiffness": "follows"}
    assert rows[2].settings == {"dt": dt, "iterations": 1}
    assert {row.precision for row in rows} == {"single"}


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
    (row,) = measure([EXPERIMENTS["sliding"]], [series], repeats=0 + 1, progress=lambda: None)
    assert row.settings["dt"] == pytest.approx(1 / 240)
    assert row.solves == pytest.approx(4 * 60 * 2 * 180, rel=0.02)


def test_the_default_covers_both_solvers_and_precisions() -> None:
    assert {series.solver for series in SERIES} == {"soft_step", "sequential_impulses"}
    assert {series.precision for series in SERIES} == {"single", "double"}
    substeps = next(series for series in SERIES if series.name == "soft_step, substeps")
    assert [setting.world["substeps"] for setting in substeps.settings] == [1, 2, 4, 8, 16, 32]
    assert {setting.steps for series in SERIES for setting in series.settings} > {1, 2, 4}
    assert len(SERIES) <= len(LINES)


def test_json_has_these_keys(rows: list[Row]) -> None:
    for row in rows:
        data = row.to_dict()
        assert list(data) == KEYS
        assert json.loads(json.dumps(data, allow_nan=False)) == data


def test_an_error_that_is_not_finite_is_null(rows: list[Row]) -> None:
    assert replace(rows[0], error=math.inf).to_dict()["error"] is None


# --- report and picture -----------------------------------------------------------------------------------------------


def test_text_has_every_measure_and_error(rows: list[Row]) -> None:
    text = as_text(rows)
    for row in rows:
        assert measure_of(row.scene, row.measure).says in text
        assert f"{row.error:.1e}" in text
        assert row.series in text
    assert "lost" in as_text([replace(rows[0], error=math.inf)])


def test_page_shows_the_picture_and_every_row(rows: list[Row]) -> None:
    page = as_markdown(rows)
    assert "](accuracy.png)" in page
    assert sum(line.startswith("| soft_step") for line in page.splitlines()) == 4
    assert max(len(line) for line in page.splitlines() if not line.startswith("|")) <= 144


def test_picture_is_drawn(rows: list[Row], tmp_path: Path) -> None:
    draw([*rows, replace(rows[0], error=0.0), replace(rows[1], error=math.inf)], tmp_path / "picture.png")
    with Image.open(tmp_path / "picture.png") as picture:
        assert picture.width > 1000
        colours = {colour for _, colour in picture.convert("RGB").getcolors(1 << 24)}  # type: ignore[misc, union-attr]
    for line in LINES[:2]:
        assert tuple(bytes.fromhex(line[1:])) in colours


def test_labels_do_not_lie_on_each_other(rows: list[Row]) -> None:
    row = replace(rows[0], cost_ms=2.0, error=0.1)
    near, far, none = replace(row, error=0.1001, label="b"), replace(row, error=0.2, label="c"), replace(row, error=0.0)
    assert [label for _, label in labels([row, near, far])] == ["1", "c"]
    assert labels([none])[0][0] == (2.0, LEAST)


def test_colours_are_the_pages() -> None:
    assert "#{:02x}{:02x}{:02x}".format(*theme.BACKDROP) == accuracy_picture.BACKDROP
    assert set(LINES) <= set(theme.PLOT_LINES)
    assert (accuracy_picture.TEXT, accuracy_picture.GRID) == (theme.PLOT_TEXT, theme.PLOT_GRID)


# --- the command ------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("tiny")
def test_command_writes_json_and_folder(tumble: Tumble, tmp_path: Path) -> None:
    folder, file = tmp_path / "new" / "folder", tmp_path / "rows.json"
    code, out, _ = tumble("accuracy", "ballistic", "sliding", "-o", folder, "--json", file)
    assert code == 0
    assert "ballistic" in out
    data = json.loads(file.read_text())
    assert [(row["scene"], row["measure"]) for row in data[::3]] == [
        ("ballistic", "height [m]"),
        ("sliding", "distance [m]"),
    ]
    assert all(list(row) == KEYS for row in data)
    assert sorted(path.name for path in folder.iterdir()) == ["accuracy.md", "accuracy.png"]


@pytest.mark.usefixtures("tiny")
def test_json_on_standard_output_stands_alone(tumble: Tumble) -> None:
    code, out, _ = tumble("accuracy", "ballistic", "--json", "-")
    assert code == 0
    assert {row["scene"] for row in json.loads(out)} == {"ballistic"}


@pytest.mark.parametrize("name", ["balistic", "Pyramid", "", "x" * 10_000, "ballistic\nbounce"])
def test_unknown_scene_is_one_short_line(tumble: Tumble, name: str) -> None:
    line = one_line(tumble("accuracy", "bounce", name))
    assert "there is no scene" in line
    assert len(line) < 300


def test_a_close_name_is_offered(tumble: Tumble) -> None:
    assert "did you mean 'ballistic'?" in one_line(tumble("accuracy", "balistic"))


@pytest.mark.usefixtures("tiny")
def test_folder_that_cannot_be_made_is_one_line_and_measures_nothing(
    tumble: Tumble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(accuracy, "watch", None)
    assert "cannot be made" in one_line(tumble("accuracy", "-o", tmp_path / "file" / "folder"))
