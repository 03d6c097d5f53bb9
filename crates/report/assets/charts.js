// Charts of histories and residuals, with the values under the pointer; by keys where a chart is chosen.

/** Draws a chart into a place of the page. */
function drawChart(place, chart) {
  const ink = () => getComputedStyle(document.body).color;
  const line = () => getComputedStyle(document.body).getPropertyValue("--line");
  const heading = Object.assign(document.createElement("h3"), { textContent: chart.title });
  const few = chart.x.length <= 60;
  const colours = ["#3f7fc4", "#d08a00", "#1f9e77", "#c05f98", "#8a7a20", "#d0552f", "#7474bd", "#5b9aa0"];
  const number = (u, value) => (value == null ? "" : shown(value, 6));
  const series = chart.series.map((s, k) => ({
    label: s.label, stroke: colours[k % colours.length], width: 2, points: { show: few, size: 6 }, value: number, spanGaps: false,
  }));
  const axis = (label, size) => ({
    stroke: ink, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, label, size, font: "12px system-ui, sans-serif",
    labelFont: "13px system-ui, sans-serif", labelSize: label ? 24 : 0,
    values: (u, list) => list.map((v) => (v == null ? "" : chart.log && size > 50 ? `1e${Math.round(Math.log10(v))}` : shown(v))),
  });
  const upright = axis("", 64);
  if (chart.log) upright.splits = (u, k, low, high) => powers(low, high);
  const limit = (u) => {
    if (chart.limit === undefined) return;
    const y = u.valToPos(chart.limit, "y", true);
    if (y < u.bbox.top || y > u.bbox.top + u.bbox.height) return;
    const c = u.ctx;
    c.save();
    c.strokeStyle = "#d53c28";
    c.setLineDash([6, 5]);
    c.lineWidth = 2;
    c.beginPath();
    c.moveTo(u.bbox.left, y);
    c.lineTo(u.bbox.left + u.bbox.width, y);
    c.stroke();
    c.restore();
  };
  const options = {
    width: 400, height: 260, legend: { live: true }, cursor: { drag: { x: true, y: false } },
    scales: { x: { time: false }, y: chart.log ? { distr: 3 } : { range: padded } },
    axes: [axis(chart.x_label, 46), upright], series: [{ label: chart.x_label.split(",")[0], value: number }, ...series],
    hooks: { draw: [limit] },
  };
  const values = chart.series.map((s) => s.values);
  place.append(heading);
  place.setAttribute("role", "group");
  place.ariaLabel = `Chart: ${chart.title}. Left and right tell values.`;
  place.tabIndex = 0;
  const plot = new uPlot(options, [chart.x, ...values], place);
  const resize = () => plot.setSize({ width: Math.max(place.clientWidth, 240), height: 260 });
  new ResizeObserver(resize).observe(place);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plot.redraw());
  place.addEventListener("keydown", (e) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    if (!step) return;
    e.preventDefault();
    const at = Math.min(Math.max((plot.cursor.idx ?? -step) + step, 0), chart.x.length - 1);
    plot.setCursor({ left: plot.valToPos(chart.x[at], "x"), top: plot.over.clientHeight / 2 });
  });
  return plot;
}

/** Powers of ten between two values, not more than are read. */
function powers(low, high) {
  const [from, to] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const step = Math.max(1, Math.ceil((to - from) / 7));
  const list = [];
  for (let k = Math.ceil(from / step) * step; k <= to; k += step) list.push(10 ** k);
  return list;
}

/** Values with room above and below, from zero where they begin near it. */
function padded(u, low, high) {
  if (low == null || high == null) return [0, 1];
  const span = high - low || Math.abs(high) || 1;
  const from = low >= 0 && low < 0.4 * high ? 0 : low - 0.06 * span;
  const to = high <= 0 && high > 0.4 * low ? 0 : high + 0.06 * span;
  return [from, to];
}
