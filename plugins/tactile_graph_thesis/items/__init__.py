"""Every table, figure and study, by chapter; a file's name says which it makes."""
