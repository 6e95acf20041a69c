"""What the core offers itself, by the hooks that all plugins answer."""

from __future__ import annotations

from collections.abc import Mapping

from tactile_graph.plugins.hookspecs import hookimpl


@hookimpl
def tactile_graph_quantities() -> Mapping[str, str]:
    """Offer what readings of tactile pads are usually given in.

    ``raw`` is a vendor's unit without a stated meaning; ``level`` and ``binary`` are what images
    become when they are told apart in steps.
    """
    return {
        "counts": "",
        "volt": "V",
        "siemens": "S",
        "gram": "g",
        "kilopascal": "kPa",
        "raw": "",
        "level": "",
        "binary": "",
    }


@hookimpl
def tactile_graph_units() -> Mapping[str, str]:
    """Offer the units that fields of the project's own records are in."""
    return {
        "cm2": "cm²", "cm": "cm", "mm": "mm", "deg": "°", "rad": "rad", "g": "g", "n": "N",
        "s": "s", "cm_s": "cm/s", "ms": "ms", "us": "µs", "v": "V", "kpa": "kPa", "ohm": "Ω",
        "hz": "Hz",
    }  # fmt: skip


@hookimpl
def tactile_graph_exporters() -> Mapping[str, str]:
    """Offer what ``run -o`` writes."""
    forms = {
        ".jsonl": "writers:JSON_LINES",
        ".ndjson": "writers:JSON_LINES",
        ".csv": "writers:CSV",
        ".parquet": "parquet:PARQUET",
        ".dataset": "data_set:DATA_SET",
        ".h5": "node_images:HDF5",
        ".hdf5": "node_images:HDF5",
        ".zarr": "node_images:ZARR",
    }
    return {ending: f"tactile_graph.cli.output.{home}" for ending, home in forms.items()}


@hookimpl
def tactile_graph_executors() -> Mapping[str, str]:
    """Offer where ``--workers`` and ``--on`` have frames worked on."""
    return {
        "processes": "tactile_graph.many.processes:PROCESSES",
        "dask": "tactile_graph.many.dask_cluster:DASK",
    }
