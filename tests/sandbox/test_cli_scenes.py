"""What is piped is not wrapped."""

from __future__ import annotations

import pytest

from sandbox.cli import main
from sandbox.scenes import SCENES


def test_a_piped_list_of_scenes_has_a_line_a_scene(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scenes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 1 + len(SCENES)
    for line, scene in zip(lines[1:], SCENES.values(), strict=True):
        assert line.startswith(scene.name)
        assert line.endswith(scene.summary)
