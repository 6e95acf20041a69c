"""What ``tactile-graph new`` makes a plugin's package of: templates by kind, and their filling."""
