"""The page that says how good a learned pad is: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import io
from pathlib import Path

from tactile_graph.files import write_whole
from tactile_graph.foreign_text import html_text
from tactile_graph_pads.learning.learn import LearnedPad
from tactile_graph_pads.learning.pad_file import Making
from tactile_graph_pads.learning.pictures import Picture, pictures
from tactile_graph_pads.learning.summary import summary

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
"""What the page may load: nothing. A browser holds it to that."""
STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #16202e; background: #fff; margin: 0 auto;
  max-width: 1000px; padding: 16px 20px 40px }
h1 { font-size: 1.6rem; margin: 0 0 4px } h2 { font-size: 1.2rem; margin: 28px 0 8px }
table { border-collapse: collapse } th { text-align: left; padding: 3px 18px 3px 0;
  vertical-align: top; white-space: nowrap } td { padding: 3px 0 }
figure { margin: 0 } img { max-width: 100%; height: auto }
figcaption, footer { color: #566377; font-size: .9rem }
pre { background: #f5f7fa; padding: 10px 12px; overflow-x: auto; font-size: .85rem }
li { margin: 2px 0 }
"""


def write_page(path: Path, found: LearnedPad, making: Making, pad: str) -> None:
    """Write the page, whole or not at all.

    Parameters
    ----------
    path : Path
    found : LearnedPad
    making : Making
    pad : str
        The pad file's name, for the nodes of a pipeline.
    """
    write_whole(path, page(found, making, pad))


def page(found: LearnedPad, making: Making, pad: str) -> str:
    """Return the page as HTML."""
    rows = "".join(
        f"<tr><th scope=row>{html_text(name)}</th><td>{html_text(text)}</td></tr>"
        for name, text in summary(found)
    )
    notes = "".join(f"<li>{html_text(note)}</li>" for note in found.notes)
    body = [
        "<header><h1>A pad learned from recordings</h1></header><main>",
        f"<table>{rows}</table>",
        f"<h2>What could not be told, and what to mind</h2><ul>{notes}</ul>" if notes else "",
        *(_figure(picture) for picture in pictures(found)),
        f"<h2>In a pipeline</h2><pre>{html_text(nodes(found, pad))}</pre>",
        f"</main><footer><p>{html_text(making.made_by)}, {html_text(making.made_at)}: "
        f"{len(making.recordings)} recordings.</p><pre>{html_text(making.command)}</pre></footer>",
    ]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
        f"<title>A pad learned from recordings</title><style>{STYLE}</style></head><body>"
        + "".join(body)
        + "</body></html>\n"
    )


def nodes(found: LearnedPad, pad: str) -> str:
    """Return the nodes of a pipeline that put what was learned to use.

    Parameters
    ----------
    found : LearnedPad
    pad : str
        The pad file's name.
    """
    lines = [
        f"readings: {{step: correct_readings, in: frame, with: {{pad: {pad}}}}}",
    ]
    read = "readings"
    if not found.elements.good.all():
        lines.append("filled: {step: inpaint, in: readings}")
        read = "filled"
    lines += [
        f"touched: {{step: threshold_learned, in: {read}, with: {{pad: {pad}}}}}",
        f"contacts: {{step: contacts, in: [{read}, touched]}}",
    ]
    if found.place is not None and found.place.helps:
        lines.append(
            f"placed: {{step: correct_place, in: [{read}, contacts.contacts], "
            f"with: {{pad: {pad}}}}}"
        )
    if found.curve is not None:
        points = ", ".join(f"[{r:.6g}, {g:.6g}]" for r, g in found.curve.points)
        lines.append(f"grams: {{step: force, in: {read}, with: {{curve: [{points}]}}}}")
    return "nodes:\n" + "\n".join(f"  {line}" for line in lines)


def _figure(picture: Picture) -> str:
    file = io.BytesIO()
    picture.figure.savefig(file, format="png")
    data = base64.b64encode(file.getvalue()).decode()
    return (
        f"<h2>{html_text(picture.title)}</h2><figure>"
        f'<img alt="{html_text(picture.title)}" src="data:image/png;base64,{data}">'
        f"<figcaption>{html_text(picture.caption)}</figcaption></figure>"
    )
