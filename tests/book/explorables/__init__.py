"""What each explorable has to show for its settings, computed by the package's functions; a file for each chapter."""
