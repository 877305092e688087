// A target that moves: the copied actions beside the best ones for the same reward.

/** Makes the letters of a grid large enough for a phone, without the target's, and moves the arrows from below them; returns a function that leaves the values to the colours. */
function bare(element) {
  for (const text of element.querySelectorAll("text")) if (text.textContent === "T") text.remove();
  const texts = [...element.querySelectorAll("text")];
  const values = texts.filter((text) => !text.textContent);
  texts.filter((text) => text.textContent).forEach((text) => set(text, { "font-size": 22, dy: 6 }));
  for (const arrow of element.querySelectorAll(".arrow")) set(arrow, { style: "translate: 6px 17px" });
  return () => values.forEach((text) => (text.textContent = ""));
}

export default explorable({
  controls: ({ terrains }) => ({
    target: segments({ label: "the target stands", options: terrains.map(({ name }, k) => [k, name]), value: 0 }),
    learner: segments({ label: "the learner has", options: [["copied", "the actions"], ["reward", "the reward"]], value: "copied" }),
  }),
  draw({ given: { terrains, learned }, stage }) {
    const pictures = terrains.map(({ layout }) => gridPicture({ layout, name: "the learner's policy" }));
    const clear = pictures.map(({ element }) => bare(element));
    const holder = h("figure", {});
    stage.append(holder);
    return ({ target, learner }) => {
      const terrain = terrains[target];
      const { policy, values } = terrain[learner];
      pictures[target].show({ values, policy, said: learner, trajectory: [] }, 2.5, terrain.start);
      clear[target]();
      holder.replaceChildren(pictures[target].element);
      return [
        `The copied action is still the best one in ${terrain.still} of ${terrain.cells} cells.`,
        `Value of the start with the copied actions: ${number(terrain.copied.values[terrain.start])}.`,
        `With the best actions for ${learned ? "the learned" : "the same"} reward: ${number(terrain.reward.values[terrain.start])}.`, "",
        "The reward gives a number to each kind of terrain, and the target is one of the kinds. So the reward stays correct when the target moves.",
      ].join("\n");
    };
  },
});
