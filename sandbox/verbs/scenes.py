"""List the scenes."""

from __future__ import annotations

import argparse

from rich.console import Console
from rich.table import Table

from sandbox.scenes import SCENES
from sandbox.verbs.common import add_json, report

NAME = "scenes"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    data = []
    table = Table(box=None, pad_edge=False)
    for title in ("scene", "bodies", "joints", "what happens"):
        table.add_column(title, justify="right" if title in ("bodies", "joints") else "left")
    for scene in SCENES.values():
        world = scene.make()
        row = {"scene": scene.name, "bodies": world.body_count, "joints": world.joint_count, "summary": scene.summary}
        data.append(row)
        table.add_row(*(str(value) for value in row.values()))
    console = Console()
    if not console.is_terminal:  # whoever reads it takes lines as they are
        console = Console(width=1000)
    with console.capture() as captured:
        console.print(table)
    report(options, data, "\n".join(line.rstrip() for line in captured.get().splitlines()))
    return 0
