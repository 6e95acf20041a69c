"""The colours of what is drawn over a pad, the same in picture strips and reports."""

from __future__ import annotations

FOUND, TRUE = "#d81b60", "#00838f"
"""What was found, and what is true; apart for the colour-blind and in grey."""
BEFORE = "#1f4fa8"
"""What an earlier variant found, where two are laid over one another."""
MASK_ON, MASK_OFF = "#37474f", "#eceff1"
SKIPPED, FAILED = "#f3f3f3", "#fde7e7"
