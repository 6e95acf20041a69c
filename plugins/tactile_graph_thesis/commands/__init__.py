"""Commands about pads: calibrating one, and the studies of the thesis' chapter on its own."""
