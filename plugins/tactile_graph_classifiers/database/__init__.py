"""Object databases: SQLite files of objects, readings and statistics, and their YAML exports."""
