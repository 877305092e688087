"""What readers touch; no computing."""
