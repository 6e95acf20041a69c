"""Figures 3.2, 3.5 and 3.6: a boundary scan, noise removal, and a convex hull, on small images."""

from __future__ import annotations

import numpy as np

from tactile_graph import Mask, Points
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_hull.boundary_scan import seen_cells
from tactile_graph_hull.hull import hull
from tactile_graph_thesis.drawing.panels import (
    OTHER,
    draw_mask,
    draw_outline,
    draw_points,
    finish,
    panels,
)
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.work import Work

SIDES = ("left", "right", "top", "bottom")
LONE = 6
"""Noise points of figure 3.5."""


def _disc(size: int, radius: float) -> Mask:
    at = np.arange(size) - 0.5 * (size - 1)
    return Mask(np.hypot(at[:, None], at[None, :]) <= radius, (1.0, 1.0))


# -- figure 3.2 ------------------------------------------------------------------------------


def _figure_3_2(_: Work) -> Made:
    mask = _disc(12, 4.6)
    scans = [(side,) for side in SIDES] + [SIDES]
    seen = [mask.with_values(seen_cells(mask.values, some)) for some in scans]
    figure, axes = panels(3, 2)
    draw_mask(axes[0], mask)
    for one, found in zip(axes[1:], seen, strict=True):
        draw_mask(one, found)
    return Made(
        findings=(outermost(mask, seen[-1]),),
        figure=finish(figure, axes, ["image", *SIDES, "added"], 3),
    )


def outermost(mask: Mask, boundary: Mask) -> Finding:
    """Return whether a boundary is that of the outermost cells of an image.

    Parameters
    ----------
    mask, boundary : Mask
    """
    on = np.pad(mask.values, 1)
    inner = on[:-2, 1:-1] & on[2:, 1:-1] & on[1:-1, :-2] & on[1:-1, 2:]
    rim = mask.values & ~inner
    amiss = int((rim != boundary.values).sum())
    return Finding(
        "the four scans together give the boundary of the outermost points",
        f"{boundary.count} of {mask.count} cells; {amiss} are not those that touch a cell that is "
        "off",
        "a cell of the boundary that no cell which is off touches, or one that is missing",
        amiss == 0,
    )


# -- figure 3.5 ------------------------------------------------------------------------------


def _figure_3_5(work: Work) -> Made:
    clean = _disc(16, 5.0)
    rng = np.random.default_rng(work.seed)
    values = clean.values.copy()
    away = np.argwhere(~Dilate(element="square3")(clean).values)
    values[tuple(away[rng.choice(len(away), LONE, replace=False)].T)] = True
    noisy = clean.with_values(values)
    eroded = Erode(element="cross3")(noisy)
    dilated = Dilate(element="cross3")(eroded)
    figure, axes = panels(3)
    for one, mask in zip(axes, (noisy, eroded, dilated), strict=True):
        draw_mask(one, mask)
    return Made(
        findings=(removes_noise(clean, noisy, eroded, dilated),),
        figure=finish(figure, axes, ["with noise points", "eroded", "then dilated"]),
    )


def removes_noise(clean: Mask, noisy: Mask, eroded: Mask, dilated: Mask) -> Finding:
    """Return whether erosion takes noise and some of the object away, and dilation gives that back.

    Parameters
    ----------
    clean, noisy, eroded, dilated : Mask
        Without noise, with it, and after one and both steps.
    """
    added = noisy.values & ~clean.values
    left = int((dilated.values & ~clean.values).sum())
    lost, still = (int((clean.values & ~m.values).sum()) for m in (eroded, dilated))
    return Finding(
        "erosion removes noise points and some of the object, which dilation complements",
        f"{left} cells left off the object where {int(added.sum())} were; {lost} cells of the "
        f"object lost after erosion, {still} after dilation",
        "a noise point left, no cell of the object lost by erosion, or a fifth of these still lost",
        left == 0 < lost and still < 0.2 * lost,
    )


# -- figure 3.6 ------------------------------------------------------------------------------


def _figure_3_6(work: Work) -> Made:
    points = Points(np.random.default_rng(work.seed).normal(0.0, 1.0, (30, 2)))
    outline = hull(points)
    figure, axes = panels(1, panel_in=4.2)
    draw_points(axes[0], points, "points")
    draw_outline(axes[0], outline, "convex hull", OTHER)
    return Made(
        findings=(encloses(points, outline.xy_cm),), figure=finish(figure, axes, ["convex hull"])
    )


def encloses(points: Points, corners: np.ndarray) -> Finding:
    """Return whether corners in order turn one way and leave no point outside.

    Parameters
    ----------
    points : Points
    corners : ndarray, shape (n, 2)
    """
    sides = np.roll(corners, -1, axis=0) - corners
    turns = _cross(sides, np.roll(sides, -1, axis=0))
    way = np.sign(turns.sum())
    reach = way * np.array([_cross(sides, p - corners) for p in points.xy_cm])
    outside = int((reach.min(axis=1) < -1e-9).sum())
    return Finding(
        "the convex hull is the smallest convex set that holds the points",
        f"{len(corners)} corners, each one of the {points.count} points; {outside} points outside",
        "a point outside, a corner that turns the other way, or one that is no point",
        bool(
            outside == 0
            and (way * turns > 0.0).all()
            and all((np.abs(points.xy_cm - c).max(axis=1) == 0.0).any() for c in corners)
        ),
    )


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


_SMALL = "The thesis' image is lost; ours is a small one of the same kind."
ITEMS = (
    Item(
        "figure-3.2",
        "Boundary by scans",
        "A small image seen from each of four sides, and all together.",
        _figure_3_2,
        _SMALL,
    ),
    Item(
        "figure-3.5",
        "Noise removed by erosion and dilation",
        "A disc with noise points, eroded, then dilated.",
        _figure_3_5,
        _SMALL,
    ),
    Item("figure-3.6", "A convex hull", "Points and their convex hull.", _figure_3_6, _SMALL),
)
