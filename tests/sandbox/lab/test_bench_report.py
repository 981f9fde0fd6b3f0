"""The bench's tables say what was measured, with wall times where there were several threads."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from sandbox.lab.bench_report import as_markdown, as_text
from sandbox.lab.bench_result import BenchResult, PeerResult
from sandbox.lab.page import PageError, check_page, write_section
from sandbox.lab.timing import Figures, Ratio

RESULT = BenchResult(
    scene="Benchmark/Heap",
    threads=1,
    bodies=1001,
    contacts=2000,
    joints=3,
    colours=(700, 200, 50),
    overflow=7,
    after=8.0,
    steps=600,
    peak_memory=321.4,
    cpu=Figures(4.0, 3.5, 12.25),
    wall=Figures(2.125, 1.875, 7.0),
    stages={"broad phase": 0.25, "solve constraints": 3.5},
    peers={"fast": PeerResult(5.0, 2.5, Ratio(0.8, 0.75, 0.9), Ratio(0.85, 0.7, 1.1))},
    left_out={"slow": "it has no heaps"},
)
THREADED = replace(RESULT, threads=2)


def rows(text: str) -> dict[str, list[list[str]]]:
    """The cells of all tables by their first one."""
    found: dict[str, list[list[str]]] = {}
    for line in text.splitlines():
        if line.startswith("| "):
            first, *cells = (cell.strip() for cell in line.strip("|").split("|"))
            found.setdefault(first, []).append(cells)
    return found


def test_markdown_has_all_figures() -> None:
    text = as_markdown([RESULT], "tumble bench Heap --peers")
    assert "`tumble bench Heap --peers`" in text
    times, stages, sizes = rows(text)["Benchmark/Heap"]
    assert times == ["1001", "2000", "4.000", "3.500", "12.2", "5.000", "0.800 (0.750 to 0.900)", "–", "–"]
    assert stages == ["0.250", "3.500"]
    assert sizes == ["3", "3", "7", "2.000", "321", "8.0", "600", "1"]
    assert "- Benchmark/Heap, slow: left out; it has no heaps." in text
    assert "wall" not in text.replace("(wall time)", "")


def test_markdown_rows_are_as_long_as_their_heads() -> None:
    for results in ([RESULT], [THREADED], [RESULT, replace(THREADED, peers={}, left_out={})]):
        lines = [line for line in as_markdown(results, "tumble bench").splitlines() if line.startswith("|")]
        lengths = [line.count("|") for line in lines]
        heads = [index for index, line in enumerate(lines) if line.startswith("|---")]
        assert len(heads) == 3
        for index in heads:
            assert lengths[index - 1] == lengths[index] == lengths[index + 1]


def test_of_several_threads_wall_times_are_told() -> None:
    assert rows(as_markdown([THREADED], "tumble bench"))["Benchmark/Heap"][0] == [
        *("1001", "2000", "4.000", "3.500", "12.2", "2.125"),
        *("5.000", "0.800 (0.750 to 0.900)", "0.850 (0.700 to 1.100)", "–", "–", "–"),
    ]
    text = as_text([replace(THREADED, scene="Benchmark/Large Pyramid", contacts=120_000)])
    assert "…" not in text
    for word in ("wall ms", "2.125", "wall ratio", "0.850 (0.700 to 1.100)"):
        assert word in text
        assert word not in as_text([RESULT])


def test_text_names_peers_that_are_left_out_and_sizes() -> None:
    text = as_text([RESULT])
    for word in ("Benchmark/Heap", "  fast", "0.800 (0.750 to 0.900)", "left out", "solve constraints", "321", "600"):
        assert word in text


def test_a_scene_without_contacts_has_no_time_a_contact() -> None:
    text = as_markdown([replace(RESULT, contacts=0)], "tumble bench")
    assert rows(text)["Benchmark/Heap"][2][3] == ""


def test_a_new_page_is_made_and_written_again(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    for text in ("one", "two"):
        check_page(page, "x")
        write_section(page, "x", text)
    assert page.read_text() == "<!-- x -->\n\ntwo\n\n<!-- end of x -->\n"


@pytest.mark.parametrize("text", ["", "<!-- x -->", "<!-- end of x --><!-- x -->", "<!-- y --><!-- end of y -->"])
def test_a_page_without_its_marks_is_left_alone(tmp_path: Path, text: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(text)
    with pytest.raises(PageError, match="must have the lines <!-- x --> and <!-- end of x -->"):
        write_section(page, "x", "new")
    assert page.read_text() == text


def test_what_is_no_text_is_one_line(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_bytes(b"\xff\xfe\xfa")
    with pytest.raises(PageError, match=r"page\.md: cannot be read: not text$"):
        check_page(page, "x")
    with pytest.raises(PageError, match="cannot be read: Is a directory"):
        check_page(tmp_path, "x")
