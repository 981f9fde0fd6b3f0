"""The command `tumble`: one verb a file in sandbox/verbs, one line here."""

from __future__ import annotations

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from importlib import metadata
from typing import NoReturn

# The engine is imported by the verbs, when they are looked for: a Ctrl-C in that second must find `main` at work.

BAD_INPUT = 2  # exit code: what was asked for cannot be
INTERRUPTED = 130  # exit code: Ctrl-C, as shells have it


class Parser(argparse.ArgumentParser):
    """Says in one line what is wrong with the arguments."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {message} (see {self.prog} --help)\n")


def make_parser() -> argparse.ArgumentParser:
    """The parser with all its verbs."""
    from sandbox.verbs import VERBS

    parser = Parser(prog="tumble", description="A 2D physics engine and its laboratory.")
    parser.add_argument("--version", action="version", version=f"tumble {metadata.version('tumble')}")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for verb in VERBS:
        summary = (verb.__doc__ or "").strip().split("\n")[0]
        verb_parser = verbs.add_parser(verb.NAME, help=summary, description=summary)
        verb.add_arguments(verb_parser)
        verb_parser.set_defaults(run=verb.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one verb; its exit code. No traceback reaches the user: what he can mend is one clear line."""
    logging.basicConfig(format="tumble: %(message)s", level=logging.WARNING)
    try:
        code = _run(arguments)
        sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # whoever read our output has gone; what is still in the buffer must not complain later
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _run(arguments: Sequence[str] | None) -> int:
    options = make_parser().parse_args(arguments)
    from sandbox.verbs.common import BadInput

    try:
        return options.run(options)
    except BadInput as error:
        print(f"tumble: {error}", file=sys.stderr)
        return BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
