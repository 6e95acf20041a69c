"""The project's own commands, each a file of its name, imported when it is called."""
