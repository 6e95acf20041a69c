"""Fits of shapes to points."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "ellipse_sweep": "ellipse.ellipse_sweep:ellipse_sweep",
    "fit_circle": "circle.fit_circle:fit_circle",
    "fit_circle_hyper": "circle.fit_circle_hyper:fit_circle_hyper",
    "fit_circle_kasa": "circle.fit_circle_kasa:fit_circle_kasa",
    "fit_circle_load": "circle.fit_circle_load:FitCircleLoad",
    "fit_circle_taubin": "circle.fit_circle_taubin:fit_circle_taubin",
    "fit_circle_thesis": "circle.fit_circle_thesis:fit_circle_thesis",
    "fit_ellipse": "ellipse.fit_ellipse:fit_ellipse",
    "fit_ellipse_direct": "ellipse.fit_ellipse_direct:fit_ellipse_direct",
    "fit_ellipse_origin": "ellipse.fit_ellipse_origin:fit_ellipse_origin",
    "fit_rectangle": "rectangle.fit_rectangle:fit_rectangle",
    "fit_rectangle_load": "rectangle.fit_rectangle_load:FitRectangleLoad",
    "heavier_side": "orientation.heavier_side:heavier_side",
    "min_area_rectangle": "rectangle.min_area_rectangle:min_area_rectangle",
    "orientation": "orientation.orientation:orientation",
    "orientation_robust": "orientation.orientation_robust:orientation_robust",
    "rectangle_from_ellipse": "rectangle.rectangle_from_ellipse:rectangle_from_ellipse",
    "rotate_mask": "orientation.rotate_mask:rotate_mask",
    "rotate_points": "orientation.rotate_points:rotate_points",
    "shape_decision": "shape.shape_decision:shape_decision",
    "simplify_polygon": "shape.simplify_polygon:SimplifyPolygon",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the fits of circles, ellipses, rectangles and polygons, and orientation."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
