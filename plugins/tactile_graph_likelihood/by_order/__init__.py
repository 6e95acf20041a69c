"""Outlines from touch and the order of readings: no law is used."""
