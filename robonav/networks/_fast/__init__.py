"""Fast twins of the network's forward pass: compiled for one input at a time, and for many networks at once."""
