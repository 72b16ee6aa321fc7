"""Inputs of the programs that attacks change: scenes and specs as documents."""
import json
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def scene(**changes):
    """The starter box with values put at pointers ('/a/0/b': value)."""
    return changed(json.loads((ROOT / 'simulator/reading/starter_box.json').read_text()), changes)


def field(**changes):
    return changed(json.loads((ROOT / 'docs/examples/scenes/rotliegend.json').read_text()), changes)


def changed(document, changes):
    for pointer, value in changes.get('at', {}).items():
        place = document
        *above, last = pointer[1:].split('/')
        for key in above:
            place = place[int(key)] if isinstance(place, list) else place.setdefault(key, {})
        if isinstance(place, list):
            place[int(last)] = value
        elif value is None:
            del place[last]
        else:
            place[last] = value
    return document


def spec(design, **more):
    return {'format': 1, 'name': 'attack', 'base': 'field.json', 'set': {'/tier': 'screening'}, 'design': design, **more}


OFFSETS = {'kind': 'grid', 'parameters': {'offset': ['0 m', '100 m']}}


def nested_groups(depth):
    if depth == 0:
        return OFFSETS
    return {'kind': 'groups', 'groups': [{'name': name, 'design': nested_groups(depth - 1)} for name in 'ab']}


def flow(table, key='/pressure_field'):
    return changed(json.loads((ROOT / 'docs/examples/flow/field.json').read_text()), {'at': {'/pressure_field': {'file': 'sound.csv'}, key: {'file': table}}})
