//! Every page that a command leaves, in a browser: at the widths of a phone, a tablet and a desk, light, dark and as
//! printed. Nothing may stick out, be cut, lie on something else or be too small to read. Pictures of all of it are left
//! in the build's `tmp/pages`.

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Process;

/// Browsers that can do it, by their names.
const BROWSERS: [&str; 4] = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
const WIDTHS: [u32; 3] = [375, 768, 1280];
/// A4 between its margins, in CSS pixels.
const PAPER: u32 = 700;
/// Smallest text, CSS pixels.
const SMALLEST: f64 = 7.0;

/// Looks at a page from inside: what is wrong, a line each, between marks.
const PROBE: &str = r#"<script>addEventListener('load', () => {
  const wide = document.documentElement.clientWidth, wrong = [];
  const name = e => e.tagName + ' ' + (e.textContent || '').trim().slice(0, 40).replace(/\s+/g, ' ');
  if (document.documentElement.scrollWidth > wide) wrong.push('the page is ' + document.documentElement.scrollWidth + ' wide');
  for (const e of document.querySelectorAll('body *')) {
    const inSvg = e.closest('svg') && e.tagName !== 'text' && e.tagName !== 'svg', box = e.getBoundingClientRect();
    if (inSvg || !box.width || e.tagName === 'SCRIPT') continue;
    if (box.right > wide + 1 || box.left < -1) wrong.push('sticks out: ' + name(e) + ' to ' + box.right.toFixed(0));
    if (!e.closest('svg') && e.scrollWidth > e.clientWidth + 1 && e.clientWidth) wrong.push('is cut: ' + name(e));
    const size = e.tagName === 'text' ? parseFloat(getComputedStyle(e).fontSize) * Math.abs(e.getScreenCTM().a || e.getScreenCTM().b)
      : e.children.length || e.closest('svg') ? 99 : parseFloat(getComputedStyle(e).fontSize);
    if (size < SMALLEST) wrong.push('is small, ' + size.toFixed(1) + ' px: ' + name(e));
  }
  for (const svg of document.querySelectorAll('body svg')) {
    const boxes = [...svg.querySelectorAll('text')].map(t => [t, t.getBoundingClientRect()]);
    boxes.forEach(([a, p], i) => boxes.slice(i + 1).forEach(([b, q]) => {
      const over = (l, r, m, n) => Math.min(r, n) - Math.max(l, m);
      if (over(p.left, p.right, q.left, q.right) > 1 && over(p.top, p.bottom, q.top, q.bottom) > 2)
        wrong.push('lies on another: ' + name(a) + ' on ' + name(b));
    }));
  }
  const light = c => { const [r, g, b] = c.match(/[\d.]+/g).map(x => { x /= 255; return x <= .04 ? x / 12.9 : ((x + .055) / 1.055) ** 2.4; });
    return .2126 * r + .7152 * g + .0722 * b; };
  const style = getComputedStyle(document.body), [ink, paper] = [light(style.color), light(style.backgroundColor)];
  if ((Math.max(ink, paper) + .05) / (Math.min(ink, paper) + .05) < 7) wrong.push('text is hard to see');
  const height = document.documentElement.scrollHeight;
  document.documentElement.textContent = 'PROBE\n' + [height, paper < .5 ? 'dark' : 'light', ...wrong].join('\n') + '\nEND';
});</script>"#;

fn browser() -> &'static str {
    let runs = |name: &&&str| Process::new(name).arg("--version").output().is_ok_and(|o| o.status.success());
    BROWSERS.iter().find(runs).unwrap_or_else(|| {
        panic!(
            "no browser to look at pages with: install the Debian package chromium-headless-shell, or skip this test"
        )
    })
}

/// How a page is looked at.
#[derive(Clone, Copy, PartialEq)]
enum Medium {
    Light,
    Dark,
    Print,
}

fn browse(page: &Path, (width, height): (u32, u32), medium: Medium, more: &[&str]) -> String {
    let scheme = if medium == Medium::Dark { 0 } else { 1 };
    let output = Process::new(browser())
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=5000"])
        .arg(format!("--blink-settings=preferredColorScheme={scheme}"))
        .arg(format!("--window-size={width},{height}"))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The page as this medium has it, with the probe; then its picture. What is wrong.
fn look(page: &Path, label: &str, width: u32, medium: Medium, pictures: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let text = if medium == Medium::Print { text.replace("@media print", "@media all") } else { text };
    let shown = pictures.join(format!("{label}.html"));
    fs::write(&shown, &text).unwrap();
    let probed = pictures.join(format!("{label}-probe.html"));
    let probe = PROBE.replace("SMALLEST", &SMALLEST.to_string());
    fs::write(&probed, text.replace("</body>", &format!("{probe}</body>"))).unwrap();
    let said = browse(&probed, (width, 900), medium, &["--dump-dom"]);
    let said = said.split("PROBE\n").nth(1).and_then(|rest| rest.split("\nEND").next());
    let mut lines = said.unwrap_or_else(|| panic!("{label}: the probe said nothing")).lines();
    let height: u32 = lines.next().unwrap().parse().unwrap();
    let mut wrong: Vec<String> = lines.by_ref().skip(1).map(|line| format!("{label}: {line}")).collect();
    let told = fs::read_to_string(&probed).unwrap();
    assert!(told.contains("prefers-color-scheme:dark"), "{label} has no dark style");
    let picture = pictures.join(format!("{label}.png"));
    let screenshot = format!("--screenshot={}", picture.display());
    browse(&shown, (width, height.clamp(300, 16_000)), medium, &[&screenshot]);
    if fs::metadata(&picture).map_or(0, |file| file.len()) < 5_000 {
        wrong.push(format!("{label}: an empty picture"));
    }
    fs::remove_file(&probed).unwrap();
    fs::remove_file(&shown).unwrap();
    wrong
}

fn racbot(folder: &Path, arguments: &[&str]) {
    Command::cargo_bin("racbot").unwrap().current_dir(folder).args(arguments).assert().success();
}

#[test]
fn pages_are_whole_in_a_browser_at_every_width() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs/wheel-skew").canonicalize().unwrap();
    let data = data.to_str().unwrap();
    racbot(folder.path(), &["demo", "--out", "demo", "--ticks", "5"]);
    racbot(folder.path(), &["simulate", "--skew-deg", "4,-3,2", "--out", "simulate"]);
    racbot(folder.path(), &["calibrate", data, "--out", "calibrate"]);
    racbot(folder.path(), &["gap", data, "--out", "gap"]);
    let pictures = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pages");
    fs::create_dir_all(&pictures).unwrap();
    let mut wrong = Vec::new();
    let pages = [
        "demo/index.html",
        "demo/board/gap/report.html",
        "simulate/index.html",
        "calibrate/index.html",
        "gap/report.html",
    ];
    for page in pages {
        let (file, name) = (folder.path().join(page), page.replace('/', "-").replace(".html", ""));
        for (medium, what) in [(Medium::Light, "light"), (Medium::Dark, "dark")] {
            for width in WIDTHS {
                wrong.extend(look(&file, &format!("{name}-{width}-{what}"), width, medium, &pictures));
            }
        }
        wrong.extend(look(&file, &format!("{name}-print"), PAPER, Medium::Print, &pictures));
        for link in fs::read_to_string(&file).unwrap().split("href=\"").skip(1) {
            let to = link.split('"').next().unwrap();
            let there = to.starts_with('#') || file.parent().unwrap().join(to).exists();
            assert!(there, "{page}: its link to {to} leads nowhere");
        }
    }
    assert!(wrong.is_empty(), "{} things, pictures in {}:\n{}", wrong.len(), pictures.display(), wrong.join("\n"));
}

#[test]
fn what_is_wrong_is_found_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let body = "<p style=\"width:900px\">wide</p><p style=\"font-size:3px\">small</p>\
                <div style=\"width:50px;overflow:hidden;white-space:nowrap\">cut at its end, as it is long</div>\
                <svg width=\"90\" height=\"40\"><text x=\"5\" y=\"20\">one</text><text x=\"12\" y=\"22\">two</text></svg>";
    let style = "body{color:#000;background:#fff}@media (prefers-color-scheme:dark){body{color:#223;background:#000}}";
    fs::write(&page, format!("<!doctype html><head><style>{style}</style></head><body>{body}</body>")).unwrap();
    let light = look(&page, "light", 375, Medium::Light, folder.path()).join("\n");
    for part in
        ["sticks out: P wide", "is small, 3.0 px: P small", "is cut: DIV", "lies on another: text one on text two"]
    {
        assert!(light.contains(part), "{part}\n{light}");
    }
    assert!(!light.contains("hard to see"), "{light}");
    assert!(look(&page, "dark", 375, Medium::Dark, folder.path()).join("\n").contains("hard to see"));
}
