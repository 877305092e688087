"""Interactive widgets for the pages of the book."""
