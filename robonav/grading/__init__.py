"""The autograder: the pytest plugin, the sandbox, the class runner."""
