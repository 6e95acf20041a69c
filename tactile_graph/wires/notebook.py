"""How frames, images and masks show themselves in notebooks: HTML that needs nothing but itself."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from tactile_graph.wires.cells_png import HEAT, YES_NO, data_uri, heat_stops, levels

TRUE = "#00838f"
"""The colour of what is true."""
SIDE_PX, LEAST_PX = 300.0, 90.0
_EDGE_PX, _TEXT_PX, _RIGHT_PX = 44.0, 11.0, 26.0
Extent = tuple[float, float, float, float]


# The records import this file, so that it cannot name their types: an image, a mask, a frame.


def image_html(image: Any) -> str:
    """Return an image as a heat map with its axes, range and unit."""
    return _figure(_heat(image), _said(image), _scale(image))


def mask_html(mask: Any) -> str:
    """Return a mask, its cells dark where they are on."""
    uri = data_uri(mask.values.astype(np.uint8), YES_NO)
    share = f"{mask.count} of {mask.values.size} cells on, {mask.area_cm2:.4g} cm²"
    return _figure(_svg(mask.extent_cm, uri), f"{_grid(mask)}: {share}")


def frame_html(frame: Any) -> str:
    """Return a frame's image with its place in time, and what truly lay there drawn over."""
    told = f"frame {frame.index}"
    told += f", {frame.time_s:.6g} s" if frame.time_s is not None else ""
    told += f", {frame.label}" if frame.label else ""
    told += ", after a gap" if frame.gap else ""
    told += ", doubtful" if frame.doubtful else ""
    words = [told, _said(frame.image)]
    if frame.truth is not None:
        n = len(frame.truth)
        lies = f"{n} object{'s' if n != 1 else ''}" if n else "nothing"
        words.append(f"truly there: {lies}" + (" (dashed)" if n else ""))
    return _figure(_heat(frame.image, frame.truth or ()), "; ".join(words), _scale(frame.image))


def _heat(image: Any, truth: Sequence[Any] = ()) -> str:
    low, high = _range(image)
    uri = data_uri(levels(image.values, low, high, image.valid), HEAT)
    return _svg(image.extent_cm, uri, truth)


def _range(image: Any) -> tuple[float, float]:
    """Return the ends of the colours: a pad's values are read from nothing up."""
    known = image.values if image.valid is None else image.values[image.valid]
    known = known[np.isfinite(known)]
    low = min(float(known.min()), 0.0) if known.size else 0.0
    high = float(known.max()) if known.size else 1.0
    return low, high if high > low else low + 1.0


def _said(image: Any) -> str:
    broken = 0 if image.valid is None else int((~image.valid).sum())
    return f"{_grid(image)}, {image.quantity}" + (f", {broken} broken (grey)" if broken else "")


def _grid(grid: Any) -> str:
    pitch = " × ".join(f"{p:g}" for p in dict.fromkeys(grid.pitch_cm))
    return f"{grid.rows} × {grid.columns} cells of {pitch} cm"


def _scale(image: Any) -> str:
    """Return the bar of colours with the values at its ends."""
    low, high = _range(image)
    bar = (
        '<span style="display:inline-block;width:8em;height:.7em;margin:0 .4em;'
        f'background:linear-gradient(90deg,{",".join(heat_stops())})"></span>'
    )
    return f"<div>{low:.4g}{bar}{high:.4g} {escape(image.unit)}</div>"


def _figure(svg: str, words: str, below: str = "") -> str:
    style = "font:12px sans-serif;display:inline-block;max-width:100%"
    return f'<div style="{style}">{svg}{below}<div>{escape(words)}</div></div>'


def _svg(extent_cm: Extent, uri: str, truth: Sequence[Any] = ()) -> str:
    """Return the grid in SVG, centimetres along two edges, outlines of true objects over it."""
    left, right, bottom, top = extent_cm
    wide, high = right - left, bottom - top
    per_cm = SIDE_PX / max(wide, high)
    per_cm = max(per_cm, min(LEAST_PX / min(wide, high), 2.0 * SIDE_PX / max(wide, high)))
    width, height = wide * per_cm, high * per_cm
    paths = []
    for true in truth:
        xy = (np.asarray(true.shape.outline_cm()) - (left, top)) * per_cm
        xy = xy[np.isfinite(xy).all(axis=1)]
        line = "L".join(f"{x:.1f} {y:.1f}" for x, y in xy.tolist())
        for paint in ('stroke="#fff" stroke-width="3.5"',
                      f'stroke="{TRUE}" stroke-width="2" stroke-dasharray="6 4"'):  # fmt: skip
            paths += [f'<path d="M{line}Z" fill="none" {paint}/>'] if line else []
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width + _EDGE_PX + _RIGHT_PX:.0f}" '
        f'height="{height + _EDGE_PX:.0f}" font-size="{_TEXT_PX:g}" fill="currentColor" '
        f'style="overflow:hidden"><g transform="translate({_EDGE_PX:g} 6)">'
        f'<image width="{width:.1f}" height="{height:.1f}" href="{uri}" '
        'preserveAspectRatio="none" style="image-rendering:pixelated"/>'
        f"{''.join(paths)}{_edges(extent_cm, width, height)}</g></svg>"
    )


def _edges(extent_cm: Extent, width: float, height: float) -> str:
    """Return the ends of both axes in cm."""
    left, right, bottom, top = extent_cm
    foot = height + 14.0
    places = (
        (0.0, foot, "middle", f"{left:.4g}"), (width, foot, "middle", f"{right:.4g}"),
        (width / 2, foot, "middle", "x in cm"), (-4.0, 9.0, "end", f"{top:.4g}"),
        (-4.0, height, "end", f"{bottom:.4g}"), (-4.0, height / 2 + 4.0, "end", "y"),
    )  # fmt: skip
    return "".join(
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{text}</text>'
        for x, y, anchor, text in places
    )
