"""The process that reads the pad and runs the pipeline, and nothing else."""
