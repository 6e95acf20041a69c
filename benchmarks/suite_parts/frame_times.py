"""The time of each frame of a stream, by class: where the time goes and where none does."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from suite_parts.records import Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = ("circle-full, no gates", "adaptive")
MOST_FRAMES = 300


def frame_times(results: Results, path: Path) -> Path:
    """Draw the first frames of the stream, and every class's share of the whole time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 4.4), layout="constrained")
    over, shares = figure.subplots(1, 2, width_ratios=(2.4, 1.0))
    _over_frames(results, over)
    _by_class(results, shares)
    figure.savefig(path, dpi=110)
    return path


def _classes(results: Results) -> dict[str, str]:
    """Return a colour for each class of frames."""
    import matplotlib

    names = list(dict.fromkeys(m.case for m in results.of("stream") if m.at))
    colours = ("0.6", "tab:blue", "tab:orange", "tab:red", "tab:brown", "tab:purple", "tab:green")
    return {n: matplotlib.colors.to_hex(c) for n, c in zip(names, colours, strict=False)}


def _over_frames(results: Results, axis: Axes) -> None:
    for case, colour in _classes(results).items():
        for m in results.of("stream"):
            if m.case != case or m.contestant not in SHOWN:
                continue
            at, taken = np.array(m.at), np.array(m.frames_us)
            early = at < MOST_FRAMES
            own = m.contestant == "adaptive"
            face = colour if own else "none"
            axis.plot(at[early], taken[early], "o" if own else "s", ms=4, mew=0.7, mec=colour,
                      mfc=face, label=case if own else None)  # fmt: skip
    axis.plot([], [], "ks", mfc="none", ms=4, label=SHOWN[0])
    axis.plot([], [], "ko", ms=4, label=SHOWN[1])
    axis.set(yscale="log", xlabel="frame of the stream", ylabel="time, µs a frame",
             title="Each frame, by what it is")  # fmt: skip
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.14))


def _by_class(results: Results, axis: Axes) -> None:
    """Draw the mean time a frame of the stream, parted by class, for each contestant."""
    found = [m for m in results.of("stream") if m.at]
    names = list(dict.fromkeys(m.contestant for m in found))
    n = sum(len(m.at) for m in found if m.contestant == names[0])
    left = np.zeros(len(names))
    for case, colour in _classes(results).items():
        parts = np.array(
            [
                sum(m.frames_us) / n
                for c in names
                for m in found
                if (m.case, m.contestant) == (case, c)
            ]
        )
        axis.barh(names, parts, left=left, color=colour)
        left += parts
    for i, total in enumerate(left):
        axis.text(1.03 * total, i, f"{total:,.0f}", va="center", fontsize=8)
    axis.set(xlabel="mean time, µs a frame of the stream", xlim=(0, 1.25 * left.max()),
             title="The whole stream")  # fmt: skip
    axis.invert_yaxis()
    axis.tick_params(axis="y", labelsize=8)
