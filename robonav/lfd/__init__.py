"""Chapter 3: learning from demonstration."""
