"""How the page looks: on a wide screen, on a phone, by night, and on paper."""

from __future__ import annotations

from tactile_graph.draw.colours import BEFORE, FOUND, TRUE
from tactile_graph_compare.report.badges import DARK, LIGHT


def _paints(paints: tuple[str, ...]) -> str:
    return "".join(f"--v{i}:{p};" for i, p in enumerate(paints, 1))


_COLOURS = f"""
:root {{ color-scheme: light dark;
  --page:#fff; --card:#f5f7fa; --ink:#16202e; --soft:#566377; --line:#d5dce5; --grid:#e6ebf1;
  --link:#0b5cad; --on:#fff; --good:#00674c; --bad:#a83200; --warn:#fff3d9; --tint:#fff6ea;
  --ran:#3f7fbf; --skipped:#e3c27a; --failed:#b3261e; --idle:#e4e8ee; {_paints(LIGHT)} }}
@media (prefers-color-scheme: dark) {{ :root {{
  --page:#11161d; --card:#1b222c; --ink:#e8edf4; --soft:#a3b0c2; --line:#364152; --grid:#28313d;
  --link:#7cb8f5; --on:#0f141b; --good:#57d3a8; --bad:#ff9a7a; --warn:#40331a; --tint:#2c261c;
  --ran:#5aa3e8; --skipped:#8a6f2d; --failed:#ff6b5e; --idle:#2a323d; {_paints(DARK)} }} }}
""" + "".join(f".v{i}{{--c:var(--v{i})}}" for i in range(1, len(LIGHT) + 1))

_TEXT = """
* { box-sizing: border-box }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif }
header, main { max-width: 1320px; margin: 0 auto; padding: 0 20px }
header { padding-top: 22px }
h1 { font-size: 1.7rem; margin: 0 0 2px; letter-spacing: -.01em }
h2 { font-size: 1.3rem; margin: 0 0 12px }
h3 { font-size: 1.02rem; margin: 18px 0 8px }
header p { margin: 0 0 10px; color: var(--soft) }
section { border-top: 1px solid var(--line); padding: 22px 0 26px; scroll-margin-top: 8px }
a { color: var(--link) }
nav ul { display: flex; flex-wrap: wrap; gap: 4px 16px; padding: 0; margin: 0 0 14px;
  list-style: none; font-size: .92rem }
.note, figcaption { color: var(--soft); font-size: .88rem; max-width: 78ch; margin: 8px 0 }
.warning { background: var(--warn); border-left: 4px solid var(--failed); padding: 8px 12px;
  margin: 0 0 12px }
.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; list-style: none; padding: 0;
  margin: 0 0 14px; font-size: .92rem }
.variant { overflow-wrap: anywhere; display: inline-block }
.chip { display: inline-block; min-width: 1.45em; padding: 0 .35em; border-radius: .75em;
  background: var(--c); color: var(--on); font-size: .78em; font-weight: 700; text-align: center;
  line-height: 1.5; vertical-align: .05em; margin-right: .12em;
  print-color-adjust: exact; -webkit-print-color-adjust: exact }
code, pre { font-family: ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace;
  font-size: .86rem }
pre { white-space: pre-wrap; overflow-wrap: anywhere; background: var(--card); padding: 12px;
  border-radius: 8px; margin: 8px 0 }
.unseen { position: absolute; clip-path: inset(50%); width: 1px; height: 1px; overflow: hidden }
.album { position: absolute }
.good { color: var(--good); font-weight: 600 }
.bad { color: var(--bad); font-weight: 600 }
del { color: var(--soft) } ins { text-decoration: none; font-weight: 600 }
"""

_BLOCKS = """
.cards { display: grid; gap: 14px;
  grid-template-columns: repeat(auto-fit, minmax(min(250px, 100%), 1fr)) }
.card { background: var(--card); max-width: 560px; border: 1px solid var(--line);
  border-radius: 10px; padding: 12px 16px; break-inside: avoid }
.card h3 { margin: 0; font-size: .9rem; font-weight: 600; color: var(--soft) }
.card p { margin: 3px 0; font-size: .9rem; color: var(--soft) }
.card .figure { font-size: 1.75rem; line-height: 1.2; font-weight: 700; color: var(--ink);
  font-variant-numeric: tabular-nums }
.card .variant { color: var(--ink) }
.plain { list-style: none; margin: 6px 0 0; padding: 0; font-size: .9rem }
.scroll { overflow-x: auto; max-width: 100% }
.scroll:focus-visible { outline: 2px solid var(--link); outline-offset: 2px }
figure { margin: 0 0 10px; break-inside: avoid }
.graph svg { max-width: max(100%, var(--least)) !important }
.plots { display: flex; flex-wrap: wrap; gap: 14px 26px; align-items: flex-start }
svg.plot { max-width: 100%; height: auto; display: block }
.scroll > svg.plot { max-width: none }
details { border: 1px solid var(--line); border-radius: 8px; margin: 8px 0; padding: 0 12px }
summary { cursor: pointer; padding: 8px 0; overflow-wrap: anywhere }
details[open] { padding-bottom: 10px }
.evolution { margin-bottom: 26px }
.beside { display: flex; flex-wrap: wrap; gap: 6px 40px; align-items: flex-start }
.beside > * { max-width: 100%; min-width: 0 }
.step { display: grid; gap: 4px 30px;
  grid-template-columns: repeat(auto-fit, minmax(min(360px, 100%), 1fr)) }
.did { display: grid; grid-template-columns: max-content 1fr; gap: 2px 12px; margin: 0 }
.did dt { color: var(--soft) } .did dd { margin: 0; overflow-wrap: anywhere }
.did dd > span { display: block; font-size: .92rem }
.effect { margin: 0; padding-left: 1.1em }
"""

_TABLES = """
table { border-collapse: collapse; font-variant-numeric: tabular-nums }
caption { text-align: left; padding: 6px 0 }
table.data { font-size: .9rem; margin-top: 4px }
.data th, .data td { padding: 4px 10px; text-align: right; vertical-align: baseline;
  white-space: nowrap }
.data .words, .data.words td { text-align: left }
.data.words td { white-space: normal; overflow-wrap: anywhere }
.data thead th { border-bottom: 2px solid var(--line); color: var(--soft); font-weight: 600 }
.data tbody { border-bottom: 1px solid var(--line) }
.data tbody th { font-weight: 500 } .data th[scope=rowgroup] { font-weight: 700;
  vertical-align: top }
.data abbr { text-decoration: none; color: var(--good) }
.strip { font-size: .84rem }
.strip th, .strip td { padding: 4px 5px; vertical-align: top; text-align: left }
.strip thead th { vertical-align: bottom; color: var(--soft); font-weight: 600 }
.strip tbody tr { border-top: 1px solid var(--line) }
.strip th[scope=row] { font-weight: 500; min-width: 118px; max-width: 170px; position: sticky;
  left: 0; z-index: 1; background: var(--page); overflow-wrap: anywhere }
.strip tr.worst th, .strip tr.worst td { background: var(--tint) }
.strip small { display: block; color: var(--soft); font-size: .76rem; line-height: 1.35;
  max-width: 130px; overflow-wrap: anywhere }
.badge { display: block; width: max-content; max-width: 100%; color: var(--bad);
  font-size: .76rem; font-weight: 700 }
td.none { color: var(--soft); min-width: 60px; text-align: center !important }
td.none.skipped, td.none.failed { background: none }
td.failed b { color: var(--failed) }
.bare { max-width: 120px }
.scale { display: flex; gap: 4px; align-items: center; font-size: .7rem; font-weight: 400;
  white-space: nowrap }
.bar { flex: 1; min-width: 18px; height: 7px; border-radius: 2px;
  print-color-adjust: exact; -webkit-print-color-adjust: exact }
"""

_DRAWINGS = """
svg.plot text { font-family: inherit } svg.plot .label { fill: var(--ink) }
.tick { font-size: 11px; fill: var(--soft) } .label { font-size: 12px }
.mid { text-anchor: middle } .end { text-anchor: end } .tick.name { fill: var(--ink) }
.grid { stroke: var(--grid); fill: none } .axis { stroke: var(--soft); fill: none }
.zero { stroke: var(--soft); stroke-dasharray: 4 3; fill: none }
.halo { paint-order: stroke }
svg.plot .halo { stroke: var(--page); stroke-width: 3px; stroke-linejoin: round }
.front { fill: none; stroke: var(--soft); stroke-width: 1.6; stroke-dasharray: 5 3 }
.beaten { fill: var(--soft); opacity: .07 }
.whisker { stroke: var(--c); stroke-width: 1.2; opacity: .55; fill: none }
.half { stroke: var(--c); stroke-width: 5; fill: none }
.median { fill: var(--page); stroke: var(--c); stroke-width: 2.4 }
.area { fill: var(--c); opacity: .32 }
.spot { fill: var(--c); stroke: var(--page); stroke-width: 1.5 }
svg.plot .num { font-size: 11px; font-weight: 700; fill: var(--on) }
.off .spot { fill: var(--page); stroke: var(--c); stroke-width: 2 }
svg.plot .off .num { fill: var(--c) }
.ran { fill: var(--ran); background: var(--ran) }
.skipped { fill: var(--skipped) } .failed { fill: var(--failed) } .idle { fill: var(--idle) }
.swatch { display: inline-block; border: 1px solid var(--line);
  width: 14px; height: 12px; border-radius: 2px }
.swatch.skipped { background: var(--skipped) } .swatch.failed { background: var(--failed) }
.swatch.idle { background: var(--idle) } .swatch.less { background: #0550a0 }
.swatch.more { background: #a53c00 }
.swatch, svg.plot, .stroke { print-color-adjust: exact; -webkit-print-color-adjust: exact }
.pin { fill: var(--ink) } .pinned { font-size: .8em }
.pic { display: block; background: #fff; border: 1px solid var(--line); overflow: hidden;
  max-width: none }
image { image-rendering: pixelated }
.ink, .rim { fill: none; vector-effect: non-scaling-stroke;
  stroke-linecap: round; stroke-linejoin: round }
.ink { stroke: var(--stroke); stroke-width: 1.6px; stroke-dasharray: var(--dash) }
.rim { stroke: #fff; stroke-width: 3.2px; opacity: .85 }
.area { fill: var(--stroke); opacity: .3 }
.word { font-size: 22px; text-anchor: middle; dominant-baseline: central }
.ink.word { fill: var(--stroke); stroke: none }
.ink.dots { stroke-width: 3.6px; stroke-dasharray: none } .rim.dots { stroke-width: 5px }
.stroke { display: inline-block; width: 26px; border-top: 3px solid var(--stroke);
  vertical-align: middle }
.stroke.true { border-top-style: dashed }
"""

_ROLES = f"""
.found {{ --stroke: {FOUND}; --dash: none }} .true {{ --stroke: {TRUE}; --dash: 7 4 }}
.before {{ --stroke: {BEFORE}; --dash: none }}
"""

_OTHERWISE = """
@media (max-width: 640px) {
  header, main { padding-left: 12px; padding-right: 12px }
  .strip th[scope=row] { min-width: 92px; max-width: 104px }
  .data th, .data td { padding: 4px 7px }
}
@media print {
  @page { margin: 12mm }
  :root { color-scheme: light }
  html { font-size: 11px } body { font-size: 1rem } header, main { max-width: none; padding: 0 }
  nav { display: none } section { padding: 12px 0 } h2, h3 { break-after: avoid }
  .scroll { overflow: visible } .graph svg, .scroll > svg.plot { max-width: 100% !important;
    height: auto !important }
  .graph svg { max-height: 240mm }
  details::details-content { content-visibility: visible !important; block-size: auto !important }
  details { border: 0; padding: 0 } #making details::details-content { display: none }
  #making details { display: none }
  tr, .card, figure, .strip, pre { break-inside: avoid } summary, .note { break-after: avoid }
  .beside, .step { display: block } #graph details { display: none }
  .plots > svg.plot { width: 48%; flex: none } .plots { gap: 10px 3% }
  .data th, .data td { padding: 2px 5px; white-space: normal }
  .strip th, .strip td { padding: 2px } .strip th[scope=row] { position: static; min-width: 0 }
  .strip svg.pic { width: min(25mm, calc(148mm / var(--n))); height: auto }
  .strip thead th { max-width: 25mm; overflow-wrap: anywhere } .scale { flex-wrap: wrap }
}
"""

STYLE = "\n" + "".join((_COLOURS, _TEXT, _BLOCKS, _TABLES, _DRAWINGS, _ROLES, _OTHERWISE))
