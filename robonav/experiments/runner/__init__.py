"""Run experiments, keep and summarise their results."""
