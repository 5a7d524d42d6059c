//! The page in a real browser: figures are drawn, hover tells, curves hide, zoom moves. Without Chromium on this machine nothing is tested.

use crate::{Script, files, fixture};
use std::path::Path;
use std::process::Command;

/// Uses the page as a reader does, and leaves what came of it in the element `probe`.
const PROBE: &str = r##"<script>
(async () => {
  const found = { errors: [] };
  window.addEventListener("error", (event) => found.errors.push(String(event.message)));
  const sleep = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
  try {
    const figures = [...document.querySelectorAll("figure.plot")].filter((figure) => figure.querySelector(".live"));
    found.figures = figures.length;
    const drawn = () => figures.filter((figure) => figure.querySelector(".live .main-svg")).length;
    for (let tries = 0; tries < 600 && drawn() < figures.length; tries++) await sleep(100);
    found.drawn = drawn();
    found.hidden = figures.every((figure) => getComputedStyle(figure.querySelector(".still")).display === "none");
    const plot = document.querySelector("#variance .live");
    const curve = plot.data.findIndex((trace) => trace.mode === "markers");
    Plotly.Fx.hover(plot, [{ curveNumber: curve, pointNumber: 3 }]);
    await sleep(300);
    found.hover = plot.querySelector(".hoverlayer").textContent;
    const shown = () => plot.data.filter((trace) => trace.visible !== "legendonly").length;
    const before = shown();
    const toggle = [...plot.querySelectorAll(".traces")].find((entry) => entry.textContent.includes("Woodcock")).querySelector(".legendtoggle");
    for (const kind of ["mousedown", "mouseup"]) toggle.dispatchEvent(new MouseEvent(kind, { bubbles: true }));
    await sleep(1000);
    found.toggled = before - shown();
    const range = () => plot.layout.xaxis.range.join();
    const whole = range();
    await Plotly.relayout(plot, { "xaxis.range": [0, 1] });
    found.zoomed = range() !== whole && range() === "0,1";
    found.wide = document.documentElement.scrollWidth <= window.innerWidth;
    found.height = document.documentElement.scrollHeight;
  } catch (error) {
    found.errors.push(String(error.stack));
  }
  const result = document.createElement("pre");
  result.id = "probe";
  result.textContent = JSON.stringify(found);
  document.body.append(result);
})();
</script></body>"##;

/// Everything is in view at once: a browser without a window shows frames when it likes.
const IN_VIEW: &str = "<head><script>window.IntersectionObserver = class {
  constructor(tell) { this.tell = tell; }
  observe(target) { this.tell([{ isIntersecting: true, target }]); }
  unobserve() {}
};</script>";

/// The name of a browser on this machine.
fn chromium() -> Option<&'static str> {
    ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()))
}

/// The page after its scripts ran in a window of this width.
fn seen(browser: &str, page: &Path, width: u32) -> serde_json::Value {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", "--virtual-time-budget=90000"])
        .arg(format!("--window-size={width},9000"))
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let probe =
        dom.split_once("<pre id=\"probe\">").unwrap_or_else(|| panic!("no probe in {} bytes", dom.len())).1;
    let text = probe.split_once("</pre>").unwrap().0;
    serde_json::from_str(&text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")).unwrap()
}

#[test]
fn a_reader_can_point_hide_and_zoom() {
    let Some(browser) = chromium() else {
        eprintln!("skipped: there is no Chromium on this machine");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for file in files(&fixture::document(), Script::Embedded).unwrap() {
        std::fs::write(folder.path().join(&file.name), &file.bytes).unwrap();
    }
    let page = folder.path().join("index.html");
    let html = std::fs::read_to_string(&page).unwrap();
    let end = html.rfind("</body>").unwrap();
    let html = format!("{}{PROBE}{}", &html[..end], &html[end + "</body>".len()..]);
    std::fs::write(&page, html.replacen("<head>", IN_VIEW, 1)).unwrap();
    for width in [1400, 500] {
        let found = seen(browser, &page, width);
        assert_eq!(found["errors"], serde_json::json!([]), "{found}");
        assert_eq!((&found["figures"], &found["drawn"]), (&4.into(), &4.into()), "{found}");
        assert_eq!(found["hidden"], true, "{found}");
        assert!(found["hover"].as_str().unwrap().contains("relative variance"), "{found}");
        assert_eq!(found["toggled"], 2, "line and marks of one curve: {found}");
        assert_eq!(found["zoomed"], true, "{found}");
        assert_eq!(found["wide"], true, "nothing is wider than the window: {found}");
    }
}
