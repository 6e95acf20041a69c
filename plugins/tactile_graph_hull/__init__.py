"""Boundaries of masks, gradients of images, and convex hulls of points that all agree."""

from collections.abc import Mapping

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the boundary, gradient and hull steps."""
    names = (
        "boundary_mask",
        "boundary_scan",
        "digital_gradient",
        "hull",
        "hull_beneath_beyond",
        "hull_graham",
        "hull_qhull",
        "mask_points",
        "partial_differences",
        "sobel",
    )
    return {name: f"tactile_graph_hull.{name}:{name}" for name in names}
