"""A declaration becomes a graph: nodes in order, bound, checked, their facts followed."""
