"""Watching the compiler: only what it really compiles is told, once each."""

from __future__ import annotations

import numba
import pytest

from engine.compilation import watch_compilation
from engine.jit import kernel


def sample(module: str) -> object:
    scope: dict = {"__name__": module, "kernel": kernel}
    exec("@kernel\ndef half(x):\n    return x / 2\n\n@kernel\ndef quarter(x):\n    return half(half(x))", scope)
    return scope["quarter"]


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_each_compilation_is_told_once() -> None:
    quarter, told = sample("engine.sample"), []
    with watch_compilation(told.append):
        quarter(1.0)
        quarter(2.0)
        assert told == ["engine.sample.quarter"], "what it calls is part of it"
        quarter(1)
    assert told == ["engine.sample.quarter"] * 2
    sample("engine.sample")(1.0)
    assert len(told) == 2, "nobody watches any longer"


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_kernels_of_others_are_not_told() -> None:
    told: list[str] = []
    with watch_compilation(told.append):
        sample("elsewhere.sample")(1.0)
    assert told == []
