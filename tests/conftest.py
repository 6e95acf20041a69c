"""Hypothesis draws the same examples every time; ``HYPOTHESIS_PROFILE=full`` draws new ones."""

import os

from hypothesis import settings

settings.register_profile("fixed", derandomize=True)
settings.register_profile("full")
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "fixed"))
