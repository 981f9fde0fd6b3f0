"""`tumble bench`: its tables, its JSON, and one line with exit code 2 for what cannot be."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from engine import STAGES, StepError, World
from sandbox.cli import BAD_INPUT, main
from sandbox.lab import bench_scenes
from sandbox.lab.bench_scenes import SETTLES
from sandbox.lab.peers import INSTALLABLE
from sandbox.lab.pyramids import BASES, pyramid
from sandbox.scenes import Scene
from tests.sandbox.lab import fake_box2d_lite as fake

NUMBERS = {f"{clock}_{name}" for clock in ("ms", "wall_ms") for name in ("median", "min", "p99")}
RATIOS = {f"{name}{which}" for name in ("ratio", "wall_ratio") for which in ("", "_low", "_high")}
KEYS = {
    *("scene", "threads", "bodies", "contacts", "joints", "colours", "overflow", "after_s", "steps", "peak_memory_mb"),
    *NUMBERS,
    *("stages", "peers", "left_out"),
}


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
    assert box.keys() == circles.keys() == KEYS
    assert (box["scene"], box["threads"], box["bodies"], box["joints"]) == ("The Talk/Single Box", 1, 2, 0)
    assert isinstance(box["contacts"], int)
    assert all(isinstance(count, int) for count in [*box["colours"], box["overflow"]])
    assert all(box[name] > 0.0 for name in NUMBERS)
    assert list(box["stages"]) == [name for name, _ in STAGES]
    assert set(box["peers"]) == {"pyb2d3", "pymunk", "Box2D Lite"}
    for peer in box["peers"].values():
        assert peer.keys() == {"ms_median", "wall_ms_median"} | RATIOS
        for ratio in ("ratio", "wall_ratio"):
            assert peer[f"{ratio}_low"] <= peer[ratio] <= peer[f"{ratio}_high"]
    assert box["left_out"] == {}
    assert box["peers"]["Box2D Lite"]["ms_median"] == fake.STEP_CPU
    assert set(circles["peers"]) == {"pyb2d3", "pymunk"}
    assert circles["left_out"].keys() == {"Box2D Lite"}
    assert "The Talk/Circles: left out Box2D Lite: it has boxes only" in captured.err


def test_table_names_scene_peer_and_stages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bench.json"
    assert main(["bench", "pyramid", "--steps", "2", "--peers", "--json", str(file)]) == 0
    text = capsys.readouterr().out
    for word in (
        "The Talk/Pyramid",
        "  pyb2d3",
        "  pymunk",
        "colours",
        "ms a step",
        "ratio",
        *(name for name, _ in STAGES),
    ):
        assert word in text
    assert json.loads(file.read_text())[0]["steps"] == 2


def test_without_a_scene_it_takes_those_of_the_benchmark(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = {f"{bench_scenes.FOLDER}{base}": pyramid(base) for base in BASES[:2]}
    monkeypatch.setattr(bench_scenes, "SCENES", few)
    assert main(["bench", "--steps", "1", "--json", "-"]) == 0
    results = json.loads(capsys.readouterr().out)
    assert [(result["scene"], result["bodies"]) for result in results] == [
        ("pyramid of base 12", 79),
        ("pyramid of base 20", 211),
    ]
    assert all(result["peers"] == {} for result in results)


def test_beside_box2d_lite_it_takes_the_talks_pyramids(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    checkout = fake.make_checkout(tmp_path / "checkout")
    fake.install_driver(monkeypatch, tmp_path / "bin")
    monkeypatch.setattr(bench_scenes, "BASES", BASES[:1])
    assert main(["bench", "--steps", "1", "--box2d-lite", str(checkout), "--json", "-"]) == 0
    assert [result["scene"] for result in json.loads(capsys.readouterr().out)] == ["pyramid of base 12"]


def test_a_scene_settles_as_long_as_it_is_said_to(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(SETTLES, "The Talk/Single Box", 0.25)
    for arguments, after in (([], 0.25), (["--after", "0.1"], 0.1), (["--after", "0"], 0.0)):
        assert main(["bench", "Single Box", "--steps", "2", "--json", "-", *arguments]) == 0
        assert json.loads(capsys.readouterr().out)[0]["after_s"] == pytest.approx(after)


def test_threads_are_for_every_engine(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    asked: list[dict] = []

    def made(scene: Scene, settings: dict) -> World:
        asked.append(settings)
        return scene.make()

    monkeypatch.setattr("sandbox.verbs.bench.made", made)
    threads: list[int] = []
    makers = [lambda n, make=make: (threads.append(n), make(n))[1] for make in INSTALLABLE]
    monkeypatch.setattr("sandbox.verbs.bench.INSTALLABLE", makers)
    assert main(["bench", "Pyramid", "--steps", "3", "--threads", "2", "--peers", "--json", "-"]) == 0
    (result,) = json.loads(capsys.readouterr().out)
    assert asked == [{"threads": 2}]
    assert threads == [2, 2]
    assert result["threads"] == 2
    assert set(result["peers"]) == {"pyb2d3", "pymunk"}


def test_what_goes_wrong_in_a_scene_names_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: object) -> None:
        raise StepError("body 1 is not finite")

    monkeypatch.setattr(World, "step", broken)
    assert refused(capsys, "Single Box") == "tumble: The Talk/Single Box: body 1 is not finite"


def test_markdown_goes_between_the_marks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Speed\n<!-- bench -->old<!-- end of bench -->\nThe end.\n")
    assert main(["bench", "Conveyor", "--steps", "2", "--peers", "--markdown", str(page)]) == 0
    text = page.read_text()
    assert text.startswith("# Speed\n<!-- bench -->\n")
    assert text.endswith("<!-- end of bench -->\nThe end.\n")
    assert "old" not in text
    assert "`tumble bench Conveyor --steps 2 --peers --markdown " in text
    assert "| Effects/Conveyor | 6 |" in text
    assert "- Effects/Conveyor, pymunk: left out; it has no conveyor:" in text
    capsys.readouterr()


def test_a_page_without_marks_is_refused_before_anything_is_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Speed\n")
    assert "must have the lines <!-- bench -->" in refused(capsys, "Single Box", "--markdown", str(page))
    assert page.read_text() == "# Speed\n"


@pytest.mark.parametrize("option", ["--json", "--markdown"])
def test_a_folder_that_is_not_there_is_one_line(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "none" / "file"
    assert refused(capsys, "Single Box", option, str(file)) == f"tumble: {option} {file}: its folder does not exist"


def test_json_that_is_a_folder_is_refused_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert refused(capsys, "Single Box", "--json", str(tmp_path)) == f"tumble: --json {tmp_path}: it is a folder"


def test_without_a_peer_there_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "pyb2d3", None)
    line = refused(capsys, "Single Box", "--steps", "1", "--peers")
    assert line == "tumble: pyb2d3 is not installed: pip install 'tumble[peers]'"


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


@pytest.mark.parametrize("value", ["0", "-1", "many"])
@pytest.mark.parametrize("option", ["--steps", "--threads"])
def test_steps_and_threads_must_be_whole_numbers(option: str, value: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as raised:
        main(["bench", option, value])
    assert raised.value.code == BAD_INPUT
    assert "must be a whole number" in capsys.readouterr().err


@pytest.mark.parametrize("value", ["-1", "nan", "soon", "1e9"])
def test_settling_must_be_seconds(value: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as raised:
        main(["bench", "--after", value])
    assert raised.value.code == BAD_INPUT
    assert "must be seconds from 0 to 3600" in capsys.readouterr().err
