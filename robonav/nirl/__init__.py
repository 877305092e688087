"""Chapter 5: neural inverse reinforcement learning."""
