"""Seven small plugins, each in one file."""
