"""Exports of instruments and of other people's data sets, as their makers write them."""
