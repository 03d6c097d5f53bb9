// Starts the view and the charts, and follows a run that goes on.

const data = JSON.parse(byId("data").textContent);

function start() {
  const places = [...document.querySelectorAll("#histories .chart, #convergence .chart")];
  const charts = [...data.histories, ...(data.residuals ? [data.residuals] : [])];
  if (!data.scene) return charts.forEach((chart, k) => drawChart(places[k], chart));
  try {
    byId("viewer").hidden = false;
    byId("fallback").hidden = true;
    window.viewer = new Viewer(data.scene);
    printable(window.viewer);
  } catch (error) {
    // Without WebGL, the stored picture is shown.
    byId("viewer").hidden = true;
    byId("fallback").hidden = false;
    console.info(`No view: ${error.message}`);
  }
  charts.forEach((chart, k) => drawChart(places[k], chart));
}

/** Without a stored picture, what the view shows is printed. */
function printable(viewer) {
  const fallback = byId("fallback");
  if (fallback.querySelector("img")) return;
  addEventListener("beforeprint", () => {
    viewer.drawNow();
    const image = Object.assign(new Image(), { src: viewer.canvas.toDataURL(), alt: viewer.canvas.ariaLabel });
    fallback.replaceChildren(image);
  });
}

/** Makes the page again where there is something new. */
async function follow() {
  let known = STATE;
  for (;;) {
    await new Promise((done) => setTimeout(done, 1500));
    try {
      const state = await (await fetch("state", { cache: "no-store" })).text();
      if (state !== known && document.visibilityState === "visible" && !window.viewer?.timer) {
        window.viewer?.keep();
        location.reload();
        return;
      }
    } catch {
      // The server has ended; the page stays.
      return;
    }
  }
}

start();
if (SERVED) follow();
