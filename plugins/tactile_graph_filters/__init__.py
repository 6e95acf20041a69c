"""The filters family: from an image to the footprint, and from counts to grams."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "align_contacts": "contacts.align_contacts:AlignContacts",
    "and_compare": "morphology.and_compare:and_compare",
    "bridge_lines": "contacts.bridge_lines:bridge_lines",
    "close": "morphology.close:Close",
    "contacts": "contacts.contacts:contacts",
    "correct_place": "contacts.correct_place:CorrectPlace",
    "correct_readings": "readings.correct_readings:CorrectReadings",
    "crop": "images.crop:crop",
    "decouple": "readings.decouple:Decouple",
    "dilate": "morphology.dilate:Dilate",
    "erode": "morphology.erode:Erode",
    "find_bad": "readings.find_bad:FindBad",
    "force": "readings.force:Force",
    "gain": "readings.gain:Gain",
    "hit_or_miss": "morphology.hit_or_miss:HitOrMiss",
    "inpaint": "readings.inpaint:inpaint",
    "lean_contacts": "contacts.lean_contacts:lean_contacts",
    "load": "readings.load:LoadOf",
    "low_pass": "images.low_pass:LowPass",
    "mask": "readings.mask:mask",
    "open": "morphology.open:Open",
    "sharpen_contacts": "contacts.sharpen_contacts:sharpen_contacts",
    "pick_contact": "contacts.pick_contact:pick_contact",
    "skeleton": "morphology.skeleton:skeleton",
    "split_contacts": "parting.split_contacts:SplitContacts",
    "split_watershed": "parting.split_watershed:split_watershed",
    "subdivide": "morphology.subdivide:subdivide",
    "subdivide_image": "images.subdivide_image:subdivide_image",
    "tare": "readings.tare:Tare",
    "threshold": "thresholds.threshold:Threshold",
    "threshold_learned": "thresholds.threshold_learned:ThresholdLearned",
    "threshold_otsu": "thresholds.threshold_otsu:threshold_otsu",
    "threshold_valley": "thresholds.threshold_valley:threshold_valley",
    "threshold_variable": "thresholds.threshold_variable:threshold_variable",
    "valid_share": "readings.valid_share:valid_share",
    "volts": "readings.volts:Volts",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the filters."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
