"""The parts of ``benchmarks/suite.py``: families of measurements, their file, tables and plots."""
