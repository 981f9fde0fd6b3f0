"""Whether a snapshot's tables can be a world's: one from a file may hold anything, and kernels trust their rows."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from engine import validate
from engine.effects import BODY_PROPERTIES, SHAPE_PROPERTIES
from engine.effects.sleeping import SOLVERS
from engine.lacking import refuse_lacking
from engine.narrow_phase import COLLIDER_OF
from engine.settings import Settings
from engine.shapes import SHAPES
from engine.shapes.box import BOX
from engine.shapes.capsule import CAPSULE
from engine.shapes.chain import CHAIN
from engine.shapes.circle import CIRCLE
from engine.shapes.polygon import POLYGON
from engine.shapes.segment import SEGMENT
from engine.state import State
from engine.tables import BODY_KINDS, HELD, HULL_POINTS, JOINT_KINDS
from engine.touching import PAIR

FORCES = ("force_x", "force_y", "torque")
MAY_BE_INFINITE = ("mass", "inertia")  # of static bodies
STORAGE_OF = {"shape": "shapes", "body": "bodies"}  # what the columns of a pair are serials of
SIZES = {  # what a shape cannot be without
    BOX: ("half_x", "half_y"), CIRCLE: ("radius",), CAPSULE: ("half_x", "radius"), SEGMENT: ("half_x",),
    CHAIN: ("half_x",),
}  # fmt: skip


def check_tables(settings: Settings, tables: Mapping[str, np.ndarray]) -> None:
    """ValueError, naming the table, if a world of these settings cannot have such tables."""
    state = State(settings)
    expected = state.save()
    optional = {
        f"{name}.{column}": np.empty(0, about.dtype)
        for name, storage in state.storages().items()
        for column, about in storage.possible.items()
    } | {"touching": np.empty(0, PAIR)}
    for name in tables:
        validate.choice("snapshot table", name, {**expected, **optional})
    for name, example in {**expected, **{n: e for n, e in optional.items() if n in tables}}.items():
        table = tables.get(name)
        if table is None or table.dtype != example.dtype or table.ndim != example.ndim:
            raise refuse(name, f"there, of {example.ndim} dimensions and the fields of this version")
        check_finite(name, table)
    for name in (optional.keys() & tables.keys()) - {"touching"}:
        storage = name.partition(".")[0]
        if len(tables[name]) != len(tables[f"{storage}.{storage}"]):
            raise refuse(name, f"as long as {storage}.{storage}")
    check_bodies(tables)
    check_shapes(tables)
    check_joints(tables)
    check_arbiters(tables)
    check_fluids(tables)
    check_touching(tables)
    check_sleep(settings, tables)
    for name in ("step_count", "time", "last_dt", "explosions"):
        if tables[name] < 0:
            raise refuse(name, ">= 0")
    state.load(dict(tables))
    check_effects(state, settings, tables)


def check_effects(state: State, settings: Settings, tables: Mapping[str, np.ndarray]) -> None:
    """Every property is what its effect takes, and the solver knows every effect that is called for."""
    for storage, known in (("bodies", BODY_PROPERTIES), ("shapes", SHAPE_PROPERTIES)):
        for item in known.values():
            name = f"{storage}.{item.name}"
            for value in np.unique(tables[name]) if name in tables else ():
                try:
                    item.check(item.name, value.item())
                except ValueError as error:
                    raise refuse(name, str(error).partition("must be ")[2]) from None
    try:
        refuse_lacking(state, settings)
    except ValueError as error:
        raise ValueError(f"snapshot: {error}") from None


def check_finite(name: str, table: np.ndarray) -> None:
    """No number may be NaN or infinite, but for what static bodies have."""
    columns = {field: table[field] for field in table.dtype.names} if table.dtype.names else {name: table}
    for field, values in columns.items():
        if np.isnan(values).any() or (field not in MAY_BE_INFINITE and not np.isfinite(values).all()):
            raise refuse(name, f"finite, {field} is not")


def check_bodies(tables: Mapping[str, np.ndarray]) -> None:
    """Bodies have serials of their own, kinds and shapes that there are, and a motion each."""
    bodies = tables["bodies.bodies"]
    check_serials("bodies", "bodies", tables)
    if len(tables["bodies.motions"]) != len(bodies):
        raise refuse("bodies.motions", "as long as bodies.bodies")
    living = bodies[bodies["serial"] >= 0]
    check_choices("bodies.bodies", living, kind=len(BODY_KINDS), fixed_rotation=2)


def check_choices(name: str, rows: np.ndarray, **counts: int) -> None:
    """Fields that number one of so many."""
    for field, count in counts.items():
        if ((rows[field] < 0) | (rows[field] >= count)).any():
            raise refuse(name, f"of {field}s from 0 to {count - 1}")


def check_shapes(tables: Mapping[str, np.ndarray]) -> None:
    """Shapes have serials of their own, kinds that there are, living bodies, sizes; polygons a hull of their own."""
    check_serials("shapes", "shapes", tables)
    check_serials("hulls", "hulls", tables)
    shapes, hulls = tables["shapes.shapes"], tables["hulls.hulls"]
    living = shapes[shapes["serial"] >= 0]
    check_choices("shapes.shapes", living, kind=len(SHAPES))
    serials = tables["bodies.bodies"]["serial"]
    owners = living["body"]
    if ((owners < 0) | (owners >= len(serials))).any() or (serials[owners] < 0).any():
        raise refuse("shapes.shapes", "of living bodies")
    for field in ("mass", "friction", "half_x", "half_y", "radius"):
        if (living[field] < 0).any():
            raise refuse("shapes.shapes", f"of no negative {field}")
    for kind, fields in SIZES.items():
        for field in fields:
            if (living[field][living["kind"] == kind] <= 0).any():
                raise refuse("shapes.shapes", f"of {SHAPES[kind].name} shapes with a {field} > 0")
    check_parts(living)
    own = living["hull"][living["kind"] == POLYGON]
    if ((own < 0) | (own >= len(hulls))).any() or (hulls["serial"][own] < 0).any() or len(np.unique(own)) != len(own):
        raise refuse("shapes.shapes", "of polygons with a hull each")
    counts = hulls["count"][hulls["serial"] >= 0]
    if ((counts < 3) | (counts > HULL_POINTS)).any():
        raise refuse("hulls.hulls", f"of 3 to {HULL_POINTS} corners")


def check_parts(living: np.ndarray) -> None:
    """A piece belongs to itself or, of a chain, to an earlier piece of the same chain."""
    by_serial = living[np.argsort(living["serial"])]
    places = np.searchsorted(by_serial["serial"], living["part_of"])
    firsts = by_serial[np.minimum(places, len(living) - 1)]
    alike = (firsts["serial"] == living["part_of"]) & (firsts["part_of"] == firsts["serial"])
    alike &= (firsts["body"] == living["body"]) & (firsts["kind"] == living["kind"])
    alone = living["part_of"] == living["serial"]
    later = (living["kind"] == CHAIN) & (living["part_of"] < living["serial"])
    if not np.all(alike & (alone | later)):
        raise refuse("shapes.shapes", "of pieces that belong together")


def check_joints(tables: Mapping[str, np.ndarray]) -> None:
    """Joints have serials of their own, two living bodies, and parts that belong to their kind."""
    check_serials("joints", "joints", tables)
    joints = tables["joints.joints"]
    living = joints["serial"] >= 0
    for name in ("turns", "slides"):
        if len(tables[f"joints.{name}"]) != len(joints):
            raise refuse(f"joints.{name}", "as long as joints.joints")
    joints = joints[living]
    check_rows("joints.joints", tables, joints["body1"], joints["body2"])
    check_choices("joints.joints", joints, kind=len(JOINT_KINDS), held=len(HELD), collide_connected=2)
    for name in ("softness", "hertz", "damping_ratio"):
        if (joints[name] < 0).any():
            raise refuse("joints.joints", f"of no negative {name}")
    for name in ("turns", "slides"):
        part = tables[f"joints.{name}"][living]
        check_choices(f"joints.{name}", part, along=3, spring=3, motored=2, limited=2)
        if (part["lower"] > part["upper"]).any():
            raise refuse(f"joints.{name}", "of limits, lower before upper")
        for field in ("hertz", "damping_ratio", "max_motor"):
            if (part[field] < 0).any():
                raise refuse(f"joints.{name}", f"of no negative {field}")


def check_sleep(settings: Settings, tables: Mapping[str, np.ndarray]) -> None:
    """Who sleeps may, does not move, and touches or is joined to nobody who has weight and is awake."""
    motions, bodies = tables["bodies.motions"], tables["bodies.bodies"]
    if (motions["still"] < 0).any():
        raise refuse("bodies.motions", "of no negative time that a body has been still")
    for name in ("asleep", "disturbed"):
        if not np.isin(tables.get(f"bodies.{name}", 0), (0, 1)).all():
            raise refuse(f"bodies.{name}", "of 0 and 1")
    asleep = tables.get("bodies.asleep", np.zeros(len(bodies), np.uint8)) != 0
    weighs = (motions["inverse_mass"] > 0) & (bodies["serial"] >= 0)
    if asleep.any() and not (settings.sleeping and settings.solver in SOLVERS):
        raise refuse("bodies.asleep", "of bodies that are awake, with these settings")
    moving = [motions[name] != 0 for name in ("vx", "vy", "w")] + [bodies[name] != 0 for name in FORCES]
    if (asleep & (~weighs | np.any(moving, axis=0))).any():
        raise refuse("bodies.asleep", "of bodies that weigh something, without speed and force")
    joints = tables["joints.joints"]
    for name, rows in (("arbiters", tables["arbiters"]), ("joints.joints", joints[joints["serial"] >= 0])):
        one, other = rows["body1"], rows["body2"]
        if (weighs[one] & weighs[other] & (asleep[one] != asleep[other])).any():
            raise refuse(name, "between bodies that sleep both or neither")


def check_fluids(tables: Mapping[str, np.ndarray]) -> None:
    """Fluids have serials of their own, fill a rectangle, and weigh something."""
    check_serials("fluids", "fluids", tables)
    fluids = tables["fluids.fluids"]
    fluids = fluids[fluids["serial"] >= 0]
    if ((fluids["lower_x"] >= fluids["upper_x"]) | (fluids["lower_y"] >= fluids["upper_y"])).any():
        raise refuse("fluids.fluids", "of rectangles, lower before upper")
    if ((fluids["density"] <= 0) | (fluids["linear_drag"] < 0) | (fluids["angular_drag"] < 0)).any():
        raise refuse("fluids.fluids", "of positive density and no negative drag")


def check_arbiters(tables: Mapping[str, np.ndarray]) -> None:
    """Arbiters stand in ascending order, between living bodies of those serials, with at most two contacts each."""
    arbiters = tables["arbiters"]
    if tables["contacts"].shape != (len(arbiters), 2):
        raise refuse("contacts", "two to each arbiter")
    if ((arbiters["count"] < 1) | (arbiters["count"] > 2)).any():
        raise refuse("arbiters", "of 1 or 2 contacts")
    check_rows("arbiters", tables, arbiters["body1"], arbiters["body2"])
    shapes = tables["shapes.shapes"]
    for number in "12":
        rows = arbiters[f"shape{number}"]
        if ((rows < 0) | (rows >= len(shapes))).any() or (shapes["serial"][rows] != arbiters[f"serial{number}"]).any():
            raise refuse("arbiters", "between the shapes of their serials")
        if (shapes["body"][rows] != arbiters[f"body{number}"]).any():
            raise refuse("arbiters", "between the bodies of their shapes")
    expected = COLLIDER_OF[shapes["kind"][arbiters["shape1"]], shapes["kind"][arbiters["shape2"]]]
    if (arbiters["collider"] != expected).any():
        raise refuse("arbiters", "of shapes that can meet")
    keys = np.stack([arbiters["serial1"], arbiters["serial2"]], axis=1)
    order = np.lexsort((keys[:, 1], keys[:, 0]))
    if (np.diff(order) != 1).any() or len(np.unique(keys, axis=0)) != len(keys) or (keys[:, 0] >= keys[:, 1]).any():
        raise refuse("arbiters", "in ascending order of their serials")


def check_touching(tables: Mapping[str, np.ndarray]) -> None:
    """Pairs whose end is still to be told stand in ascending order, and have serials that were given."""
    pairs = tables.get("touching", np.empty(0, PAIR))
    keys = list(zip(pairs["shape1"].tolist(), pairs["shape2"].tolist(), strict=True))
    if any(first >= second for first, second in pairwise(keys)) or any(first >= second for first, second in keys):
        raise refuse("touching", "of pairs in ascending order of their serials")
    for name in PAIR.names or ():
        if ((pairs[name] < 0) | (pairs[name] >= tables[f"{STORAGE_OF[name[:-1]]}.next_serial"])).any():
            raise refuse("touching", f"of serials of {STORAGE_OF[name[:-1]]} that were given")


def check_serials(storage: str, main: str, tables: Mapping[str, np.ndarray]) -> None:
    """No serial twice, and none that is still to come."""
    serials = tables[f"{storage}.{main}"]["serial"]
    living = serials[serials >= 0]
    if len(np.unique(living)) != len(living) or (living >= tables[f"{storage}.next_serial"]).any():
        raise refuse(f"{storage}.{main}", "of serials given once, below next_serial")


def check_rows(name: str, tables: Mapping[str, np.ndarray], first: np.ndarray, second: np.ndarray) -> None:
    """Both are rows of living bodies, and never the same one."""
    serials = tables["bodies.bodies"]["serial"]
    for rows in (first, second):
        if ((rows < 0) | (rows >= len(serials))).any() or (serials[rows] < 0).any():
            raise refuse(name, "between living bodies")
    if (first == second).any():
        raise refuse(name, "between two different bodies")


def refuse(table: str, allowed: str) -> ValueError:
    return ValueError(f"snapshot: its table {table} must be {allowed}")
