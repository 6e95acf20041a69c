"""Steps that bring noise of a known size between the blocks of a pipeline."""
