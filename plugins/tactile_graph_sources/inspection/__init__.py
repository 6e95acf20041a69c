"""What a recording holds, measured, told and drawn for who has never seen it."""
