"""The harness that runs a job on the page where there is no worker."""

import pytest

FILES = ("learning/worker",)
COUNT = """
function* count(last) {
  for (let n = 1; n <= last; n += 1) yield { done: n, total: last, live: { at: n } };
  return "counted";
}
async function* countLater(last) {
  yield* count(last);
  return "counted";
}
function* fail() { yield { done: 1, total: 2 }; throw new Error("It went wrong."); }
const heard = { live: [], progress: [] };
const listeners = (go) => ({
  progress: (...step) => heard.progress.push(step), live: (news) => heard.live.push(...news.map(({ at }) => at)),
  done: (result) => go({ ...heard, result }), error: (sentence) => go({ ...heard, sentence }),
});
"""


@pytest.fixture
def run(node):
    return lambda body: node(FILES, COUNT + body, None)


@pytest.mark.parametrize("job", ["count", "countLater"])
def test_every_step_is_told_in_order(run, job):
    heard = run(
        f"return new Promise((go) => page.startJob(null, {job}, 5000, listeners(go)));"
    )
    assert heard["live"] == list(range(1, 5001))
    assert heard["progress"][-1] == [5000, 5000]
    assert heard["result"] == "counted"


def test_an_error_is_told_as_a_sentence(run):
    heard = run(
        "return new Promise((go) => page.startJob(null, fail, null, listeners(go)));"
    )
    assert heard["sentence"] == "It went wrong."


def test_a_cancelled_job_says_no_more(run):
    heard = run(
        """return new Promise((go) => {
          const job = page.startJob(null, count, Infinity, listeners(() => go("it should not end")));
          setTimeout(() => { job.cancel(); heard.live.length = 0; setTimeout(() => go(heard.live.length), 60); }, 40);
        });"""
    )
    assert heard == 0
