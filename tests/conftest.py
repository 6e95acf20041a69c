"""Profiles of Hypothesis: ``fast`` draws the same examples every time, ``full`` new ones.

``HYPOTHESIS_PROFILE=full`` or ``--hypothesis-profile=full`` chooses; ``fast`` otherwise.
"""

import os

from hypothesis import settings

settings.register_profile("fast", derandomize=True, deadline=None)
settings.register_profile("full", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "fast"))
