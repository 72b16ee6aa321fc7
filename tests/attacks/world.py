"""What the attacks on the world of the programs share: kills, damage, limits, full disks.

A script of this folder is given the folder of the binaries, attacks them, and ends with 0 if every
attack ended as it may: with the numbers of an undisturbed campaign, or with a refusal that says what
to do. `--all` is the study, without it a short version; `--record FILE` writes its table there.
"""
import argparse
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
EXIT = {0: "done", 1: "done, some cases failed", 2: "input", 4: "world", 75: "interrupted"}
CURES = ("restore a backup", "choose another", "run again", "submit again", "submit SPEC", "at least", "or more",
         "larger cells", "predicted to need", "free some space", "free space", "wait for it", "--verify",
         "migrate it")


class World:
    """A folder, the programs and what went wrong."""

    def __init__(self, about):
        parser = argparse.ArgumentParser(description=about)
        parser.add_argument("binaries")
        parser.add_argument("--all", action="store_true", help="the study, not the short version")
        parser.add_argument("--seed", type=int, default=14)
        parser.add_argument("--record", help="file that the table is written to")
        self.options = parser.parse_args()
        self.bin = os.path.abspath(self.options.binaries)
        self.dice = random.Random(self.options.seed)
        self.folder = tempfile.mkdtemp(prefix="attack-")
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith(("FAULT", "OPENBLAS"))}
        self.environment["XDG_CACHE_HOME"] = os.path.join(self.folder, "cache")
        self.failures = []
        self.rows = []
        self.started = time.time()

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def command(self, program, *words):
        return [os.path.join(self.bin, program), *map(str, words)]

    def run(self, program, *words, limit=None, patience=300, cwd=None):
        """Ends with (exit code, 128 + n for signal n, None = had to be killed; stdout; stderr)."""
        with open(self.path("out"), "w+b") as out, open(self.path("err"), "w+b") as err:
            child = subprocess.Popen(self.command(program, *words), stdout=out, stderr=err,
                                     stdin=subprocess.DEVNULL, env=self.environment, preexec_fn=limit,
                                     start_new_session=True, cwd=cwd or self.folder)
            try:
                code = child.wait(patience)
                code = code if code >= 0 else 128 - code
            except subprocess.TimeoutExpired:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()
                code = None
            out.seek(0)
            err.seek(0)
            return code, out.read().decode(errors="replace"), err.read().decode(errors="replace")

    def write_spec(self, n_angles, name="field", policy=None):
        """A campaign of two families in plane strain: milliseconds per case."""
        spec = {"format": 1, "name": name, "base": os.path.join(ROOT, "docs/examples/scenes/rotliegend.json"),
                "set": {"/tier": "custom", "/mesh": {"dip": "25 m", "normal": "25 m"},
                        "/numerics/plane_strain": "on", "/numerics/activation_length": "100 m"},
                "design": {"kind": "grid", "parameters": {
                    "offset": ["0 m", "100 m"],
                    "friction_angle": {"from": "15 deg", "to": "30 deg", "count": n_angles}}}}
        if policy:
            spec["policy"] = policy
        path = self.path(name + ".json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(spec, file)
        return path

    def must(self, program, *words):
        code, out, err = self.run(program, *words)
        if code != 0:
            sys.exit(f"{program} {' '.join(map(str, words))} ended with {code}: {err}")
        return out

    def fail(self, what):
        self.failures.append(what)
        print("FAILED:", what, flush=True)

    def row(self, *cells):
        self.rows.append([str(cell).replace(self.bin + "/", "").replace(self.folder, "") for cell in cells])
        print(" | ".join(self.rows[-1]), flush=True)

    def finish(self, title, columns, summary):
        shutil.rmtree(self.folder, ignore_errors=True)
        text = (f"## {title}\n\n{summary}\n\n| " + " | ".join(columns) + " |\n|" + "---|" * len(columns) + "\n" +
                "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in self.rows))
        if self.options.record:
            with open(self.options.record, "w", encoding="utf-8") as file:
                file.write(text)
        print(f"{title}: {summary} {time.time() - self.started:.0f} s, {len(self.failures)} failed")
        sys.exit(1 if self.failures else 0)


def query(store, sql):
    with sqlite3.connect(f"file:{store}/campaign.sqlite?mode=ro", uri=True, timeout=10) as database:
        return database.execute(sql).fetchall()


def numbers(store):
    """All numbers of all cases, in an order that does not depend on who ran what."""
    return [query(store, sql) for sql in (
        "SELECT * FROM stage_ranking ORDER BY 1, 2, 3",
        "SELECT * FROM ranking ORDER BY 1, 2",
        "SELECT * FROM chi_history_wide ORDER BY 1, 2, 7, 3")]


def n_done(store):
    return query(store, "SELECT count(*) FROM runs WHERE status = 'completed' AND NOT fields_only")[0][0]


def last_line(text):
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else ""


def children(pid):
    found = []
    try:
        for task in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{task}/children", encoding="ascii") as file:
                found += [int(word) for word in file.read().split()]
    except OSError:
        pass
    return found
