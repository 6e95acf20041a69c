"""The same for pads of many elements, at a cost that grows with the rim."""
