"""Documentation that several functions share."""

from robonav.documentation import add_sections, documents

SHARED = {
    "x": "float\n    Input.",
    "y": "float\n    Label.",
    "rate": "float\n    Step.",
}


def test_only_what_a_docstring_leaves_out_is_added_in_the_order_of_the_signature():
    @documents(SHARED, returns="int", raises="ValueError\n    If wrong.")
    def train(x, y, rate, *, steps):
        """Train.

        Parameters
        ----------
        y : bool
            The function's own.
        steps : int
            How many.

        Returns
        -------
        float
        """

    assert train.__doc__ == (
        "Train.\n\n"
        "Parameters\n----------\n"
        "x : float\n    Input.\n"
        "y : bool\n    The function's own.\n"
        "rate : float\n    Step.\n"
        "steps : int\n    How many.\n\n"
        "Returns\n-------\nfloat\n\n"
        "Raises\n------\nValueError\n    If wrong."
    )


def test_a_joint_entry_counts_for_all_its_names():
    @documents(SHARED)
    def fit(x, y):
        """Fit.

        Parameters
        ----------
        x, y : arrays
            Examples.
        """

    assert fit.__doc__ == "Fit.\n\nParameters\n----------\nx, y : arrays\n    Examples."


def test_a_function_without_shared_parameters_keeps_its_docstring():
    @documents(SHARED)
    def go():
        """Go."""

    assert go.__doc__ == "Go."


def test_sections_of_another_file_stand_below_the_docstring_of_the_source():
    def go():
        """Go.

        Far away.
        """

    add_sections(go, "\nReturns\n-------\nint\n")
    assert go.__doc__ == "Go.\n\nFar away.\n\nReturns\n-------\nint"
