"""The registry of policies and the leaderboard."""
