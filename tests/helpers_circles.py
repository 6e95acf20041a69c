"""Shared by the circle fits' tests: the fits, arcs with known truth, equivariant maps."""

from __future__ import annotations

import numpy as np

from tactile_graph.wires import Circle, Points
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_hyper import fit_circle_hyper
from tactile_graph_fitters.circle.fit_circle_kasa import fit_circle_kasa
from tactile_graph_fitters.circle.fit_circle_taubin import fit_circle_taubin
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis

ALL_FITS = [fit_circle, fit_circle_hyper, fit_circle_kasa, fit_circle_taubin, fit_circle_thesis]
CLOSED_FITS = [fit_circle_hyper, fit_circle_kasa, fit_circle_taubin]


def arc_xy(circle, degrees, n, noise=0.0, rng=None, start_deg=0.0):
    """Points on an arc of ``degrees``, evenly spread, with normal noise in x and y."""
    turns = np.linspace(0.0, 1.0, n, endpoint=degrees < 360)
    angle = np.radians(start_deg + degrees * turns)
    xy = np.column_stack([np.cos(angle), np.sin(angle)]) * circle.radius_cm
    xy += (circle.x_cm, circle.y_cm)
    return xy if rng is None else xy + rng.normal(0.0, noise, xy.shape)


def arc(circle, degrees, n, noise=0.0, rng=None, start_deg=0.0):
    return Points(arc_xy(circle, degrees, n, noise, rng, start_deg))


def three(circle: Circle):
    return np.array([circle.x_cm, circle.y_cm, circle.radius_cm])
