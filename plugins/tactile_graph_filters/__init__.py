"""The filters family: from an image to the footprint, and from counts to grams."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "and_compare": "and_compare:and_compare",
    "close": "close:Close",
    "contacts": "contacts:contacts",
    "crop": "crop:crop",
    "dilate": "dilate:Dilate",
    "erode": "erode:Erode",
    "hit_or_miss": "hit_or_miss:HitOrMiss",
    "load": "load:LoadOf",
    "low_pass": "low_pass:LowPass",
    "open": "open:Open",
    "skeleton": "skeleton:skeleton",
    "subdivide": "subdivide:subdivide",
    "subdivide_image": "subdivide_image:subdivide_image",
    "threshold": "threshold:Threshold",
    "threshold_otsu": "threshold_otsu:threshold_otsu",
    "threshold_valley": "threshold_valley:threshold_valley",
    "threshold_variable": "threshold_variable:threshold_variable",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the filters."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
