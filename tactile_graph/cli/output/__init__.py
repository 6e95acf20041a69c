"""What a run gives: rows for people, lines, tables, stacks and pictures in files."""
