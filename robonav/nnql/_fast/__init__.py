"""The fast twin of chapter 4's learners: many seeds at once, with compiled networks and one simulator.

The readable functions, such as :func:`robonav.nnql.nnql`, train one network on one environment. The classes here train
S networks side by side on S robots and compute the same numbers. Tests hold the two equal.
"""
