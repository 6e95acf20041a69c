"""What a restored image and its line field cost."""
