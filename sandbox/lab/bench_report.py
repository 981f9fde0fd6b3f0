"""The bench's results as tables: for a terminal, and for a page of the documents."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from sandbox.lab.bench import BLOCK
from sandbox.lab.bench_result import BenchResult
from sandbox.lab.tables import rendered
from sandbox.lab.timing import Ratio


def as_text(results: Sequence[BenchResult]) -> str:
    """Times of whole steps, with those of the peers below each scene's; then where our time went, and on what."""
    return "\n\n".join(rendered(table) for table in (step_table(results), stage_table(results), size_table(results)))


def step_table(results: Sequence[BenchResult]) -> Table:
    """CPU time a step, and ours over that of each peer: below 1 we are faster; of several threads wall time, too."""
    threaded = any(result.threads > 1 for result in results)
    caption = f"CPU time; ratio: ours to theirs, median and quartiles over turns of {BLOCK} steps"
    table = Table(box=None, pad_edge=False, caption=caption, caption_justify="left")
    table.add_column("scene", no_wrap=True)
    titles = ["bodies", "contacts", "ms a step", "least", "99 %", "ratio"]
    if threaded:
        titles += ["wall ms", "wall ratio"]
    for title in titles:
        table.add_column(title, justify="right", no_wrap=True)
    for result in results:
        times = (result.cpu.median, result.cpu.least, result.cpu.p99)
        wall = [_ms(result.wall.median), ""] if threaded else []
        table.add_row(result.scene, str(result.bodies), str(result.contacts), *map(_ms, times), "", *wall)
        for name, peer in result.peers.items():
            wall = [_ms(peer.wall_ms_median), _ratio(peer.wall_ratio)] if threaded else []
            ratio = f"{peer.ratio.median:.3f}" if threaded else _ratio(peer.ratio)  # two with quartiles are too wide
            table.add_row(f"  {name}", "", "", _ms(peer.ms_median), "", "", ratio, *wall)
        for name in result.left_out:
            table.add_row(f"  {name}", "", "", "left out", "", "", "", *([""] * len(wall)))
    return table


def stage_table(results: Sequence[BenchResult]) -> Table:
    """Wall time of our stages."""
    table = Table(box=None, pad_edge=False)
    table.add_column("stages, ms a step", no_wrap=True)
    for stage in results[0].stages:
        table.add_column(stage.replace("_", " "), justify="right")
    for result in results:
        table.add_row(result.scene, *map(_ms, result.stages.values()))
    return table


def size_table(results: Sequence[BenchResult]) -> Table:
    """What there was to solve, and what was measured."""
    table = Table(box=None, pad_edge=False)
    table.add_column("size", no_wrap=True)
    for title in ("joints", "colours", "overflow", "µs a contact", "peak memory, MB", "settled, s", "steps", "threads"):
        table.add_column(title, justify="right")
    for result in results:
        table.add_row(result.scene, *_sizes(result))
    return table


def as_markdown(results: Sequence[BenchResult], command: str) -> str:
    """The tables of docs/performance.md; command: the one that they come from."""
    peers = list(dict.fromkeys(name for result in results for name in (*result.peers, *result.left_out)))
    threaded = any(result.threads > 1 for result in results)
    heads = ["scene", "bodies", "contacts", "ms a step", "least", "99 %"] + ["wall ms"] * threaded
    for name in peers:
        heads += [f"{name}, ms", f"times {name}'s"] + [f"wall, times {name}'s"] * threaded
    rows = []
    for result in results:
        cells = [result.scene, str(result.bodies), str(result.contacts)]
        cells += map(_ms, (result.cpu.median, result.cpu.least, result.cpu.p99))
        if threaded:
            cells.append(_ms(result.wall.median))
        for name in peers:
            cells += _peer_cells(result, name, threaded=threaded)
        rows.append(cells)
    lines = [
        f"Made by `{command}`. Times are CPU times of whole steps,",
        "ours over theirs below 1 where ours is faster: the",
        f"median and, in brackets, the quartiles over turns of {BLOCK} steps.",
        "",
        *_markdown(heads, rows),
    ]
    left_out = [(result.scene, name, why) for result in results for name, why in result.left_out.items()]
    if left_out:
        lines += ["", *(f"- {scene}, {name}: left out; {why}." for scene, name, why in left_out)]
    stages = [stage.replace("_", " ") for stage in results[0].stages]
    lines += ["", "Where our time goes, ms a step (wall time):", ""]
    lines += _markdown(["scene", *stages], [[r.scene, *map(_ms, r.stages.values())] for r in results])
    heads = ["joints", "colours", "overflow", "µs a contact", "peak memory, MB", "settled, s", "steps", "threads"]
    lines += ["", *_markdown(["scene", *heads], [[r.scene, *_sizes(r)] for r in results])]
    return "\n".join(lines) + "\n"


def _peer_cells(result: BenchResult, name: str, *, threaded: bool) -> list[str]:
    peer = result.peers.get(name)
    if peer is None:
        return ["–"] * (2 + threaded)
    return [_ms(peer.ms_median), _ratio(peer.ratio)] + [_ratio(peer.wall_ratio)] * threaded


def _sizes(result: BenchResult) -> list[str]:
    contact = f"{1e3 * result.cpu.median / result.contacts:.3f}" if result.contacts else ""
    counts = [result.joints, len(result.colours), result.overflow]
    after = f"{result.after:.1f}"
    return [*map(str, counts), contact, f"{result.peak_memory:.0f}", after, str(result.steps), str(result.threads)]


def _markdown(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """A table: the first column to the left, numbers to the right."""
    lines = ["| " + " | ".join(heads) + " |", "|---" + "|---:" * (len(heads) - 1) + "|"]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def _ms(value: float) -> str:
    """Milliseconds, to the microsecond where that says something."""
    return f"{value:.3f}" if value < 10.0 else f"{value:.1f}"


def _ratio(ratio: Ratio) -> str:
    return f"{ratio.median:.3f} ({ratio.low:.3f} to {ratio.high:.3f})"
