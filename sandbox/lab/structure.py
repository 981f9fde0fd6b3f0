"""Statics of what rests on its contacts: how far it sinks, and what each contact carries. No engine in it.

A contact point of the soft step is a spring of m w^2, m being its effective mass and w = 2 pi f its frequency; where
friction holds, nothing slides. So a pile at rest is an elastic structure: K u = weight. Contacts push only, so those
that would pull are left out, and the rest solved again. Bodies are taken layer by layer as they lie on each other,
which makes K block tridiagonal: 5,050 boxes take a second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

GROUND = -1  # index of whatever does not move
NO_SLIP = 1e3  # stiffness along a contact that holds, in parts of that across it
HELD = 1e-12  # of a body that nothing touches, in parts of the stiffest contact: K must not be singular
MOST_ROUNDS = 50


class Point(NamedTuple):
    """A contact point: where [m], and the unit normal, from the first body to the second."""

    first: int
    second: int
    x: float
    y: float
    nx: float = 0.0
    ny: float = 1.0


class Rest(NamedTuple):
    """A structure at rest."""

    moved: np.ndarray  # (N, 3) x, y [m] and angle [rad] of each body, from where it was without weight
    forces: np.ndarray  # (C,) normal force of each contact [N]


@dataclass(frozen=True)
class Structure:
    """Bodies and the points at which they touch."""

    centers: np.ndarray  # (N, 2) [m]
    masses: np.ndarray  # (N,) [kg]
    inertias: np.ndarray  # (N,) [kg m^2]
    points: Sequence[Point]

    def settle(self, hertz: float, gravity: float, static_stiffening: float = 2.0, *, friction: bool = True) -> Rest:
        """Under its weight, on contacts of that frequency [Hz]; those with the ground that many times higher."""
        weight = np.zeros((len(self.masses), 3))
        weight[:, 1] = -gravity * self.masses
        omega = 2.0 * np.pi * hertz * np.where(self._bodies()[0] == GROUND, static_stiffening, 1.0)
        return self._solve(self.effective_masses() * omega**2, weight, friction=friction)

    def carried(self, body: int) -> np.ndarray:
        """(C,) normal forces under a unit weight at one body's centre, all else weightless and all contacts alike.

        By virtual work, overlaps d at the contacts let that body sink by the sum of these times d.
        """
        weight = np.zeros((len(self.masses), 3))
        weight[body, 1] = -1.0
        return self._solve(np.ones(len(self.points)), weight, friction=True).forces

    def effective_masses(self) -> np.ndarray:
        """(C,) mass that a push along each normal feels, 1 / (sum of 1/m + (r x n)^2 / I) [kg]."""
        inverse = np.zeros(len(self.points))
        for bodies, (normals, _) in zip(self._bodies(), self._directions(), strict=True):
            moves = bodies != GROUND
            inverse += moves * (1.0 / self.masses[bodies] + normals[:, 2] ** 2 / self.inertias[bodies])
        return 1.0 / inverse

    # --- inside -------------------------------------------------------------------------------------------------

    def _bodies(self) -> np.ndarray:
        """(2, C) both bodies of each point."""
        return np.array([[point.first for point in self.points], [point.second for point in self.points]])

    def _directions(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """For either body: (C, 3) what its motion (x, y, angle) does along each normal, and along each tangent."""
        table = np.array([point[2:] for point in self.points])
        place, normal = table[:, :2], table[:, 2:]
        tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
        sides = []
        for bodies in self._bodies():
            r = place - self.centers[bodies]  # of the ground: anything, it is masked out
            sides.append(tuple(np.column_stack([d, r[:, 0] * d[:, 1] - r[:, 1] * d[:, 0]]) for d in (normal, tangent)))
        return sides  # type: ignore[return-value]

    def _solve(self, stiffness: np.ndarray, weight: np.ndarray, *, friction: bool) -> Rest:
        first, second = self._bodies()
        (n1, t1), (n2, t2) = self._directions()
        layers = self._layers()
        pushes = np.ones(len(self.points), bool)
        for _ in range(MOST_ROUNDS):
            springs = [(pushes * stiffness, n1, n2)]
            if friction:
                springs.append((NO_SLIP * pushes * stiffness, t1, t2))
            moved = _solve_layers(layers, springs, first, second, weight)
            apart = np.zeros(len(self.points))
            for sign, bodies, normals in ((-1.0, first, n1), (1.0, second, n2)):
                apart += sign * (bodies != GROUND) * np.sum(moved[bodies] * normals, axis=1)
            if np.array_equal(pushes, apart < 0.0):
                return Rest(moved, np.where(pushes, -stiffness * apart, 0.0))
            pushes = apart < 0.0
        raise ArithmeticError("the contacts that push were not found: this does not stand")

    def _layers(self) -> list[np.ndarray]:
        """Bodies by how many contacts they are from the ground, so that a layer touches itself and its neighbours."""
        first, second = self._bodies()
        depth = np.full(len(self.masses), -1)
        depth[second[first == GROUND]] = depth[first[second == GROUND]] = 0
        between = (first != GROUND) & (second != GROUND)
        a, b = first[between], second[between]
        layers = [np.flatnonzero(depth == 0)]
        while len(layers[-1]):
            reached = depth == len(layers) - 1
            new = np.concatenate([b[reached[a]], a[reached[b]]])
            new = np.unique(new[depth[new] < 0])
            depth[new] = len(layers)
            layers.append(new)
        if (depth < 0).any():
            raise ValueError("points: must hold every body up from the ground")
        return layers[:-1]


Spring = tuple[np.ndarray, np.ndarray, np.ndarray]  # stiffness (C,), directions of either body (C, 3)


def _solve_layers(
    layers: list[np.ndarray], springs: list[Spring], first: np.ndarray, second: np.ndarray, weight: np.ndarray
) -> np.ndarray:
    """(N, 3) of K u = weight, by elimination from the top layer down and substitution up again."""
    own, up = _assemble(layers, springs, first, second)
    loads = [weight[layer].ravel() for layer in layers]
    for low in range(len(layers) - 2, -1, -1):
        lean = np.linalg.solve(own[low + 1], np.column_stack([up[low].T, loads[low + 1]]))
        own[low] -= up[low] @ lean[:, :-1]
        loads[low] -= up[low] @ lean[:, -1]
    moved = np.empty_like(weight)
    below = np.zeros(0)
    for number, layer in enumerate(layers):
        load = loads[number] - up[number - 1].T @ below if number else loads[number]
        below = np.linalg.solve(own[number], load)
        moved[layer] = below.reshape(-1, 3)
    return moved


def _assemble(
    layers: list[np.ndarray], springs: list[Spring], first: np.ndarray, second: np.ndarray
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """K by layers: the blocks of each with itself, and of each with the one above it."""
    count = 1 + max(int(layer.max()) for layer in layers)
    layer_of, place = np.empty(count, int), np.empty(count, int)
    for number, layer in enumerate(layers):
        layer_of[layer], place[layer] = number, np.arange(len(layer))
    sizes = [len(layer) for layer in layers]
    own = [np.zeros((size, 3, size, 3)) for size in sizes]
    up = [np.zeros((low, 3, high, 3)) for low, high in pairwise(sizes)]
    for stiffness, d1, d2 in springs:
        sides = ((-1.0, first, d1), (1.0, second, d2))
        for sign_a, a, da in sides:
            for sign_b, b, db in sides:
                blocks = (sign_a * sign_b * stiffness)[:, None, None] * da[:, :, None] * db[:, None, :]
                moving = (a != GROUND) & (b != GROUND)
                for tables, above in ((own, 0), (up, 1)):
                    for number, table in enumerate(tables):
                        k = np.flatnonzero(moving & (layer_of[a] == number) & (layer_of[b] == number + above))
                        np.add.at(table.transpose(0, 2, 1, 3), (place[a[k]], place[b[k]]), blocks[k])
    square = [table.reshape(3 * size, 3 * size) for table, size in zip(own, sizes, strict=True)]
    held = HELD * max(float(stiffness.max()) for stiffness, _, _ in springs)
    for block in square:
        block[np.diag_indices_from(block)] += held
    return square, [table.reshape(3 * table.shape[0], -1) for table in up]
