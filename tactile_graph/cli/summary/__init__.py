"""What the command ``summary`` tells of results that runs wrote."""
