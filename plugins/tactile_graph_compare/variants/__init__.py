"""What is compared: pipelines, settings, sweeps, lineages, merged into one graph."""
