"""List the scenes, and what each shows."""

from __future__ import annotations

import argparse

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from sandbox.scenes import SCENES
from sandbox.simulation import TIME_STEP
from sandbox.verbs.common import add_json, report

NAME = "scenes"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    data = []
    table = Table(box=None, pad_edge=False)
    for title in ("scene", "bodies", "joints", "what happens", "what it shows"):
        table.add_column(title, justify="right" if title in ("bodies", "joints") else "left")
    for scene in SCENES.values():
        world = scene.make()
        row = {"scene": scene.name, "bodies": world.body_count, "joints": world.joint_count, "summary": scene.summary}
        claims = [criterion.claim(world, TIME_STEP) for criterion in scene.shows]
        table.add_row(*(escape(str(value)) for value in row.values()), escape("; ".join(claims)))
        data.append({**row, "shows": [criterion.to_dict(world, TIME_STEP) for criterion in scene.shows]})
    console = Console()
    if not console.is_terminal:  # whoever reads it takes lines as they are
        console = Console(width=1000)
    with console.capture() as captured:
        console.print(table)
    report(options, data, "\n".join(line.rstrip() for line in captured.get().splitlines()))
    return 0
