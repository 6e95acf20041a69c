"""Localisation through the pad's own physics: a likelihood of outlines, and its posterior."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "above_noise": "any_pad.above_noise:AboveNoise",
    "choose_shape": "single.choose_shape:ChooseShape",
    "fit_footprint": "single.fit_footprint:FitFootprint",
    "follow_footprint": "over_time.follow_footprint:FollowFootprint",
    "footprint_by_order": "by_order.footprint_by_order:FootprintByOrder",
    "fit_footprints": "several.fit_footprints:FitFootprints",
    "footprint_disc": "single.footprint_of:FootprintDisc",
    "footprint_ellipse": "single.footprint_of:FootprintEllipse",
    "footprint_rectangle": "single.footprint_of:FootprintRectangle",
    "identify_footprint": "known.identify_footprint:IdentifyFootprint",
    "locate": "any_pad.choose:Locate",
    "locate_contacts": "any_pad.locate_contacts:LocateContacts",
    "locate_disc": "any_pad.locate:LocateDisc",
    "locate_ellipse": "any_pad.locate:LocateEllipse",
    "locate_rectangle": "any_pad.locate:LocateRectangle",
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the fits by likelihood."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}
