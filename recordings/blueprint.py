"""How the file opens: the scene filled, y up and playing, the plots beside it."""

from __future__ import annotations

import rerun as rr
import rerun.blueprint as rrb

from recordings import palette, schema

CAMERA_DISTANCE = 100.0  # [m]; from 1000 m the depth buffer could not tell a mark from the box under it
_PICTURE = (1600, 1000)  # pixels of the camera's picture; only its proportions matter


def static_entities(view: tuple[float, float, float]) -> list[tuple[str, rr.AsComponents]]:
    """What never changes: the camera that shows `view` (centre x, y and height [m]), the looks of marks and curves."""
    x, y, height = view
    width_pixels, height_pixels = _PICTURE
    pinhole = rr.Pinhole(
        focal_length=height_pixels / height * CAMERA_DISTANCE,
        width=width_pixels,
        height=height_pixels,
        camera_xyz=rr.ViewCoordinates.RUB,
    )
    ui = rr.Radius.ui_points
    return [
        ("/world", rr.ViewCoordinates.RUB),
        (schema.CAMERA, pinhole),
        (schema.CAMERA, rr.Transform3D(translation=[x, y, CAMERA_DISTANCE])),
        (schema.CONTACT_POINTS, rr.Points3D.from_fields(colors=[palette.CONTACT], radii=ui(2.5))),
        (schema.IMPULSE_ARROWS, rr.Arrows3D.from_fields(colors=[palette.IMPULSE], radii=ui(1.0))),
        (schema.HIT_POINTS, rr.Points3D.from_fields(colors=[palette.HIT])),
        (schema.JOINT_LINES, rr.LineStrips3D.from_fields(colors=[palette.JOINT], radii=ui(1.0))),
        (schema.ENERGY, _lines(["kinetic", "potential", "total"], [palette.KINETIC, palette.POTENTIAL, palette.TOTAL])),
        (schema.PENETRATION, _lines(["deepest"], [palette.PENETRATION])),
        (schema.COUNTS, _lines(["bodies", "contacts", "joints"], list(palette.COUNTS))),
    ]


def stage_lines(stages: list[str]) -> rr.SeriesLines:
    """Names and colours of the curves of stage times."""
    return _lines(stages, [tuple(palette.STAGES[i % len(palette.STAGES)]) for i in range(len(stages))])


def layout() -> rrb.Blueprint:
    """The scene with its log on the left, four plots on the right, playing in simulated time."""
    scene = rrb.Spatial2DView(
        name="Scene", origin=schema.CAMERA, contents=["/world/**"], background=[*palette.BACKGROUND, 255]
    )
    log = rrb.Tabs(
        rrb.TextLogView(name="Commands", origin=schema.EVENTS),
        rrb.TextLogView(name="Events", origin=schema.HAPPENED),
    )
    plots = rrb.Vertical(
        _plot("Energy [J]", schema.ENERGY),
        _plot("Penetration [m]", schema.PENETRATION),
        _plot("Counts", schema.COUNTS),
        _plot("Stage times [ms]", schema.STAGE_TIMES),
    )
    return rrb.Blueprint(
        rrb.Horizontal(rrb.Vertical(scene, log, row_shares=[6, 1]), plots, column_shares=[7, 3]),
        rrb.TimePanel(
            timeline=schema.TIME_TIMELINE, play_state="playing", loop_mode="all", playback_speed=1.0, state="collapsed"
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _lines(names: list[str], colors: list[tuple[int, ...]]) -> rr.SeriesLines:
    return rr.SeriesLines(names=names, colors=colors, widths=[1.5] * len(names))


def _plot(name: str, path: str) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(name=name, origin=path, axis_x=rrb.TimeAxis(link="LinkToGlobal"))
