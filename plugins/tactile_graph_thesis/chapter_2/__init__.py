"""The studies of thesis chapter 2, each one a command: what was asked, found and concluded."""

from tactile_graph_thesis.chapter_2.column import coupling_volts, element_volts, random_neighbours
from tactile_graph_thesis.chapter_2.samples import scan_error_v
from tactile_graph_thesis.chapter_2.study import Finding, Study, Table, load_study, study_names

__all__ = [
    "Finding",
    "Study",
    "Table",
    "coupling_volts",
    "element_volts",
    "load_study",
    "random_neighbours",
    "scan_error_v",
    "study_names",
]
