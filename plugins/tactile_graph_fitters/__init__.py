"""Fits of shapes to points."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the fits of circles, ellipses, rectangles and polygons, and orientation."""
    names = (
        "ellipse_sweep",
        "fit_circle",
        "fit_circle_hyper",
        "fit_circle_kasa",
        "fit_circle_taubin",
        "fit_circle_thesis",
        "fit_ellipse",
        "fit_ellipse_direct",
        "fit_ellipse_origin",
        "fit_rectangle",
        "heavier_side",
        "min_area_rectangle",
        "orientation",
        "orientation_robust",
        "rectangle_from_ellipse",
        "rotate_mask",
        "rotate_points",
        "shape_decision",
    )
    return {
        **{name: f"tactile_graph_fitters.{name}:{name}" for name in names},
        "fit_circle_load": "tactile_graph_fitters.fit_circle_load:FitCircleLoad",
        "fit_rectangle_load": "tactile_graph_fitters.fit_rectangle_load:FitRectangleLoad",
        "simplify_polygon": "tactile_graph_fitters.simplify_polygon:SimplifyPolygon",
    }
