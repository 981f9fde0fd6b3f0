"""Compiling in the background: in another process, which ends with what it is for."""

from __future__ import annotations

import subprocess
from typing import Any

import pytest

from sandbox import compiling


def test_what_compiles_in_the_background_ends_with_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[subprocess.Popen[Any]] = []
    popen = subprocess.Popen

    def start(*arguments: Any, **options: Any) -> subprocess.Popen[Any]:
        started.append(popen(*arguments, **options))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start)
    with compiling.compiling_rest("single"):
        assert [process.poll() for process in started] == [None], "it is at work"
    assert [process.poll() is not None for process in started] == [True]
    assert "exercise('single')" in started[0].args[-1]
