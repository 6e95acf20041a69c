"""How much of each element an outline covers, exactly."""
