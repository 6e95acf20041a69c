"""Objects' reliefs: learned from presses, fitted to further ones, which are named by the misfit."""
