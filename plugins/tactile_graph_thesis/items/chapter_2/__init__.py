"""Chapter 2: the pad: converter, bias resistors, footprints, calibration."""
