"""Result files as tables for the terminal and as plots, one a family."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table

from suite_parts.frame_times import frame_times
from suite_parts.records import Measured, Results
from suite_parts.verdict import Verdict, references

MAIN_ERROR = {
    "scenes": "centre_cm",
    "stream": "centre_cm",
    "circle fits": "radius_cm",
    "ellipse fits": "semi_major_cm",
    "rectangle fits": "length_cm",
    "hulls": "area_cm2",
}


def print_tables(results: Results, console: Console) -> None:
    """Print one table a family (one a scene): a row a contestant, a column a case."""
    for family in results.families:
        cases = list(dict.fromkeys(m.case for m in results.of(family)))
        grouped: dict[str, list[str]] = {}
        for case in cases:
            scene = case.rpartition(" ")[0] if family == "scenes" else case.rpartition(": ")[0]
            grouped.setdefault(scene, []).append(case)
        for name, members in grouped.items():
            title = f"{family}: {name}" if name else family
            console.print(_table(results, family, members, title))


def _table(results: Results, family: str, cases: list[str], title: str) -> Table:
    found, quantity = results.of(family), MAIN_ERROR.get(family, "centre_cm")
    held = {(m.contestant, m.case): m for m in found}
    base = references(results)
    unit = quantity.rpartition("_")[2].replace("cm2", "cm²")
    peer = next((base[family, c].contestant for c in cases if (family, c) in base), "none")
    table = Table(
        title=f"{title}: µs a call (ratio to {peer})\n"
        f"mean {quantity.rpartition('_')[0]} error, {unit}, –n: no answer n times",
    )
    table.add_column("contestant", no_wrap=True)
    for case in cases:
        column = case.rpartition(" " if family == "scenes" else ": ")[2]
        table.add_column(column, justify="right")
    for name in dict.fromkeys(m.contestant for m in found):
        cells = [_cell(held.get((name, c)), base.get((family, c)), quantity) for c in cases]
        table.add_row(name, *cells)
    return table


def _cell(m: Measured | None, base: Measured | None, quantity: str) -> str:
    if m is None:
        return "too slow"
    if not m.rounds_us:
        return "not for it"
    ratio = f" ({m.median_us / base.median_us:.2f})" if base else ""
    text = f"{m.median_us:,.3g}{ratio}" if m.median_us < 1000 else f"{m.median_us:,.0f}{ratio}"
    if quantity not in m.errors:
        alarms = m.error("false alarms")
        return text + ("" if alarms is None else f"\n{alarms:.1f} false alarms")
    error, missing = m.error(quantity), m.missing(quantity)
    shown = "–" if error is None else f"{error:.3f}"
    return f"{text}\n{shown}" + (f" –{missing}" if missing else "")


def print_verdicts(found: Iterable[Verdict], console: Console, everything: bool) -> None:
    """Print what changed, and how many comparisons showed nothing."""
    found = list(found)
    changed = [v for v in found if v.word in ("faster", "slower", "better", "worse")]
    table = Table(title="What changed, new against old", caption=_summary(found))
    for name in ("case", "contestant", "what", "change", "99.9 % interval", "verdict"):
        table.add_column(name)
    for v in found if everything else changed:
        time = v.what == "time"
        change = f"× {v.ratio:.2f}" if time else f"{v.ratio:+.3g}"
        low, high = (f"{x:.2f}" if time else f"{x:+.3g}" for x in (v.low, v.high))
        where = f"{v.measured.family}, {v.measured.case}"
        table.add_row(where, v.measured.contestant, v.what, change, f"{low} to {high}", v.word)
    console.print(table)


def _summary(found: list[Verdict]) -> str:
    words = [v.word for v in found]
    counts = ", ".join(f"{words.count(w)} {w}" for w in dict.fromkeys(words))
    return f"{len(found)} comparisons: {counts or 'none'}"


def draw(results: Results, folder: Path) -> list[Path]:
    """Draw one plot a family: error against time, a marker a contestant, a panel a case.

    Of a stream also the time of each of its frames.
    """
    folder.mkdir(parents=True, exist_ok=True)
    found = [_scatter(results, family, folder) for family in results.families]
    if any(m.at for m in results.of("stream")):
        found.append(frame_times(results, folder / "stream-frames.png"))
    return found


def _scatter(results: Results, family: str, folder: Path) -> Path:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    found, quantity = results.of(family), MAIN_ERROR.get(family, "centre_cm")
    cases = [
        c
        for c in dict.fromkeys(m.case for m in found)
        if any(m.case == c and m.rounds_us and m.error(quantity) is not None for m in found)
    ]
    names = list(dict.fromkeys(m.contestant for m in found))
    sizes = len({c.rpartition(" ")[2] for c in cases})
    if family == "scenes":  # a row a scene, a column a size
        cases.sort(key=lambda c: c.rpartition(" ")[0])
    columns = sizes if family == "scenes" else min(4, len(cases))
    rows = -(-len(cases) // columns)
    wide = 3.0 if len(cases) > 1 else 5.0
    figure = Figure(figsize=(wide * columns + 2.2, max(2.6 * rows, 3.8)))
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    colours = matplotlib.colormaps["tab20"].colors  # type: ignore[attr-defined]
    for axis, case in zip(axes.flat, cases, strict=False):
        for i, name in enumerate(names):
            for m in found:
                error = m.error(quantity) if (m.case, m.contestant) == (case, name) else None
                if error is not None and m.rounds_us:
                    marker = "os^vDP*X"[i // 3 % 8]
                    axis.plot(m.median_us, max(error, 1e-6), marker, color=colours[i % 20], ms=6)
        axis.set(xscale="log", yscale="log", title=case)
        axis.grid(alpha=0.3)
    for axis in axes.flat[len(cases) :]:
        axis.set_axis_off()
    figure.supxlabel("time, µs a call")
    name, _, unit = quantity.rpartition("_")
    figure.supylabel(f"mean {name} error, {unit.replace('cm2', 'cm²')}")
    handles = [
        axes.flat[0].plot([], [], "os^vDP*X"[i // 3 % 8], color=colours[i % 20], label=n)[0]
        for i, n in enumerate(names)
    ]
    figure.legend(handles=handles, loc="outside right upper", fontsize=8)
    figure.set_layout_engine("constrained")
    path = folder / f"{family.replace(' ', '-')}.png"
    figure.savefig(path, dpi=110)
    return path
