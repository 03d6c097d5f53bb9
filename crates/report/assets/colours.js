// Colours: a perceptually uniform map (viridis), colours that tell bodies apart (Okabe and Ito), numbers on scales.

const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99],
  [170, 220, 50], [253, 231, 37]];
const BODIES = [[86, 148, 210], [230, 159, 0], [64, 176, 136], [204, 121, 167], [190, 174, 80], [213, 110, 60], [120, 120, 190]];
const GREY = [168, 172, 178];
const FRONT = [213, 60, 40];

/** The colour at a place from 0 to 1, as three numbers to 255. */
function viridis(place) {
  const at = Math.min(Math.max(place, 0), 1) * (VIRIDIS.length - 1);
  const from = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[from].map((c, k) => Math.round(c + (VIRIDIS[from + 1][k] - c) * (at - from)));
}

/** Round values between two ends, about as many as wanted. */
function roundValues(low, high, wanted) {
  const rough = (high - low) / wanted;
  if (!(rough > 0) || !isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((d) => d * power).find((d) => d >= rough * 0.999);
  const values = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) values.push(k * step);
  return values;
}

/** A number with a few digits. */
function shown(value, digits = 4) {
  if (value === 0) return "0";
  if (!isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(Math.max(digits - 2, 0)).replace("e+", "e");
  return String(Number(value.toPrecision(digits)));
}
