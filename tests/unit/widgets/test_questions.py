"""The Node process that runs the widgets' JavaScript: each question stands alone, and a fault is its own test's."""

import pytest


@pytest.mark.parametrize(
    ("module", "body", "sentence"),
    [
        ("", 'throw new Error("wrong");', "Error: wrong"),
        ("", "return page.missing();", "page.missing is not a function"),
        ("", 'return Promise.reject(new Error("later"));', "Error: later"),
        (
            "",
            'setTimeout(() => { throw new Error("in a timer"); }, 0); return new Promise(() => {});',
            "in a timer",
        ),
        (
            "",
            'Promise.reject(new Error("unheard")); return new Promise((go) => setTimeout(go, 1000, 1));',
            "unheard",
        ),
        ("", "return new Promise(() => {});", "waits for what never comes"),
        ("", "return process.stdin.missing.more;", "TypeError"),
        ("const a = 1; const a = 2;", "return 1;", "'a' has already been declared"),
        ('import "./other.mjs";', "return 1;", "The module imports ./other.mjs."),
        ("missing();", "return 1;", "missing is not defined"),
        ("", "return 1n;", "BigInt"),
    ],
)
def test_a_fault_is_the_tests_failure_and_the_next_question_is_answered(
    ask, module, body, sentence
):
    with pytest.raises(AssertionError, match=sentence):
        ask(module, body, None)
    assert ask("export const two = 2;", "return page.two + data;", 3) == 5


def test_a_question_finds_nothing_of_the_one_before(ask):
    module = "let count = 0; export const next = () => (count += 1);"
    body = """
      const seen = [page.next(), typeof globalThis.mine, typeof [].mine, typeof Math.mine, typeof setTimeout.mine];
      globalThis.mine = Array.prototype.mine = Math.mine = setTimeout.mine = 1;
      console.log("this is no answer");
      setTimeout(() => { throw new Error("after the answer"); }, 0);
      return seen;
    """
    alone = [1, "undefined", "undefined", "undefined", "undefined"]
    assert [ask(module, body, None) for _ in range(3)] == [alone] * 3


def test_data_are_of_the_questions_own_kind(ask):
    body = "return [data.list instanceof Array, data instanceof Object, data.list];"
    assert ask("", body, {"list": [1.5, "é"]}) == [True, True, [1.5, "é"]]
