"""What users and files say of a recording: units, names of columns, notes, what truly lay there."""
