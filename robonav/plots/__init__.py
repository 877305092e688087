"""Results in, matplotlib figures out; no computing."""
