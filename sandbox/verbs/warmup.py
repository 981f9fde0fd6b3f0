"""Compile the engine beforehand, so that nothing waits for it later."""

from __future__ import annotations

import argparse

from engine.tables import REALS
from sandbox.compiling import compile_all
from sandbox.verbs.common import add_json, report, say

NAME = "warmup"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    count, seconds = compile_all(say, REALS)
    text = f"{count} kernels compiled in {seconds:.1f} s" if count else f"all kernels are on disk ({seconds:.1f} s)"
    report(options, {"kernels_compiled": count, "seconds": seconds}, text)
    return 0
