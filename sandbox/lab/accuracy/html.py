"""A sweep as one HTML page that needs nothing else: diagrams with titles to hover over, tables, light and dark."""

from __future__ import annotations

import html
from collections.abc import Sequence

from sandbox.lab.accuracy.chart import inline, told
from sandbox.lab.accuracy.groups import Group, by_measure, number, solvers_of
from sandbox.lab.accuracy.pareto import TARGETS, cheapest, front, solves
from sandbox.lab.accuracy.report import left_out, not_applicable, picture_name, summary
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.running import Outcome
from sandbox.lab.accuracy.style import VARIED, colour_of, style
from sandbox.lab.experiments import EXPERIMENTS

TITLE = "What accuracy costs"
INTRODUCTION = (
    "Every scene has an answer that is known. Each point is one setting of one solver: how far off that answer it "
    "came, and what a simulated second cost. Down and to the left is better; ringed points are beaten by none in both. "
    "Dashed lines are errors that were predicted before anything ran. Point at anything to read its numbers."
)


def as_html(outcome: Outcome) -> str:
    """The page. It asks no network for anything."""
    groups, solvers = by_measure(outcome.rows), solvers_of(outcome.rows)
    cards = "".join(_card(group, solvers, first) for group, first in _with_first(groups))
    notes = "".join(f"<li>{html.escape(line)}</li>" for line in (*not_applicable(outcome), *left_out(outcome)))
    parts = (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>',
        '<meta name="viewport" content="width=device-width,initial-scale=1">',
        f'<style>{style("body")}{PAGE}</style></head><body class="ms-axis">',
        f"<header><h1>{TITLE}</h1><p>{INTRODUCTION}</p>",
        f'<p class="quiet">{html.escape(summary(outcome))}</p></header><nav>{_switches(solvers)}</nav>',
        "<section><h2>The cheapest setting that comes within a part of the scale</h2>",
        f"{_cheapest(groups, solvers)}</section>",
        f'<section><h2>Error against price</h2><div class="cards">{cards}</div></section>',
        f"<section><h2>Not applicable, and left out</h2><ul>{notes}</ul></section>",
        f"<script>{SCRIPT}</script></body></html>\n",
    )
    return "".join(parts)


def _with_first(groups: Sequence[Group]) -> list[tuple[Group, bool]]:
    """Each with whether it is its scene's first."""
    scenes = [group.scene for group in groups]
    return [(group, group.scene not in scenes[:place]) for place, group in enumerate(groups)]


def _switches(solvers: Sequence[str]) -> str:
    """Which solvers are shown, and what they are measured by."""
    boxes = "".join(
        f'<label style="--line:{colour_of(name, solvers)}">'
        f'<input type="checkbox" checked data-shows="{html.escape(name)}"><i></i>{html.escape(name)}</label>'
        for name in solvers
    )
    axes = (
        '<label><input type="radio" name="axis" value="ms" checked>milliseconds</label>'
        '<label><input type="radio" name="axis" value="solves">constraints solved</label>'
    )
    kinds = "".join(f"<span>{MARKS[kind]} {name}</span>" for kind, name in VARIED.items())
    return f'<div>{boxes}</div><div>{axes}</div><div class="quiet">{kinds}</div>'


def _card(group: Group, solvers: Sequence[str], first: bool) -> str:
    """One measure; the first of a scene is where links to the scene lead."""
    place = f' id="{picture_name(group.scene)}"' if first else ""
    return (
        f'<figure class="card"{place}>{inline(group, solvers)}{inline(group, solvers, solves, "solves")}'
        f"<figcaption>{html.escape(EXPERIMENTS[group.scene].says)}; "
        f"scale: {html.escape(group.against)}</figcaption>{_best(group, solvers)}</figure>"
    )


def _best(group: Group, solvers: Sequence[str]) -> str:
    """The Pareto front as a table, to be unfolded."""
    rows = "".join(
        f'<tr><td><i style="--line:{colour_of(row.solver, solvers)}"></i>{html.escape(row.solver)}</td>'
        f"<td>{html.escape(row.setting)}</td><td>{number(row.error)}</td><td>{number(row.relative)}</td>"
        f"<td>{row.cost_ms:.3g} ± {row.spread_ms / 2:.1g}</td></tr>"
        for row in front(group.rows)
    )
    head = "<tr><th>solver</th><th>setting</th><th>error</th><th>of the scale</th><th>ms</th></tr>"
    return f"<details><summary>what nothing beats</summary><table>{head}{rows}</table></details>"


def _cheapest(groups: Sequence[Group], solvers: Sequence[str]) -> str:
    heads = "".join(f"<th>{target:.0e}</th>" for target in TARGETS)
    lines = []
    for group in groups:
        cells = "".join(_cell(cheapest(group.rows, target), solvers) for target in TARGETS)
        link = f'<a href="#{picture_name(group.scene)}">{html.escape(group.scene)}</a>'
        lines.append(f'<tr><td>{link}<br><span class="quiet">{html.escape(group.measure)}</span></td>{cells}</tr>')
    return f'<div class="wide"><table><tr><th>scene, measure</th>{heads}</tr>{"".join(lines)}</table></div>'


def _cell(row: Row | None, solvers: Sequence[str]) -> str:
    if row is None:
        return '<td class="quiet">–</td>'
    return (
        f'<td title="{html.escape(told(row))}"><i style="--line:{colour_of(row.solver, solvers)}"></i>'
        f'{html.escape(row.setting)}<br><span class="quiet">{html.escape(row.solver)}, {row.cost_ms:.2g} ms</span></td>'
    )


MARKS = {"": "●", "steps": "■", "iterations": "◆", "fixed": "▼", "double": "▲"}

PAGE = (
    "body{margin:0 auto;max-width:1240px;padding:28px 20px 60px;background:var(--paper);color:var(--text);"
    "font:15px/1.5 system-ui,sans-serif}"
    "h1,h2{color:var(--strong);font-weight:600;letter-spacing:-.01em}h1{font-size:30px;margin:0}"
    "h2{font-size:19px;margin:44px 0 2px}header p{max-width:72ch}.quiet{opacity:.75;font-size:.88em}"
    "nav{position:sticky;top:0;z-index:1;padding:10px 0;background:var(--paper);border-bottom:1px solid var(--grid)}"
    "nav div{display:flex;flex-wrap:wrap;gap:4px 18px}nav label{cursor:pointer;user-select:none}"
    "i{display:inline-block;width:9px;height:9px;border-radius:50%;background:var(--line);margin-right:6px}"
    ".cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,500px),1fr));gap:16px}"
    ".card{margin:8px 0 0;padding:14px;border-radius:10px;background:var(--card);border:1px solid var(--grid)}"
    ".card svg{width:100%;height:auto;display:block}figcaption{font-size:.85em;padding:4px 0 0 11%}"
    ".card details{padding-left:11%}"
    "table{border-collapse:collapse;font-size:.86em;font-variant-numeric:tabular-nums}td,th{padding:5px 14px 5px 0;"
    "text-align:left;vertical-align:top;border-bottom:1px solid var(--grid)}th{color:var(--strong);font-weight:600}"
    ".wide{overflow-x:auto}a{color:inherit;color:var(--strong)}summary{cursor:pointer;font-size:.88em;padding-top:6px}"
    "body.ms-axis svg.solves,body.solves-axis svg.ms{display:none}.off{display:none}"
)

SCRIPT = (
    "for(const box of document.querySelectorAll('[data-shows]'))box.onchange=()=>{"
    "for(const line of document.querySelectorAll('[data-solver]'))if(line.dataset.solver===box.dataset.shows)"
    "line.classList.toggle('off',!box.checked)};"
    "for(const one of document.querySelectorAll('[name=axis]'))one.onchange=()=>"
    "{document.body.className=one.value+'-axis'}"
)
