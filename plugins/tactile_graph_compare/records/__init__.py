"""What a comparison found out, as plain records."""
