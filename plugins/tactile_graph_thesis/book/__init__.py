"""The book: every item on one page that needs nothing else, and the files beside it."""
