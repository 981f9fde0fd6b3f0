"""`tumble bench`: its tables, its JSON, and one line with exit code 2 for what cannot be."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from engine import STAGES
from sandbox.cli import BAD_INPUT, main
from sandbox.verbs.bench import BASES
from tests.sandbox.lab import fake_box2d_lite as fake

NUMBERS = {"ms_median", "ms_min", "ms_p99"}
PEER_NUMBERS = {"ms_median", "ratio", "ratio_low", "ratio_high"}


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line that the command ends with."""
    assert main(["bench", *arguments]) == BAD_INPUT
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = [line for line in captured.err.splitlines() if line.startswith("tumble: ")]
    assert len(lines) == 1
    assert captured.err.endswith(lines[0] + "\n")
    return lines[0]


def test_json_has_scenes_stages_and_peers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    checkout = fake.make_checkout(tmp_path / "checkout")
    fake.install_driver(monkeypatch, tmp_path / "bin")
    arguments = ["Single Box", "Circles", "--steps", "30", "--peers", "--box2d-lite", str(checkout), "--json", "-"]
    assert main(["bench", *arguments]) == 0
    captured = capsys.readouterr()
    box, circles = json.loads(captured.out)
    assert (box["scene"], box["threads"], box["bodies"]) == ("The Talk/Single Box", 1, 2)
    assert isinstance(box["contacts"], int)
    assert all(box[name] > 0.0 for name in NUMBERS)
    assert list(box["stages"]) == [name for name, _ in STAGES]
    assert set(box["peers"]) == {"pymunk", "Box2D Lite"}
    for peer in box["peers"].values():
        assert peer.keys() >= PEER_NUMBERS
        assert peer["ratio_low"] <= peer["ratio"] <= peer["ratio_high"]
    assert box["peers"]["Box2D Lite"]["ms_median"] == fake.STEP_CPU
    assert set(circles["peers"]) == {"pymunk"}
    assert "The Talk/Circles: left out Box2D Lite: it has boxes only" in captured.err


def test_table_names_scene_peer_and_stages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bench.json"
    assert main(["bench", "pyramid", "--steps", "2", "--peers", "--json", str(file)]) == 0
    text = capsys.readouterr().out
    for word in ("The Talk/Pyramid", "  pymunk", "ms a step", "ratio", *(name for name, _ in STAGES)):
        assert word in text
    assert json.loads(file.read_text())[0]["steps"] == 2


def test_without_a_scene_it_takes_the_pyramids(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sandbox.verbs.bench.BASES", BASES[:2])
    assert main(["bench", "--steps", "1", "--json", "-"]) == 0
    results = json.loads(capsys.readouterr().out)
    assert [(result["scene"], result["bodies"]) for result in results] == [
        ("pyramid of base 12", 79),
        ("pyramid of base 20", 211),
    ]
    assert all(result["peers"] == {} for result in results)


def test_an_unknown_scene_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert "there is no scene 'pyramyd'" in refused(capsys, "pyramyd")


def test_peers_without_pymunk_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "pymunk", None)
    line = refused(capsys, "Single Box", "--steps", "1", "--peers")
    assert line == "tumble: pymunk is not installed: pip install 'tumble[peers]'"


def test_no_checkout_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "is no checkout of Box2D Lite" in refused(capsys, "Single Box", "--box2d-lite", str(tmp_path))


def test_a_driver_that_dies_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    checkout = fake.make_checkout(tmp_path / "checkout")
    fake.install_driver(monkeypatch, tmp_path / "bin", fake.BROKEN_DRIVER)
    assert "exit code 7" in refused(capsys, "Single Box", "--steps", "1", "--box2d-lite", str(checkout))


@pytest.mark.parametrize("steps", ["0", "-1", "many"])
def test_steps_must_be_a_whole_number(steps: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as raised:
        main(["bench", "--steps", steps])
    assert raised.value.code == BAD_INPUT
    assert "must be a whole number" in capsys.readouterr().err
