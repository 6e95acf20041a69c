"""Many frames at once: gathered, through the same program over stacks, parted where they part."""
