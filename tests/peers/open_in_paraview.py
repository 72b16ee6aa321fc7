"""Run by `paraview`: pvpython open_in_paraview.py RESULT_FOLDER... in a folder with a mesh/."""

import json
import math
import sys

from paraview import servermanager, simple

READERS = ["chosen by ParaView", "XDMFReader", "Xdmf3ReaderS", "Xdmf3ReaderT"]
FIELDS = {
    "traction_fault": 3, "traction_global": 3, "slip_fault": 3, "slip_global": 3, "critical_index": 1,
    "static_critical_index": 1, "fault_pressure_change": 1, "state": 1, "split": 1, "area": 1,
    "normal": 3, "strike": 3, "dip": 3,
}
failures = 0


def check(holds, what):
    global failures
    if not holds:
        failures += 1
        print("FAILED:", what)


def near(a, b, tolerance=1e-9):
    return abs(a - b) <= tolerance * max(abs(a), abs(b), 1e-12)


def open_with(reader, path):
    if reader == READERS[0]:
        return simple.OpenDataFile(path)
    if reader == "XDMFReader":
        return simple.XDMFReader(FileNames=[path])
    return getattr(simple, reader)(FileName=path)


def blocks(data):
    """The grids of a data set, in order."""
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    found = []
    each = data.NewIterator()
    each.InitTraversal()
    while not each.IsDoneWithTraversal():
        found.append(each.GetCurrentDataObject())
        each.GoToNextItem()
    return found


def numbers(grid, name):
    """Tuples of a point array; None where it is missing."""
    array = grid.GetPointData().GetArray(name)
    if array is None:
        return None
    return [array.GetTuple(k) for k in range(array.GetNumberOfTuples())]


def at_time(source, time):
    source.UpdatePipeline(time)
    return blocks(servermanager.Fetch(source))


def check_fault(where, grid, metrics):
    for name, components in FIELDS.items():
        values = numbers(grid, name)
        if values is None or len(values) != grid.GetNumberOfPoints() or len(values[0]) != components:
            check(False, f"{where}: array {name}")
            return
    slip = [math.hypot(s[1], s[2]) for s in numbers(grid, "slip_fault")]
    area = [a[0] for a in numbers(grid, "area")]
    check(near(max(slip), metrics["max_slip_m"]), f"{where}: largest slip {max(slip)}, {metrics['max_slip_m']}")
    potency = sum(s * a for s, a in zip(slip, area))
    check(near(potency, metrics["potency_m3"], 1e-8), f"{where}: potency {potency}, {metrics['potency_m3']}")
    for local, world in (("traction_fault", "traction_global"), ("slip_fault", "slip_global")):
        frame = [numbers(grid, name) for name in ("normal", "strike", "dip")]
        for k, (a, b) in enumerate(zip(numbers(grid, local), numbers(grid, world))):
            turned = [sum(a[c] * frame[c][k][i] for c in range(3)) for i in range(3)]
            if math.dist(turned, b) > 1e-9 * (1 + math.hypot(*b)):
                check(False, f"{where}: {local} and {world} of point {k}")
                return


def by_position(grid):
    points = [grid.GetPoint(k) for k in range(grid.GetNumberOfPoints())]
    return {tuple(round(x, 6) + 0.0 for x in point): k for k, point in enumerate(points)}


def check_result(folder):
    with open(f"{folder}/result.json") as file:
        result = json.load(file)
    steps = result["steps"]
    names = result["faults"]
    for reader in READERS:
        source = open_with(reader, f"{folder}/faults.xmf")
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues)
        check(times == [step["time_s"] for step in steps], f"{folder} with {reader}: times {times[:3]}...")
        for step in steps:
            grids = at_time(source, step["time_s"])
            check(len(grids) == len(names), f"{folder} with {reader}: {len(grids)} faults")
            for name, grid, metrics in zip(names, grids, step["faults"]):
                check_fault(f"{folder} with {reader}, step {step['step']}, {name}", grid, metrics)
        simple.Delete(source)
        volume = open_with(reader, f"{folder}/volume.xmf")
        volume.UpdatePipelineInformation()
        ends = list(volume.TimestepValues)
        check(len(ends) >= 3, f"{folder} with {reader}: {len(ends)} volumes")
        for time in ends:  # the observation point of the scene, above the centre
            grid = at_time(volume, time)[0]
            shown = (numbers(grid, "displacement") or [()] * grid.GetNumberOfPoints())[grid.FindPoint(0, 0, 0)]
            observed = next(step["observed_m"] for step in steps if step["time_s"] == time)
            # A field without observation points has nothing to compare with; its displacement is there.
            check(len(shown) == 3 and (not result["observations"] or math.dist(shown, observed) < 1e-9),
                  f"{folder} with {reader}: displacement {shown}, observed {observed}")
        simple.Delete(volume)
        print(f"{folder}: {reader} shows {len(times)} times of {len(names)} faults, {len(ends)} volumes")


def check_halves():
    """Half the domain and the whole, point by point, at every time."""
    half, whole = simple.XDMFReader(FileNames=["half/faults.xmf"]), simple.XDMFReader(FileNames=["whole/faults.xmf"])
    half.UpdatePipelineInformation()
    compared = worst = 0
    for time in half.TimestepValues:
        for one, other in zip(at_time(half, time), at_time(whole, time)):
            place = by_position(one)
            check(len(place) == other.GetNumberOfPoints(), "half and whole have different points")
            for name in FIELDS:
                a, b = numbers(one, name), numbers(other, name)
                size = max(math.hypot(*x) for x in b) or 1
                for position, k in by_position(other).items():
                    worst = max(worst, math.dist(a[place[position]], b[k]) / size)
                    compared += 1
    check(worst < 1e-6, f"half and whole differ by {worst}")
    print(f"half against whole: {compared} values, largest difference {worst:.1e} of the largest value")


for name in sys.argv[1:]:
    check_result(name)
check_halves()
mesh = blocks(servermanager.Fetch(simple.OpenDataFile("mesh/volume.xmf")))
check(mesh[0].GetNumberOfCells() > 1000 and mesh[0].GetCellData().GetArray("material"), "mesh/volume.xmf")
sys.exit(1 if failures else 0)
