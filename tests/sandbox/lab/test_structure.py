"""Statics of piles: against closed forms, against equilibrium itself, and of what does not stand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import World
from sandbox.lab.sag import (
    BOX_INERTIA,
    column_sag,
    joint_gap,
    predicted_column,
    predicted_pyramid,
    predicted_sink,
    pyramid,
    spring_sag,
)
from sandbox.lab.structure import GROUND, Point, Structure

G = 10.0
DT = 1 / 60


def column(count: int, half_width: float = 0.5, inertia: float = BOX_INERTIA) -> Structure:
    points = [Point(k - 1 if k else GROUND, k, x, float(k)) for k in range(count) for x in (-half_width, half_width)]
    centers = np.column_stack([np.zeros(count), np.arange(count) + 0.5])
    return Structure(centers, np.ones(count), np.full(count, inertia), points)


def unbalanced(structure: Structure, forces: np.ndarray) -> np.ndarray:
    """(N, 3) weight and normal forces on each body: zero if nothing rubs."""
    left = np.zeros((len(structure.masses), 3))
    left[:, 1] = -G * structure.masses
    for point, force in zip(structure.points, forces, strict=True):
        for sign, body in ((-1.0, point.first), (1.0, point.second)):
            if body != GROUND:
                rx, ry = np.array([point.x, point.y]) - structure.centers[body]
                left[body] += sign * force * np.array([point.nx, point.ny, rx * point.ny - ry * point.nx])
    return left


@pytest.mark.parametrize("count", [1, 2, 10, 40])
@pytest.mark.parametrize("half_width", [0.5, 0.2])
def test_column_sinks_by_its_closed_form(count: int, half_width: float) -> None:
    rest = column(count, half_width).settle(30.0, G)
    assert -rest.moved[-1, 1] == pytest.approx(column_sag(count, 30.0, G, BOX_INERTIA, half_width), rel=1e-5)
    assert rest.moved[:, [0, 2]] == pytest.approx(0.0, abs=1e-9)


def test_twenty_boxes_sink_as_far_as_field_measurements_say() -> None:
    # Box2D v3 at 4 substeps: 0.135 m of 20, 0.552 m of 40, 2.24 m of 80
    assert [round(column_sag(count, 30.0, G), 3) for count in (20, 40, 80)] == [0.135, 0.552, 2.23]


def test_stiffer_by_two_sinks_less_by_four() -> None:
    assert column_sag(9, 30.0, G) / column_sag(9, 60.0, G) == pytest.approx(4.0)


def test_contacts_of_a_column_carry_the_weight_above() -> None:
    forces = column(6).settle(30.0, G).forces.reshape(6, 2)
    assert forces.sum(axis=1) == pytest.approx([60.0, 50.0, 40.0, 30.0, 20.0, 10.0], rel=1e-5)
    assert forces[:, 0] == pytest.approx(forces[:, 1])


@pytest.mark.parametrize("base", [1, 2, 7])
@pytest.mark.parametrize("spacing", [1.0, 1.125])
def test_smooth_pyramid_is_in_balance(base: int, spacing: float) -> None:
    structure = pyramid(base, spacing)
    forces = structure.settle(30.0, G, friction=False).forces
    assert len(structure.masses) == base * (base + 1) // 2
    assert (forces >= 0.0).all()
    assert unbalanced(structure, forces) == pytest.approx(0.0, abs=1e-3)


def test_ground_carries_all_of_a_pyramid() -> None:
    structure = pyramid(9)
    on_ground = [k for k, point in enumerate(structure.points) if point.first == GROUND]
    assert structure.settle(30.0, G).forces[on_ground].sum() == pytest.approx(45 * G, rel=1e-5)


def test_friction_makes_a_pyramid_stiffer() -> None:
    structure = pyramid(9)
    rough, smooth = (-structure.settle(30.0, G, friction=held).moved[-1, 1] for held in (True, False))
    assert 0.5 * smooth < rough < smooth


def test_layers_and_all_at_once_agree() -> None:
    # elimination layer by layer against one dense matrix of all springs
    structure = pyramid(4)
    hertz = 30.0
    first = np.array([point.first for point in structure.points])
    stiffness = structure.effective_masses() * (2 * math.pi * hertz * np.where(first == GROUND, 2.0, 1.0)) ** 2
    rows, held = [], []
    for point, k in zip(structure.points, stiffness, strict=True):
        for nx, ny, times in ((point.nx, point.ny, 1.0), (-point.ny, point.nx, 1e3)):
            row = np.zeros((len(structure.masses), 3))
            for sign, body in ((-1.0, point.first), (1.0, point.second)):
                if body != GROUND:
                    rx, ry = np.array([point.x, point.y]) - structure.centers[body]
                    row[body] += sign * np.array([nx, ny, rx * ny - ry * nx])
            rows.append(row.ravel())
            held.append(times * k)
    a = np.array(rows)
    weight = np.zeros((len(structure.masses), 3))
    weight[:, 1] = -G
    dense = np.linalg.solve(a.T @ (np.array(held)[:, None] * a), weight.ravel()).reshape(-1, 3)
    assert structure.settle(hertz, G).moved == pytest.approx(dense, rel=1e-4, abs=1e-8)


def test_contacts_do_not_pull() -> None:
    # a plank on two posts with a weight beyond the right one: the left contact would have to hold it down
    points = [Point(GROUND, 0, -1.0, 0.0), Point(GROUND, 0, 0.4, 0.0), Point(GROUND, 0, 0.6, 0.0)]
    structure = Structure(np.array([[0.59, 0.1]]), np.array([1.0]), np.array([0.5]), points)
    forces = structure.settle(30.0, G).forces
    assert forces[0] == 0.0
    assert forces[1:].sum() == pytest.approx(G, rel=1e-6)


def test_what_is_held_by_nothing_is_refused() -> None:
    points = [Point(GROUND, 0, 0.0, 0.0)]
    structure = Structure(np.zeros((2, 2)), np.ones(2), np.ones(2), points)
    with pytest.raises(ValueError, match="must hold every body"):
        structure.settle(30.0, G)


def test_a_unit_weight_is_carried_by_each_contact_of_a_column() -> None:
    assert column(5).carried(4).reshape(5, 2).sum(axis=1) == pytest.approx(1.0, rel=1e-5)
    assert column(5).carried(1).reshape(5, 2).sum(axis=1) == pytest.approx([1, 1, 0, 0, 0], abs=1e-5)


# --- with the settings of a world -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("settings", "hertz"), [({}, 30), ({"substeps": 8}, 60), ({"substeps": 2}, 15)])
def test_stiffness_follows_the_substeps(settings: dict, hertz: float) -> None:
    assert predicted_column(World(**settings), DT, 12) == pytest.approx(column_sag(12, hertz, G))


def test_fixed_stiffness_stays() -> None:
    world = World(substeps=32, stiffness="fixed")
    assert predicted_column(world, DT, 12) == pytest.approx(column_sag(12, 30.0, G))


def test_sequential_impulses_leave_their_slop() -> None:
    world = World(solver="sequential_impulses")
    assert predicted_column(world, DT, 12) == pytest.approx(0.12)
    assert predicted_pyramid(world, DT, 12) == pytest.approx(0.12)
    assert predicted_sink(world, DT, column(12), 11) == pytest.approx(0.12, rel=1e-4)


def test_predictions_of_a_column_agree() -> None:
    world = World()
    assert predicted_sink(world, DT, column(7), 6) == pytest.approx(predicted_column(world, DT, 7), rel=1e-5)


def test_a_pyramid_of_one_is_a_column() -> None:
    assert predicted_pyramid(World(), DT, 1) == pytest.approx(predicted_column(World(), DT, 1), rel=1e-5)


def test_spring_gives_way_by_force_over_stiffness() -> None:
    assert spring_sag(30.0, 1.5, 60.0) == pytest.approx(30.0 / (1.5 * (2 * math.pi * 60.0) ** 2))


@pytest.mark.parametrize("settings", [{}, {"substeps": 16}, {"substeps": 16, "stiffness": "fixed"}])
def test_joint_of_a_hanging_body_gives_way_by_its_weight(settings: dict) -> None:
    hertz = 60.0 if settings.get("stiffness") == "fixed" else settings.get("substeps", 4) * 60 / 4
    assert joint_gap(World(**settings), DT, G, 0.0) == pytest.approx(spring_sag(G, 1.0, hertz))
