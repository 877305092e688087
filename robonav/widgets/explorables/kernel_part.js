// What Python trains for an explorable: its settings and curves, as Python describes them, and what the page then shows.

const CURVE_COLOURS = [PALETTE.BLUE, PALETTE.ORANGE, PALETTE.GREEN, PALETTE.VERMILION];

/** A slider or a list for a setting, which writes into the settings. @param {Record<string, any>} settings */
function settingControl(settings, name, { label, options, start, stop, step, value, unit }) {
  if (options) {
    settings[name] = options[0];
    return choice({ label, options, change: (index) => (settings[name] = options[index]) }).element;
  }
  const number = (at) => Number((start + at * step).toFixed(10));
  const stepOf = (at) => Math.round((at - start) / step);
  settings[name] = value;
  return slider({
    label, count: stepOf(stop) + 1, value: stepOf(value), text: (at) => `${number(at)}${unit}`, change: (at) => (settings[name] = number(at)),
  }).element;
}

/**
 * The panel of an explorable's training in the kernel.
 * @param {{model: any, described: any, show: (given: Record<string, any>) => void}} options described: a `KernelPart` of
 *   Python; show: gets the numbers of the explorable that the training changes
 */
export function kernelPart({ model, described: { title, action, unit, length, settings: asked, curves }, show }) {
  const settings = {};
  const controls = Object.entries(asked).map(([name, own]) => settingControl(settings, name, own));
  return kernelPanel({
    model, title, action, unit, total: () => settings[length] ?? length, controls,
    lines: curves.map(({ digits, ...line }, k) => ({ ...line, colour: CURVE_COLOURS[k], text: (value) => value.toFixed(digits) })),
    request: () => ({ settings }),
    done: ({ sentence, given }) => {
      show(given);
      return sentence;
    },
  });
}
