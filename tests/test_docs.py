"""What the documents say is so: their programs run and print what they claim, and all that they name exists."""

from __future__ import annotations

import argparse
import ast
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from sandbox.cli import make_parser
from sandbox.verbs import VERBS

ROOT = Path(__file__).parents[1]
DOCUMENTS = sorted(path.relative_to(ROOT).as_posix() for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")))

# A program, and what it prints if that follows.
PROGRAM = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", re.DOTALL | re.MULTILINE)
FENCED = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`([^`\n]+)`")
# `path`, `path/` or `path::name`; NAME in capitals stands for something to be made.
REFERENCE = re.compile(r"(?P<path>(?:[\w.-]+/)+(?:[\w.-]+\.\w+)?|[\w-]+\.(?:py|md|toml|txt))(?:::(?P<name>[\w.]+))?")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def text_of(document: str) -> str:
    return (ROOT / document).read_text(encoding="utf-8")


PROGRAMS = [
    pytest.param(program, printed or None, id=f"{document}-{number}")
    for document in DOCUMENTS
    for number, (program, printed) in enumerate(PROGRAM.findall(text_of(document)), 1)
]


@pytest.mark.parametrize(("program", "printed"), PROGRAMS)
def test_program_runs_and_prints_what_it_says(program: str, printed: str | None) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", program]
    result = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert result.returncode == 0, result.stderr
    if printed is not None:
        assert result.stdout == printed


def test_the_readme_has_ten_lines_of_python() -> None:
    program = PROGRAM.findall(text_of("README.md"))[0][0]
    assert len([line for line in program.splitlines() if line]) == 10


def references(document: str) -> list[tuple[str, str | None]]:
    """(path, name) of everything in backticks that looks like a file or a folder of ours."""
    matches = map(REFERENCE.fullmatch, CODE.findall(FENCED.sub("", text_of(document))))
    return [(m["path"], m["name"]) for m in matches if m is not None and "NAME" not in m["path"]]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_what_is_named_exists(document: str) -> None:
    missing = []
    for path, name in references(document):
        target = ROOT / path
        if not target.exists() or (name is not None and name not in names_in(target)):
            missing.append(f"{path}::{name}" if name else path)
    assert not missing, f"{document} names what is not there: {', '.join(missing)}"


@cache
def names_in(file: Path) -> set[str]:
    """Functions, classes and constants of a module; methods and fields as Class.name."""
    return set(_names(ast.parse(file.read_text(encoding="utf-8")).body, ""))


def _names(body: list[ast.stmt], prefix: str) -> list[str]:
    found = []
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            found.append(prefix + node.name)
            if isinstance(node, ast.ClassDef):
                found += _names(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found += [prefix + name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
    return found


def test_the_walk_through_names_files_and_functions() -> None:
    # if the convention changed, the tests above would find nothing and pass
    for document, least in (("docs/the_step.md", 40), ("CONTRIBUTING.md", 40), ("docs/glossary.md", 40)):
        assert sum(name is not None for _, name in references(document)) >= least, document


@pytest.mark.parametrize("document", DOCUMENTS)
def test_links_lead_somewhere(document: str) -> None:
    links = [link.partition("#")[0] for link in LINK.findall(FENCED.sub("", text_of(document)))]
    relative = [link for link in links if link and not link.startswith(("https://", "mailto:"))]
    broken = [link for link in relative if not (ROOT / document).parent.joinpath(link).exists()]
    assert not broken, f"{document} links to what is not there: {', '.join(broken)}"


def test_every_verb_is_in_the_readmes_table() -> None:
    rows = re.findall(r"^\| `tumble (\w+)", text_of("README.md"), re.MULTILINE)
    assert rows == [verb.NAME for verb in VERBS]


def options_of(verb: str) -> set[str]:
    parsers = next(action for action in make_parser()._actions if isinstance(action, argparse._SubParsersAction))
    return {option for action in parsers.choices[verb]._actions for option in action.option_strings}


@pytest.mark.parametrize("document", DOCUMENTS)
def test_commands_shown_have_these_options(document: str) -> None:
    lines = re.findall(r"\btumble (\w+)([^`\n#|]*)", text_of(document))
    for verb, rest in [(verb, rest) for verb, rest in lines if verb in {verb.NAME for verb in VERBS}]:
        unknown = set(re.findall(r"(?<!\S)--?[a-z][\w-]*", rest)) - options_of(verb)
        assert not unknown, f"{document}: tumble {verb} has no {', '.join(sorted(unknown))}"


def test_make_targets_shown_exist() -> None:
    targets = set(re.findall(r"^([a-z]+):", text_of("Makefile"), re.MULTILINE))
    for document in DOCUMENTS:
        shown = set(re.findall(r"(?:`|^ {4}|=1 )make ([a-z]+)", text_of(document), re.MULTILINE))
        assert shown <= targets, f"{document}: make {', '.join(sorted(shown - targets))}"


@pytest.mark.parametrize("document", DOCUMENTS)
def test_lines_fit_a_window(document: str) -> None:
    prose = [line for line in text_of(document).splitlines() if not line.startswith(("|", "!["))]
    assert max(map(len, prose)) <= 144
