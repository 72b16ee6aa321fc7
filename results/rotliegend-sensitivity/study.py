"""What the scripts of this folder share: cases of a campaign as rows, pairs of them, rank correlations, tables."""

import csv
import subprocess

STAGES = {"production": "primary_production", "cushion gas": "cushion_gas_injection", "storage": "gas_storage"}
MEASURES = {"slides": "slides", "area": "activated_area", "slip": "max_slip", "critical": "area_chi_080", "chi": "chi_bar",
            "sure": "activation_resolved"}
# What a case has of a parameter that its group does not vary; "base" is the same.
BASE = {"offset": "0 m", "biot": "1", "central_dip": "0 deg", "stress_ratios": "0.74, 0.83", "reservoir_stiffness_factor": "1",
        "caprock_stiffness_factor": "1", "pressures": "200 bar", "scale_east": "1", "friction_angle": "30 deg", "cohesion": "0 MPa",
        "fault_pressure": "mean", "salt": "elastic", "west_less_east": "0 bar"}
GROUPS = {"about 200 m, 20 deg and creeping salt": {"offset": "200 m", "friction_angle": "20 deg", "salt": "1e17 Pa s"},
          "uneven at the same mean depletion": {"pressures": "130 bar"}}


def sweep(bin, store, *words):
    return subprocess.run([bin / "faultsweep", *words, "--store", store], stdout=subprocess.PIPE, text=True, check=True).stdout


def read_cases(bin, store, campaign, faults=()):
    """Its table as text, and its cases with a result: per measure and stage a number, case["area", "storage"]; of a fault, case["chi", "F2", "storage"]."""
    scopes = {(m, s): f"{MEASURES[m]} in {STAGES[s]}" for m in MEASURES for s in STAGES}
    scopes |= {(m, f, s): f"{f}.{MEASURES[m]} in {STAGES[s]}" for m in MEASURES for f in faults for s in STAGES}
    text = sweep(bin, store, "export", campaign, "--metrics", "activation_step,unexpected," + ",".join(scopes.values()))
    cases = []
    for row in csv.DictReader(text.splitlines()):
        if row["outcome"] not in ("converged", "event"):
            continue
        for key, scope in scopes.items():
            metric, stage = scope.split(" in ")
            row[key] = float(next(v for k, v in row.items() if isinstance(k, str) and k.startswith(metric) and k.endswith("_in_" + stage) or
                                  isinstance(k, str) and k.startswith(f"{metric}_in_{stage}")))
        for name, value in {**BASE, **GROUPS.get(row["group"], {})}.items():
            if row.get(name) in ("", "base", None):
                row[name] = value
        cases.append(row)
    return text, cases


def pairs(cases, parameter, a, b):
    """Cases that differ in `parameter` alone, which is a in the one and b in the other."""
    key = lambda case: tuple(case[n] for n in BASE if n != parameter)
    other = {key(case): case for case in cases if case[parameter] == b}
    return [(case, other[key(case)]) for case in cases if case[parameter] == a and key(case) in other]


def rank_correlation(x, y):
    def ranks(values):
        order = sorted(values)
        return [(order.index(v) + len(order) - 1 - order[::-1].index(v)) / 2 for v in values]
    rx, ry = ranks(x), ranks(y)
    mx, my = sum(rx) / len(rx), sum(ry) / len(ry)
    dot = sum((a - mx) * (b - my) for a, b in zip(rx, ry))
    return dot / (sum((a - mx) ** 2 for a in rx) * sum((b - my) ** 2 for b in ry)) ** 0.5


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"
