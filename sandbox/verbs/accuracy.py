"""Show what accuracy costs: errors against exact answers, and CPU time."""

from __future__ import annotations

import argparse

from rich.console import Console
from rich.progress import Progress

from engine import StepError
from sandbox.compiling import compile_all
from sandbox.lab.accuracy import SERIES, measure, runs_of
from sandbox.lab.accuracy_report import PICTURE, as_markdown, as_text
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.verbs.common import BadInput, add_json, report, say
from sandbox.verbs.laboratory import add_folder, chosen_names, prepare_folder, write_file

NAME = "accuracy"
PAGE = "accuracy.md"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", nargs="*", help=f"of {', '.join(EXPERIMENTS)}; default: all")
    add_folder(parser, f"write {PAGE} and the work-precision diagram {PICTURE} into DIR")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    experiments = [EXPERIMENTS[name] for name in chosen_names("scene", options.scene, EXPERIMENTS)]
    prepare_folder(options.output)
    compile_all(say, ("single", "double"))
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("measuring", total=runs_of(experiments))
        try:
            rows = measure(experiments, SERIES, progress=lambda: progress.advance(task))
        except StepError as error:
            raise BadInput(str(error)) from None
    if options.output is not None:
        from sandbox.lab.accuracy_picture import draw

        write_file(options.output / PICTURE, lambda file: draw(rows, file))
        write_file(options.output / PAGE, lambda file: file.write_text(as_markdown(rows)))
    report(options, [row.to_dict() for row in rows], as_text(rows))
    return 0
