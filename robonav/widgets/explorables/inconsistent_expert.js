// One state in which the expert did two things: which one did it mean?

/** P(s | a) of each action, and P(s, a), which is what the most frequent action has largest. */
export function evidence(here, elsewhere) {
  const all = here.reduce((sum, count, a) => sum + count + elsewhere[a], 0);
  return {
    likelihood: here.map((count, a) => (count + elsewhere[a] > 0 ? count / (count + elsewhere[a]) : 0)),
    joint: here.map((count) => (all > 0 ? count / all : 0)),
  };
}

const NAMES = ["forward", "left"];
const chosen = ([forward, left]) => (forward === left ? "either action" : forward > left ? NAMES[0] : NAMES[1]);

export default explorable({
  controls: ({ here }) => ({
    forwardHere: range({ label: "forward, in this state", from: 0, to: 20, value: here[0] }),
    leftHere: range({ label: "left, in this state", from: 0, to: 20, value: here[1] }),
    forwardElsewhere: range({ label: "forward, elsewhere", from: 0, to: 2000, step: 10, value: 0 }),
    leftElsewhere: range({ label: "left, elsewhere", from: 0, to: 1000, step: 10, value: 0 }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 4], y: [0, 1], xLabel: "", yLabel: "share", xTicks: [], height: 220 });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "forward"], [PALETTE.ORANGE, "left"])));
    return ({ forwardHere, leftHere, forwardElsewhere, leftElsewhere }) => {
      const { likelihood, joint } = evidence([forwardHere, leftHere], [forwardElsewhere, leftElsewhere]);
      const largestJoint = Math.max(...joint) || 1;
      const bar = (at, share, fill) => svg("rect", { x: chart.X(at), y: chart.Y(share), width: chart.X(0.6) - chart.X(0), height: chart.Y(0) - chart.Y(share), fill });
      const text = (at, words) => svg("text", { x: chart.X(at), y: chart.Y(0) + 17, "font-size": 13, "text-anchor": "middle" }, words);
      chart.put(
        "Evidence for the two actions, with both priors",
        bar(0.4, likelihood[0], PALETTE.BLUE), bar(1.1, likelihood[1], PALETTE.ORANGE), text(1.05, "P(s | a)"),
        bar(2.4, joint[0] / largestJoint, PALETTE.BLUE), bar(3.1, joint[1] / largestJoint, PALETTE.ORANGE), text(3.05, "P(s | a) P(a), scaled"),
      );
      return [
        `With equally likely actions: ${chosen(likelihood)}.`, `With the actions' own frequencies as prior: ${chosen(joint)}.`, "",
        "P(s | a) is the share of an action's demonstrations that were made in this state. It is large for a rare action that was taken only here.",
      ].join("\n");
    };
  },
});
