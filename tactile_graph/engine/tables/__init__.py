"""Results as plain data: rows, columns, tables, with errors where the truth is known."""
