"""Circuits that read a pad: what a frame of conductances measures as, and back, exactly."""

from tactile_graph_pads.circuits.divider import Divider
from tactile_graph_pads.circuits.feedback import Feedback
from tactile_graph_pads.circuits.floating import Floating
from tactile_graph_pads.circuits.inverse import Inverse

Circuit = Divider | Floating | Feedback

__all__ = ["Circuit", "Divider", "Feedback", "Floating", "Inverse"]
