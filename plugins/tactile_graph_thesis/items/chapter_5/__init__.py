"""Chapter 5: Bayesian restoration with lines."""
