"""Headless Chromium for tests of pages, and what holds of every page of ours.

Debian's chromium, chromium-driver and python3-selenium, which is a library of Debian's python3. Where they are absent the
test is skipped (exit code 77), which `./check` lists.
"""
import html.parser
import json
import shutil
import sys
import time

SKIPPED = 77
CONTRAST = 4.5   # WCAG 2, level AA


def skip(reason):
    print("SKIPPED: " + reason)
    sys.exit(SKIPPED)


class Wrong(Exception):
    """What does not hold of a page."""


def demand(holds, *what):
    if not holds:
        raise Wrong(" ".join(str(one) for one in what))


class Tags(html.parser.HTMLParser):
    """Start tags of a page with their attributes."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.all = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.all.append((tag, dict(attributes)))


# Every text with its colour and what it stands on, as [text, colour, colour behind]. In a drawing that is the topmost filled
# shape below its middle; the window is as high as the page, so that all of it can be asked for.
TEXTS = """
const seen = [];
const clear = (colour) => colour === "none" || colour === "transparent" || /, 0\\)$/.test(colour);
const behind = (element) => {
  for (let e = element; e; e = e.parentElement) {
    const colour = getComputedStyle(e).backgroundColor;
    if (!clear(colour)) return colour;
  }
  return "rgb(255, 255, 255)";
};
for (const element of document.body.querySelectorAll("*")) {
  const own = Array.from(element.childNodes).some((n) => n.nodeType === 3 && n.data.trim() !== "");
  if (!own || ["SCRIPT", "STYLE", "title"].includes(element.tagName) || element.disabled || !element.checkVisibility()) continue;
  const box = element.getBoundingClientRect(), style = getComputedStyle(element);
  if (!(element instanceof SVGElement)) {
    seen.push([element.textContent.trim(), style.color, behind(element)]);
    continue;
  }
  const below = document.elementsFromPoint(box.x + box.width / 2, box.y + box.height / 2)
    .find((e) => !(e instanceof SVGElement) || (e.tagName !== "text" && !clear(getComputedStyle(e).fill) && e.tagName !== "svg"));
  if (!below) continue;
  seen.push([element.textContent, style.fill, below instanceof SVGElement ? getComputedStyle(below).fill : behind(below)]);
}
return seen;
"""


def luminance(colour):
    """Of "rgb(1, 2, 3)", relative (WCAG 2)."""
    numbers = colour[colour.index("(") + 1:colour.rindex(")")].split(",")
    parts = [float(one) / 255 for one in numbers[:3]]
    linear = [x / 12.92 if x <= 0.03928 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


class Browser:
    def __init__(self):
        try:
            from selenium import webdriver
            from selenium.webdriver.chrome.service import Service
        except ImportError:
            skip("python3-selenium is not installed")
        chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
        if not chromium or not driver:
            skip("chromium and chromium-driver are not installed")
        options = webdriver.ChromeOptions()
        options.binary_location = chromium
        for word in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--enable-precise-memory-info", "--window-size=1000,900"):
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"performance": "ALL", "browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(driver), options=options)

    def quit(self):
        self.driver.quit()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def window(self, width, height=900):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def colours(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def open(self, address, server=None):
        """Opens a page and holds that it asks for nothing but itself, or its server, and says nothing on the console."""
        self.driver.get_log("performance"), self.driver.get_log("browser")
        self.driver.get(address)
        if server:
            self.asks_only(server)
            return
        asked = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [one["params"]["request"]["url"] for one in asked if one["method"] == "Network.requestWillBeSent"]
        demand(set(asked) <= {address, "data:,"} and address in asked, "asked for", asked)
        self.is_quiet()

    def asks_only(self, server):
        """All that was asked for since the page was opened, or since this was looked at, is of that server."""
        asked = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [one["params"]["request"]["url"] for one in asked if one["method"] == "Network.requestWillBeSent"]
        demand(asked and all(one == "data:," or one.startswith(server) for one in asked), "asked for", asked)
        self.is_quiet()

    def until(self, holds, *what, seconds=30):
        """Waits for a page that is being filled. @return what holds() gives, once it is not False, None or empty."""
        end = time.time() + seconds
        while time.time() < end:
            try:
                found = holds()
            except Exception:  # an element that has just been replaced
                found = None
            if found:
                return found
            time.sleep(0.05)
        raise Wrong(f"after {seconds} s still not: " + " ".join(str(one) for one in what))

    def is_quiet(self):
        said = [entry for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
        demand(not said, "the console says", said)

    def has_a_policy_in_force(self, text, scripts=1):
        """The page lets nothing be loaded, has no handler in its tags, and a script that is put into it does not run."""
        tags = Tags(text).all
        policies = [a.get("content", "") for tag, a in tags if a.get("http-equiv") == "Content-Security-Policy"]
        demand(len(policies) == 1 and policies[0].startswith("default-src 'none'; script-src 'sha256-"), "policies", policies)
        for tag, attributes in tags:
            for name, value in attributes.items():
                demand(not name.startswith("on") and name not in ("src", "srcset", "srcdoc", "action"), tag, "has", name)
                demand("javascript:" not in (value or ""), tag, name, value)
        running = [a for tag, a in tags if tag == "script" and a.get("type") != "application/json"]
        demand(len(running) == scripts, len(running), "scripts")
        self.run("""const script = document.createElement("script"); script.textContent = "window.got_in = true;";
                    document.body.append(script); script.remove();
                    const made = document.createElement("b"); made.setAttribute("onclick", "window.got_in = true;");
                    document.body.append(made); made.click(); made.remove();""")
        demand(self.run("return window.got_in === undefined;"), "a script that was put into the page ran")
        self.driver.get_log("browser")  # which says so

    def is_legible(self, scheme):
        """Every text in this scheme."""
        self.colours(scheme)
        self.window(1000, min(self.run("return document.documentElement.scrollHeight"), 30000))
        texts = self.run(TEXTS)
        demand(len(texts) > 30, "only", len(texts), "texts were found")
        page = self.run("return getComputedStyle(document.body).backgroundColor")
        demand((luminance(page) < 0.05) == (scheme == "dark"), scheme, "page on", page)
        faint = [(text, ink, paper, round(contrast(ink, paper), 2)) for text, ink, paper in texts if contrast(ink, paper) < CONTRAST]
        demand(not faint, "not legible in the", scheme, "scheme:", faint[:10])
        self.window(1000)
        self.colours("light")

    def fits(self, width):
        """No sideways scrolling of the page, and charts whose texts can be read."""
        self.window(width)
        wide = self.run("return document.documentElement.scrollWidth")
        demand(wide <= width, "the page is", wide, "px wide at", width)
        sizes = self.run("""return Array.from(document.querySelectorAll("svg text"), (e) =>
                              Number(e.getAttribute("font-size")) * Math.hypot(e.getScreenCTM().a, e.getScreenCTM().b));""")
        demand(not sizes or min(sizes) >= 7.5, "a chart has letters of", min(sizes or [0]), "px at", width)
        self.window(1000)
