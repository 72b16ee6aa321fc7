"""A store that `faultsweep serve` serves to a browser."""
import json
import os
import signal
import subprocess

from browser import Browser, demand


class Served:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder
        self.store = os.path.join(folder, "store")
        self.temporary = os.path.join(folder, "tmp")
        os.makedirs(self.temporary, exist_ok=True)
        os.environ.update(XDG_CACHE_HOME=os.path.join(folder, "cache"), OPENBLAS_NUM_THREADS="1", TMPDIR=self.temporary)
        self.server = None
        self.browser = Browser()

    def told(self, program, *words):
        return subprocess.run([os.path.join(self.programs, program), *words], check=True, cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, encoding="utf-8").stdout

    def serve(self):
        self.server = subprocess.Popen([os.path.join(self.programs, "faultsweep"), "serve", self.store, "--port", "0", "--json"],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8")
        said = ""
        while not said.rstrip().endswith("}"):
            said += self.server.stdout.readline()
        self.address = json.loads(said)["address"]

    def end_simulator(self):
        """Ends the one that the server keeps for what-if, as a machine without memory does."""
        tasks = f"/proc/{self.server.pid}/task"
        children = [int(child) for task in os.listdir(tasks) for child in open(f"{tasks}/{task}/children", encoding="ascii").read().split()]
        demand(len(children) == 1, "the server has the children", children)
        os.kill(children[0], signal.SIGKILL)

    def at(self, place):
        """Opens the page there, and anew where only what is behind # differs."""
        self.browser.driver.get("about:blank")
        self.browser.open(self.address + "#/" + place, self.address)

    def end(self):
        self.browser.quit()
        if self.server:
            self.server.send_signal(signal.SIGINT)
            demand(self.server.wait(10) == 0, "Ctrl-C ends it with", self.server.returncode)
            left = [name for name in os.listdir(self.temporary) if name.startswith("faultsim-")]
            demand(not left, "it leaves", left)
