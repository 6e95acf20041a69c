"""Pictures for people: graphs as SVG and text, picture strips of results, tables."""
