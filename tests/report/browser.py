"""Headless Chromium, as much of it as the tests of the page need."""

import base64
import pathlib
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

WIDE, TALL = 1300, 900


class Browser:
    def __init__(self, downloads):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        # WebGL without a graphics card; a container has no sandbox and little shared memory.
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                         "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                         f"--window-size={WIDE},{TALL}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        self.driver.set_script_timeout(300)
        self.driver.set_page_load_timeout(300)
        self.downloads = pathlib.Path(downloads)
        self.command("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(downloads))
        self.resize(WIDE)

    def command(self, name, **arguments):
        return self.driver.execute_cdp_cmd(name, arguments)

    def resize(self, width):
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=TALL,
                     deviceScaleFactor=1, mobile=width < 600)

    def prefer(self, scheme):
        self.command("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, path):
        self.driver.get(pathlib.Path(path).as_uri())
        self.wait(lambda: self.run("return document.documentElement.dataset.ready") == "yes")

    def draw_everything(self):
        """The layout for printing."""
        self.run("dispatchEvent(new Event('beforeprint'))")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def find_all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def messages(self):
        return self.driver.get_log("browser")

    def show(self, node):
        self.run("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", node)
        return node

    def wait(self, holds, what="something"):
        """Until it holds; a browser on a busy machine takes its time."""
        for _ in range(1200):
            found = holds()
            if found:
                return found
            time.sleep(0.05)
        raise AssertionError(f"waited in vain for {what}")

    def frames(self):
        """Two frames are drawn."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done))")

    def picture(self, node):
        self.frames()
        return node.screenshot_as_png

    def colours(self, png):
        """How many colours a picture has, and which share of it is not the colour of a corner."""
        return self.driver.execute_async_script("""
            const [text, done] = arguments, image = new Image();
            image.onload = () => {
              const canvas = document.createElement("canvas");
              [canvas.width, canvas.height] = [image.width, image.height];
              const context = canvas.getContext("2d");
              context.drawImage(image, 0, 0);
              const {data} = context.getImageData(0, 0, image.width, image.height);
              const seen = new Set(), at = (i) => (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
              const corner = at(4 * (5 * image.width + 5));
              let other = 0;
              for (let i = 0; i < data.length; i += 4) {
                seen.add(at(i));
                if (at(i) !== corner) ++other;
              }
              done([seen.size, other / (data.length / 4)]);
            };
            image.src = "data:image/png;base64," + text;""", base64.b64encode(png).decode())

    def downloaded(self, before):
        """The one file that has come since, and its name."""
        def arrived():
            new = [path for path in self.downloads.iterdir()
                   if path not in before and path.suffix != ".crdownload"]
            return new[0] if new and new[0].stat().st_size > 0 else None
        return self.wait(arrived, "a download")

    def quit(self):
        self.driver.quit()
