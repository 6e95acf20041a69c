"""Pads on a serial port: presets, decoders that take bytes and give frames, and the live link."""
