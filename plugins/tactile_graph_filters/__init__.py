"""The filters family: from an image to the footprint, and from counts to grams."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "align_contacts": "align_contacts:AlignContacts",
    "and_compare": "and_compare:and_compare",
    "close": "close:Close",
    "contacts": "contacts:contacts",
    "crop": "crop:crop",
    "decouple": "decouple:Decouple",
    "dilate": "dilate:Dilate",
    "erode": "erode:Erode",
    "find_bad": "find_bad:FindBad",
    "force": "force:Force",
    "gain": "gain:Gain",
    "hit_or_miss": "hit_or_miss:HitOrMiss",
    "inpaint": "inpaint:inpaint",
    "lean_contacts": "lean_contacts:lean_contacts",
    "load": "load:LoadOf",
    "low_pass": "low_pass:LowPass",
    "mask": "mask:mask",
    "open": "open:Open",
    "sharpen_contacts": "sharpen_contacts:sharpen_contacts",
    "skeleton": "skeleton:skeleton",
    "split_contacts": "split_contacts:SplitContacts",
    "split_watershed": "split_watershed:split_watershed",
    "subdivide": "subdivide:subdivide",
    "subdivide_image": "subdivide_image:subdivide_image",
    "tare": "tare:Tare",
    "threshold": "threshold:Threshold",
    "threshold_otsu": "threshold_otsu:threshold_otsu",
    "threshold_valley": "threshold_valley:threshold_valley",
    "threshold_variable": "threshold_variable:threshold_variable",
    "valid_share": "valid_share:valid_share",
    "volts": "volts:Volts",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the filters."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
