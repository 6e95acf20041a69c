"""An outline followed from frame to frame."""
