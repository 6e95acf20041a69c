"""The classifiers family: features of an object on the pad, and which known object it is."""

from collections.abc import Mapping

from tactile_graph import hookimpl

_STEPS = {
    "describe": "measuring.describe:Describe",
    "discriminant": "distances.discriminant:CanonicalDiscriminant",
    "discriminant_presses": "distances.discriminant_presses:DiscriminantOfPresses",
    "features": "measuring.features:FeaturesOf",
    "fitted_area": "measuring.fitted_area:fitted_area",
    "mahalanobis": "distances.mahalanobis:Mahalanobis",
    "mean_reading": "measuring.mean_reading:MeanReading",
    "nearest_relief": "distances.nearest_relief:NearestRelief",
    "minimum_distance": "distances.minimum_distance:MinimumDistance",
    "minimum_distance_normalised": (
        "distances.minimum_distance_normalised:MinimumDistanceNormalised"
    ),
}


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer features and classifiers."""
    return {name: f"{__name__}.{home}" for name, home in _STEPS.items()}


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands about known objects."""
    names = ("forget", "identify", "learn", "objects")
    return {
        **{name: f"{__name__}.commands.{name}:{name}" for name in names},
        "learn-reliefs": f"{__name__}.commands.learn_reliefs:learn_reliefs",
    }


@hookimpl
def tactile_graph_checks() -> Mapping[str, str]:
    """Offer what looks through object databases and their exports."""
    home = f"{__name__}.database.checking"
    return {"object database": f"{home}:DATABASE", "object export": f"{home}:EXPORT"}
