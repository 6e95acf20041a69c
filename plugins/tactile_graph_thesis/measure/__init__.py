"""What several items, or the benchmarks, measure: errors of pipelines on simulated readings."""
