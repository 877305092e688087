"""Section 2.5: worlds, sensing, motion, and the Gymnasium environments."""
