"""`tumble effects`: its two tables, its JSON and its page; and one line for what cannot be."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from engine import EFFECTS, EffectStatus, Snapshot, World
from sandbox.lab.ablation import Ablation, Difference, copy_of
from sandbox.lab.compile_costs import CompileError
from sandbox.lab.effects_report import CALLED_FOR_BY, LACKING, Report, as_markdown, as_text, make_rows, source
from sandbox.scenes import find_scene
from sandbox.verbs import effects
from tests.sandbox.commandline import Tumble, one_line

NAMES = [effect.name for effect in EFFECTS]
KEYS = ["effect", "called_for", "because", "cost_us", "compile_s"]


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[World]:
    """The worlds that were measured, by numbers that are made up: tests of the real ones stand elsewhere."""
    worlds: list[World] = []

    def compare_all(snapshot: Snapshot, wanted: Sequence[Ablation], progress: object) -> Mapping[str, Difference]:
        worlds.append(copy_of(snapshot))
        return {one.name: Difference(float(k), 1.5) for k, one in enumerate(wanted)}

    monkeypatch.setattr(effects, "compare_all", compare_all)
    monkeypatch.setattr(effects, "step_time", lambda snapshot: 123.0)
    monkeypatch.setattr(effects, "compile_costs", lambda snapshot: dict.fromkeys(NAMES, 0.25))
    return worlds


def test_a_short_list_on_and_a_long_list_off(tumble: Tumble, measured: list[World]) -> None:
    code, out, err = tumble("effects", "The Talk/Pyramid")
    assert code == 0
    on, off, summary = out.split("\n\n")
    assert [line.split("  ")[0] for line in on.splitlines()[2:]] == [
        "gravity",
        "friction",
        "continuous collision",
        "sleeping",
    ]
    assert "0 of 78 bodies do" in on, "a world that sleeps would tell nothing"
    assert "79 of 79 shapes have friction" in on
    assert on.splitlines()[2].split()[-3:] == ["±", "1.5", "0.25"], "1 us is less than what chance may do"
    assert on.splitlines()[3].split()[-2:] == [f"{1 + NAMES.index('friction')}.0", "0.25"]
    assert [line.split("  ")[0] for line in off.splitlines()[2:]] == [
        n for n in NAMES if n not in ("gravity", "friction", "continuous collision", "sleeping")
    ]
    assert summary.startswith(f"The Talk/Pyramid, 79 bodies, 123 us a step. It calls for 4 of {len(NAMES)} effects;")
    assert "compiling the engine from nothing" in err
    assert measured[0].step_count == effects.SETTLED


def test_the_default_is_the_pyramid(tumble: Tumble, measured: list[World]) -> None:
    assert tumble("effects")[1] == tumble("effects", "pyramid")[1].replace("The Talk/Pyramid", effects.DEFAULT_SCENE)
    assert measured[0].body_count == 79


def test_json(tumble: Tumble, measured: list[World], tmp_path: Path) -> None:
    file = tmp_path / "effects.json"
    assert tumble("effects", "The Talk/Teeter", "--json", file)[0] == 0
    rows = json.loads(file.read_text())
    assert [list(row) for row in rows] == [KEYS] * len(NAMES)
    assert [row["effect"] for row in rows] == NAMES
    assert [row["effect"] for row in rows if row["called_for"]] == [
        "gravity",
        "friction",
        "revolute joints",
        "continuous collision",
        "sleeping",
    ]
    assert all(bool(row["because"]) == row["called_for"] for row in rows)
    assert all(isinstance(row["cost_us"], float) and isinstance(row["compile_s"], float) for row in rows)
    assert json.loads(tumble("effects", "The Talk/Teeter", "--json", "-")[1]) == rows


def test_markdown_of_two_scenes(tumble: Tumble, measured: list[World], tmp_path: Path) -> None:
    file = tmp_path / "effects.md"
    assert tumble("effects", "The Talk/Pyramid", "The Talk/Teeter", "--markdown", file)[0] == 0
    text = file.read_text()
    assert 'Made by `tumble effects "The Talk/Pyramid" "The Talk/Teeter" --markdown docs/effects.md`' in text
    assert "\n### The Talk/Pyramid\n" in text
    assert "\n### The Talk/Teeter\n" in text
    assert "| revolute joints | 1 revolute joint | " in text
    tables = [line for line in text.splitlines() if line.startswith("|")]
    assert {line.replace("\\|", "").count("|") for line in tables} <= {4, 5}
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 144


def test_refusals_are_one_line(tumble: Tumble, measured: list[World], tmp_path: Path) -> None:
    assert "there is no scene 'Pyramidd'" in one_line(tumble("effects", "Pyramidd"))
    assert "several scenes: only with --markdown" in one_line(tumble("effects", "Teeter", "Dominos"))
    file = tmp_path / "page.md"
    assert "--json: of one scene only" in one_line(
        tumble("effects", "Teeter", "Dominos", "--markdown", file, "--json", "-")
    )
    missing = tmp_path / "nowhere" / "page.md"
    assert f"{missing}: its folder does not exist" in one_line(tumble("effects", "Teeter", "--markdown", missing))
    assert not measured, "told before anything was measured"
    line = tumble("effects", "Teeter", "--markdown", tmp_path)[2].splitlines()[-1]
    assert line == f"tumble: --markdown {tmp_path}: cannot be written: Is a directory"


def test_a_compiler_that_fails_is_one_line(
    tumble: Tumble, measured: list[World], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(snapshot: object) -> Mapping[str, float]:
        raise CompileError("compiling in a process of its own failed: no room")

    monkeypatch.setattr(effects, "compile_costs", fail)
    code, out, err = tumble("effects", "Teeter")
    assert (code, out) == (2, "")
    assert err.splitlines()[-1] == "tumble: compiling in a process of its own failed: no room"


def test_what_the_solver_lacks_has_no_cost() -> None:
    statuses = [EffectStatus("gravity", True, "it is there"), EffectStatus("restitution", False, "")]
    cost = Difference(1.5, 0.1)
    report = Report("none", 3, 50.0, cost, make_rows(statuses, {"gravity": cost}, {"gravity": 0.5}))
    assert report.rows[1].to_dict() == dict(zip(KEYS, ("restitution", False, "", None, None), strict=True))
    assert LACKING in as_text(report)
    assert f"| restitution | {LACKING} |  |" in as_markdown([report])


def test_every_effect_says_what_calls_for_it() -> None:
    without_property = {effect.name for effect in EFFECTS if not (effect.body or effect.shape)}
    assert set(CALLED_FOR_BY) == without_property
    assert source(next(effect for effect in EFFECTS if effect.name == "drag")) == "`drag` of a body"


def test_the_page_of_the_documents_is_of_these_effects() -> None:
    text = (Path(__file__).parents[3] / "docs" / "effects.md").read_text()
    rows = [line.split(" | ")[0].removeprefix("| ") for line in text.splitlines() if line.startswith("| ")]
    assert rows[1 : len(NAMES) + 1] == NAMES, "make it again: its first lines say how"
    assert "| gravity | gravity is (0, -10) m/s² |" in text
    assert find_scene("The Talk/Pyramid").name in text
