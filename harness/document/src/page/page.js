// Draws each figure when it comes into view. Without this script, in print, and until then, the static figure stands in its place.
"use strict";
(() => {
  const settings = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"] };
  // Height of the axis title with its ticks, and of a line of the legend, in pixels.
  const axis = 62, line = 21;
  // The least width of a panel that can be read.
  const panel = 230;

  // The legend stands below the horizontal axis, in as many columns as its words leave room for.
  const fit = (layout, data, width) => {
    const words = [...data.filter((trace) => trace.name && trace.showlegend !== false).map((trace) => trace.name),
      ...(layout.shapes || []).filter((shape) => shape.showlegend).map((shape) => shape.name)];
    const longest = Math.max(1, ...words.map((name) => name.replace(/<[^>]*>/g, "").length));
    // It begins at the left edge: from within the axes it would end with them.
    const { l, r } = layout.margin;
    const columns = Math.max(1, Math.floor((width - r) / (52 + 7.2 * longest)));
    const plot = layout.height;
    layout.margin.b = axis + line * Math.ceil(words.length / columns);
    layout.height = plot + layout.margin.t + layout.margin.b;
    const entrywidth = Math.floor((width - r) / columns) - 52;
    layout.legend = { ...layout.legend, y: -axis / plot, x: -l / (width - l - r), xanchor: "left", entrywidth };
  };

  const draw = async (figure) => {
    const { data, layout } = JSON.parse(figure.querySelector("script[type='application/json']").textContent);
    const live = figure.querySelector(".live");
    figure.classList.add("drawn");
    const across = layout.meta.columns;
    if (live.clientWidth < across * panel) live.style.minWidth = `${across * panel}px`;
    fit(layout, data, live.clientWidth);
    live.style.height = `${layout.height}px`;
    try {
      await Plotly.newPlot(live, data, layout, settings);
      live.setAttribute("role", "img");
      live.setAttribute("aria-label", `${figure.querySelector("h2, h3").textContent}: its data follow as a table`);
    } catch (error) {
      figure.classList.remove("drawn");
      console.error(figure.id, error);
    }
  };

  const figures = [...document.querySelectorAll("figure.plot")].filter((figure) => figure.querySelector(".live"));
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries.filter((entry) => entry.isIntersecting)) {
      seen.unobserve(entry.target);
      draw(entry.target);
    }
  }, { rootMargin: "300px" });
  figures.forEach((figure) => seen.observe(figure));
})();
