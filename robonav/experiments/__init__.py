"""Every table and figure of the thesis as a named experiment."""
