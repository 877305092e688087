"""Chapter 4: neural-network Q-learning."""
