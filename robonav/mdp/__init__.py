"""Chapter 2: finite MDPs, planning, tabular learning, partial observation, gridworlds."""
