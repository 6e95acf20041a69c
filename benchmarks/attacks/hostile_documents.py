"""YAML, conditions and databases that ask for work out of proportion, each of at most 20 MB."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path

from hostile_recordings import MOST_BYTES, Make, file_of, repeated

STEP = "{step: threshold, in: frame, with: {level_v: 1}}"
PIPELINE = f"pipeline: p\nnodes:\n  a: {STEP}\n"
END = "outputs: [a]\n"
GAINS = "  a: {{step: gain, in: frame, with: {{elements: {}}}}}\n"


def documents() -> Iterator[tuple[str, Callable[[], str]]]:
    """Yield YAML that no loader should work on, whatever kind of file it is taken for."""
    values: dict[str, Callable[[], str]] = {
        "a flat list of 1 MB": lambda: "[" + repeated("1,", 990_000) + "1]",
        "a flat list of 20 MB": lambda: "[" + repeated("1,") + "1]",
        "a flat block list": lambda: "\n" + repeated("  - 1\n", 900_000),
        "a flat list of texts": lambda: "[" + repeated("ab,", 990_000) + "x]",
        "a wide mapping": lambda: "{" + ",".join(f"k{i}: 1" for i in range(80_000)) + "}",
        "a deep list": lambda: "[" * 400_000,
        "a deep list, closed": lambda: "[" * 30 + "]" * 30,
        "deep, by blocks": lambda: "\n" + "".join(f"{' ' * i}a:\n" for i in range(1_300)),
        "deep, by dashes": lambda: "\n  " + "- " * 400_000 + "x",
        "base 60": lambda: ":".join(["1"] + ["59"] * 300_000),
        "base 60 in parts": lambda: ":".join(["1"] + ["59"] * 5_000),
        "base 60, a fraction": lambda: ":".join(["1"] + ["59"] * 300_000) + ".5",
        "a million digits": lambda: "9" * 900_000,
        "4,000 digits": lambda: "[" + ",".join(["9" * 4_000] * 200) + "]",
        "hexadecimal digits": lambda: "0x" + "f" * 900_000,
        "binary digits": lambda: "0b" + "1" * 900_000,
        "octal digits": lambda: "0" + "7" * 900_000,
        "a fraction of a million digits": lambda: "1." + "9" * 900_000 + "e-999999999",
        "digits and underlines": lambda: "1" + "_" * 900_000,
        "dots": lambda: "." * 900_000,
        "a time stamp": lambda: "2024-01-01T00:00:00." + "1" * 900_000,
        "no date": lambda: "2024-99-99",
        "an alias bomb": lambda: "\n" + "".join(
            f"  {chr(98 + i)}: &{chr(98 + i)} [{','.join([f'*{chr(97 + i)}'] * 9)}]\n"
            if i else "  b: &b [1,2]\n" for i in range(12)),
        "many aliases": lambda: "[&a [1]," + "*a," * 200_000 + "1]",
        "an alias of itself": lambda: "&a [*a]",
        "many anchors": lambda: "[" + ",".join(f"&a{i} 1" for i in range(80_000)) + "]",
        "merge keys": lambda: "{<<: &a {b: 1}, <<: *a}",
        "a tag of Python": lambda: "!!python/object/apply:os.system ['touch /tmp/attacked']",
        "a tag": lambda: "!" + "x" * 900_000 + " 1",
        "a tag, binary": lambda: "!!binary " + "A" * 900_000,
        "a set": lambda: "!!set {" + ",".join(f"k{i}" for i in range(50_000)) + "}",
        "an ordered map": lambda: "!!omap ["
        + ",".join(f"{{k{i}: 1}}" for i in range(30_000))
        + "]",
        "a number by force": lambda: "!!int x",
        "a long key": lambda: "{" + "k" * 900_000 + ": 1}",
        "a key of a list": lambda: "{[1, 2]: 3, {a: 1}: 2}",
        "a question mark": lambda: "? " * 200_000,
        "quotes": lambda: '"' + "\\x41" * 240_000 + '"',
        "quotes without an end": lambda: '"' + "x" * 900_000,
        "a block text": lambda: "|\n" + "   x\n" * 190_000,
        "a folded text": lambda: ">\n" + "   x\n\n" * 150_000,
        "comments": lambda: "1 " + "# x\n" * 240_000,
        "blanks": lambda: " " * 990_000,
        "blank lines": lambda: "1\n" + "\n" * 990_000,
        "commas": lambda: "[" + "," * 990_000,
        "colons": lambda: ":" * 900_000,
        "spaced colons": lambda: ": " * 400_000,
        "tabs": lambda: "\t" * 900_000,
        "documents": lambda: "1\n" + "---\n" * 240_000,
        "directives": lambda: "1\n...\n" + "%YAML 1.1\n" * 90_000,
        "letters of four bytes": lambda: "\U0001f4a3" * 900_000,
        "a mark that turns text": lambda: "\u202e" * 300_000,
        "carriage returns": lambda: "x\r" * 450_000,
        "a null": lambda: "x\0",
    }  # fmt: skip
    for what, value in values.items():
        yield f"{what}, as a value", lambda v=value: f"about: {v()}\n"
        yield f"{what}, alone", value
        yield (
            f"{what}, in a node",
            lambda v=value: PIPELINE.replace("level_v: 1", "level_v: " + v()) + END,
        )


def pipelines() -> Iterator[tuple[str, Callable[[], str]]]:
    """Yield pipelines of which there is too much."""
    head = "pipeline: p\nnodes:\n"
    known = "  n{i}: {{step: threshold, in: frame, with: {{level_v: {i}}}}}\n"
    found: dict[str, Callable[[], str]] = {
        "3,000 unknown steps": lambda: head + "".join(
            f"  n{i}: {{step: nope{i}, in: frame}}\n" for i in range(3_000)) + "outputs: [n0]\n",
        "3,000 unknown keys": lambda: PIPELINE + "".join(f"k{i}: 1\n" for i in range(3_000)) + END,
        "3,000 unknown settings": lambda: PIPELINE.replace("level_v: 1", ",".join(
            f"k{i}: 1" for i in range(3_000))) + END,
        "3,000 unknown outputs": lambda: PIPELINE + "outputs: [" + ",".join(
            f"x{i}" for i in range(3_000)) + "]\n",
        "3,000 unknown inputs": lambda: head + "".join(
            f"  n{i}: {{step: threshold, in: m{i}}}\n" for i in range(3_000)) + "outputs: [n0]\n",
        "3,000 bad names": lambda: head + "".join(
            f"  n-{i}: {{step: threshold, in: frame}}\n" for i in range(3_000)) + END,
        "3,000 conditions": lambda: "pipeline: p\nconditions:\n" + "".join(
            f"  c{i}: c{i + 1} and c{i + 1}\n" for i in range(3_000)) + PIPELINE[12:] + END,
        "3,000 nodes": lambda: head + "".join(
            known.format(i=i) for i in range(3_000)) + "outputs: [n0]\n",
        "3,000 nodes in a chain": lambda: head + "  n0: {step: low_pass, in: frame}\n" + "".join(
            f"  n{i}: {{step: low_pass, in: n{i - 1}}}\n" for i in range(1, 3_000))
            + "outputs: [n2999]\n",
        "3,000 nodes in a circle": lambda: head + "".join(
            f"  n{i}: {{step: low_pass, in: n{(i + 1) % 3_000}}}\n" for i in range(3_000))
            + "outputs: [n0]\n",
        "3,000 nodes, a list of all": lambda: head + "".join(
            known.format(i=i) for i in range(3_000)) + "  z: {first_of: [" + ",".join(
            f"n{i}" for i in range(3_000)) + "]}\noutputs: [z]\n",
        "3,000 choices of choices": lambda: head + "  n0: {step: low_pass, in: frame}\n" + "".join(
            f"  n{i}: {{first_of: [n{i - 1}, n{max(0, i - 2)}]}}\n" for i in range(1, 3_000))
            + "outputs: [n2999]\n",
        "300 guards in a chain": lambda: head + f"  n0: {STEP}\n" + "".join(
            f"  n{i}: {STEP[:-1]}, when: n{i - 1}.count > 0}}\n"
            for i in range(1, 300)) + "outputs: [n299]\n",
        "1,000 uses of a pipeline": lambda: head + "".join(
            f"  n{i}: {{use: circle-3, in: frame}}\n" for i in range(1_000)) + "outputs: [n0]\n",
        "1,000 uses with settings": lambda: head + "".join(
            f"  n{i}: {{use: circle-3, in: frame, with: {{footprint.level_v: 0.0{i + 1}}}}}\n"
            for i in range(1_000)) + "outputs: [n0]\n",
        "gains of /dev/zero": lambda: head + GAINS.format("/dev/zero") + END,
        "gains of a terminal": lambda: head + GAINS.format("/dev/tty") + END,
        "a use of /dev/zero": lambda: head + "  a: {use: /dev/zero.yaml, in: frame}\n" + END,
        "a use of a device": lambda: head + "  a: {use: /dev/zero, in: frame}\n" + END,
        "a use of a long name": lambda: head + f"  a: {{use: {'x' * 900_000}, in: frame}}\n"
        + END,
        "a step of a long name": lambda: head + f"  a: {{step: {'x' * 900_000}, in: frame}}\n"
        + END,
        "a step of a long import": lambda: head + f"  a: {{step: {'os.' * 300_000}x, in: frame}}\n"
        + END,
        "a step of the system": lambda: head + "  a: {step: 'os:system', in: frame}\n" + END,
        "an input of many dots": lambda: head
        + f"  a: {{step: threshold, in: frame{'.a' * 400_000}}}\n" + END,
        "a scene in the source": lambda: "source: {step: simulate, with: {scene: {objects: ["
        + "{shape: disc, weight_g: 1, radius_cm: 1}," * 4_000 + "]}}}\n" + PIPELINE + END,
        "a pad of a million cells": lambda: "source: {step: simulate, with: {scene: discs, pad: "
        "{geometry: {rows: 100000, columns: 100000}}}}\n" + PIPELINE + END,
        "an element of 10^9": lambda: head + f"  m: {STEP}\n" + "  a: {step: erode, "
        "in: m, with: {element: 999999999}}\n" + END,
        "a subdivision by 10^9": lambda: head + f"  m: {STEP}\n" + "  a: {step: "
        "subdivide, in: m, with: {factor: 999999999}}\n" + END,
    }  # fmt: skip
    yield from found.items()


def conditions() -> Iterator[tuple[str, str]]:
    """Yield what may stand behind ``when`` of a node that is at hand as ``f``."""
    yield from {
        "a list repeated": "len([f.count]*500000000) > 3",
        "a tuple repeated": "len((1,)*f.count) > 3",
        "a text repeated": "'x'*1000000000 == 'y'",
        "a text formatted": "'%1000000000d' % f.count == 1",
        "a chosen text repeated": "min('x', 'y') * 1000000000 == 'x'",
        "a chosen text formatted": "min('%1000000000d', 'a') % 1 == 'a' and f.count > 0",
        "a chosen list repeated": "f.count in max([1], [2]) * 500000000",
        "a power": "f.count ** 9999999 > 1",
        "a shift": "1 << f.count > 1",
        "products": "*".join(["99999999999999999999"] * 80) + " > f.count",
        "products of a field": "*".join(["f.count"] * 240) + " > 1",
        "digits": "9" * 1_900 + " > f.count",
        "many digits": "9" * 100_000 + " > f.count",
        "parentheses": "(" * 900 + "f.count" + ")" * 900,
        "nots": "not " * 450 + "f.count",
        "minuses": "-" * 1_900 + "f.count > 1",
        "ands": " and ".join(["f.count > 0"] * 130),
        "comparisons": " < ".join(["f.count"] * 200),
        "a list": f"f.count in [{'1,' * 900}]",
        "lists of lists": "f.count in " + "[" * 900 + "]" * 900,
        "a lambda": "(lambda: 1)()",
        "an attribute": "f.__class__.__mro__[1] == 1",
        "an import": "__import__('os').system('id') == 1",
        "a comprehension": "[x for x in range(10**9)] == 1",
        "an f-string": "f'{f.count:>1000000000}' == 1",
        "a call": "max(*[1]*1000000000) > f.count",
        "sums": "sum([f.count]*100000000) > 1",
        "a division": "1 // (f.count - f.count) > 1",
        "a modulo": "1e308 * 1e308 % f.count > 1",
        "blanks": "f.count" + " " * 100_000 + "> 1",
        "a null": "f.count > 1\0",
        "a walrus": "(x := 9) > 1",
    }.items()


def databases() -> Iterator[tuple[str, Make]]:
    """Yield databases of objects whose tables have no end, and exports."""

    def made(*changes: str) -> Make:
        def make(folder: Path) -> Path:
            from databases import written

            path = folder / "a.sqlite"
            written(path)
            connection = sqlite3.connect(path)
            connection.execute("PRAGMA writable_schema = ON")
            connection.execute("PRAGMA foreign_keys = OFF")
            for change in changes:
                connection.execute(change)
            connection.commit()
            connection.close()
            return path

        return make

    endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT"
    yield (
        "objects without end",
        made(
            "DROP TABLE objects",
            f"CREATE VIEW objects AS {endless} i AS id, 'x' || i AS name, 'disc' AS shape, "
            "8 AS n_readings, '' AS learned_at FROM n",
        ),
    )
    yield (
        "readings without end",
        made(
            "DROP TABLE readings",
            f"CREATE VIEW readings AS {endless} i AS id, 1 AS object_id, 'x' AS source, i AS place "
            "FROM n",
        ),
    )
    yield (
        "features without end",
        made(
            "DROP TABLE features",
            f"CREATE VIEW features AS {endless} i AS id, 'f' || i AS name, i AS place FROM n",
        ),
    )
    yield "a name of 1 GB", made("UPDATE objects SET name = zeroblob(900000000)")
    yield "a name of 300 MB", made("UPDATE objects SET shape = hex(zeroblob(9000000))")
    yield (
        "an index that runs",
        made("CREATE TRIGGER t AFTER INSERT ON objects BEGIN DELETE FROM readings; END"),
    )
    yield "garbage", file_of("a.sqlite", lambda: b"SQLite format 3\0" + b"x" * 19_000_000)
    yield "zeros", file_of("a.sqlite", lambda: bytes(MOST_BYTES))
    for what, text in documents():
        yield f"export: {what}", file_of("a.yaml", lambda t=text: t().encode("utf-8", "replace"))
