"""Chapter 4: thresholds, discs, rectangles, identification."""
