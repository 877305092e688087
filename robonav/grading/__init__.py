"""The autograder: the pytest plugin, the sandbox, and the class runner."""
