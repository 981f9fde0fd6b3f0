"""Try hard cases: what holds and what falls, by criteria from physics."""

from __future__ import annotations

import argparse

from rich.console import Console
from rich.progress import Progress

from sandbox.compiling import compile_all
from sandbox.lab.stability import CASES, check_all, variants_of
from sandbox.lab.stability_report import as_markdown, as_text
from sandbox.verbs.common import add_json, report, say
from sandbox.verbs.laboratory import add_folder, chosen_names, prepare_folder, write_file

NAME = "stability"
PAGE = "stability.md"
FELL = 1  # exit code: something fell with the settings that a world has if nobody says otherwise


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", nargs="*", help=f"of {', '.join(CASES)}; default: all")
    add_folder(parser, f"write {PAGE} into DIR")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    cases = chosen_names("case", options.case, CASES)
    prepare_folder(options.output)
    compile_all(say, ("single",))
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("trying", total=sum(len(variants_of(case)) for case in cases))
        rows = check_all(cases, lambda: progress.advance(task))
    if options.output is not None:
        write_file(options.output / PAGE, lambda file: file.write_text(as_markdown(rows)))
    report(options, [row.to_dict() for row in rows], as_text(rows))
    ours = [row for row in rows if row.default and row.solver == "soft_step"]
    return 0 if all(row.passed for row in ours) else FELL
