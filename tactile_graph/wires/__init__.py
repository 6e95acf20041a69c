"""What travels on the wires: records with units, no algorithms."""

from tactile_graph.wires.checked import FARTHEST_CM, LARGEST, PITCHES_CM
from tactile_graph.wires.frame import Frame, TrueObject
from tactile_graph.wires.image import Image, Mask, packed_mask, quick_image, quick_mask
from tactile_graph.wires.points import Points, quick_points
from tactile_graph.wires.shapes import Circle, Ellipse, Polygon, Rectangle, Shape, quick_polygon

__all__ = [
    "FARTHEST_CM",
    "LARGEST",
    "PITCHES_CM",
    "Circle",
    "Ellipse",
    "Frame",
    "Image",
    "Mask",
    "Points",
    "Polygon",
    "Rectangle",
    "Shape",
    "TrueObject",
    "packed_mask",
    "quick_image",
    "quick_mask",
    "quick_points",
    "quick_polygon",
]
