"""The command: help, wrong usage, scenes, warmup: exit codes, one clear line, no traceback."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sandbox import cli
from sandbox.scenes import SCENES
from sandbox.verbs import VERBS
from tests.sandbox.commandline import Tumble, usage_error


def test_help_names_every_verb(tumble: Tumble) -> None:
    code, out, _ = tumble("--help")
    assert code == 0
    for verb in VERBS:
        assert f"\n    {verb.NAME}" in out
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
        "shows": [
            {
                "says": "the apex is lower than twelve boxes by",
                "unit": "m",
                "after": 10.0,
                "throughout": False,
                "at_least": None,
                "at_most": pytest.approx(0.022, rel=0.02),
            }
        ],
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


def test_warmup_leaves_nothing_to_compile(tumble: Tumble) -> None:
    assert tumble("warmup")[0] == 0
    code, out, err = tumble("warmup", "--json", "-")
    assert (code, err) == (0, "")
    assert json.loads(out)["kernels_compiled"] == 0


def test_a_piped_list_of_scenes_has_a_line_a_scene(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["scenes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 1 + len(SCENES)
    for line, scene in zip(lines[1:], SCENES.values(), strict=True):
        assert line.startswith(scene.name)
        assert scene.summary in line
        for criterion in scene.shows:
            assert criterion.says in line
            assert line.endswith(" s")
