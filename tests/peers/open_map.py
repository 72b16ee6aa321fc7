"""Opens a map of pillars with VTK's own reader and compares its arrays with the CSV of the same map; reads the GOCAD surfaces as their
format says and compares their vertices.  Usage: pvpython open_map.py FOLDER (with map.csv, map.vtu, map.ts)"""

import csv
import math
import pathlib
import sys
from xml.etree import ElementTree

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def number(text):
    return float(text) if text else math.nan


def same(a, b):
    """To the twelve digits that CSV and TSurf are rounded to."""
    return (math.isnan(a) and math.isnan(b)) or abs(a - b) <= 5e-12 * max(abs(a), abs(b))


def surfaces(path):
    """Vertices (x, y, depth, properties) and triangles of each surface of a TSurf file."""
    found, names = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if line.startswith("GOCAD TSurf"):
            found.append(({}, []))
        elif words and words[0] == "PROPERTIES":
            names = words[1:]
        elif words and words[0] == "PVRTX":
            numbers = [float(word) for word in words[2:]]
            assert len(numbers) == 3 + len(names), line
            found[-1][0][int(words[1])] = numbers
        elif words and words[0] == "TRGL":
            found[-1][1].append([int(word) for word in words[1:]])
    return names, found


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = list(csv.DictReader((folder / "map.csv").open()))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / "map.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfPoints() == 2 * len(rows), grid.GetNumberOfPoints()
    values = grid.GetPointData()
    columns = list(rows[0])[9:]
    assert values.GetNumberOfArrays() == len(columns), values.GetNumberOfArrays()
    for k, column in enumerate(columns):
        array = values.GetArray(k)
        assert column.startswith(array.GetName().split(" [")[0]), (column, array.GetName())
        for i, row in enumerate(rows):
            assert same(array.GetTuple1(2 * i), number(row[column])), (column, row["id"])
    for i, row in enumerate(rows):
        x, y, z = grid.GetPoint(2 * i)
        assert same(x, float(row["x_m"])) and same(y, float(row["y_m"])) and same(-z, float(row["top_depth_m"])), row["id"]
    frames = ElementTree.parse(folder / "map.pvd").getroot().findall("Collection/DataSet")
    years = [float(frame.get("timestep")) for frame in frames]
    assert len(years) > 2 and years == sorted(years), years
    for frame in frames:
        reader.SetFileName(str(folder / frame.get("file")))
        reader.Update()
        grid = reader.GetOutput()
        assert grid.GetNumberOfPoints() == 2 * len(rows), frame.get("file")
        slides = grid.GetPointData().GetArray("slides")
        for i, row in enumerate(rows):
            began = number(row["first_sliding_time_year"])
            assert slides.GetTuple1(2 * i) == (1 if began <= float(frame.get("timestep")) else 0), (frame.get("file"), row["id"])
    names, found = surfaces(folder / "map.ts")
    faults = list(dict.fromkeys(row["fault"] for row in rows))
    assert len(found) == len(faults), (len(found), faults)
    for fault, (vertices, triangles) in zip(faults, found):
        pillars = [row for row in rows if row["fault"] == fault]
        assert len(vertices) == 2 * len(pillars) and len(triangles) == 2 * (len(pillars) - 1), fault
        for i, row in enumerate(pillars):
            at = vertices[2 * i + 1]
            assert same(at[2], float(row["top_depth_m"])), row["id"]
            for k, column in enumerate(columns):
                wanted = number(row[column])
                assert same(at[3 + k], -99999 if math.isnan(wanted) else wanted), (column, row["id"])
        assert all(1 <= corner <= len(vertices) for triangle in triangles for corner in triangle)
    print(f"map: {len(rows)} pillars, {len(columns)} properties and {len(found)} surfaces are the same in CSV, VTU and TSurf, {len(years)} years of PVD agree")


main()
