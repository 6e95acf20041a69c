"""What serves the page: messages, viewers, what may be asked, and who may ask."""
