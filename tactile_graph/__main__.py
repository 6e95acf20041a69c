"""``python -m tactile_graph`` is the command ``tactile-graph``."""

from tactile_graph.cli import main

if __name__ == "__main__":
    main()
