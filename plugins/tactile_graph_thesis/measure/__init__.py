"""What is measured for the tables and figures: errors of pipelines on simulated readings."""
