#!/usr/bin/env python3
"""Every scene that comes along agrees with the JSON Schema, and a few wrong ones do not. Skipped (77) without python3-jsonschema."""
import copy
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not there")
    sys.exit(77)

root = pathlib.Path(sys.argv[1])
schema = json.loads((root / "docs/scene.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
failures = 0


def expect(name, scene, right):
    global failures
    errors = list(validator.iter_errors(scene))
    if bool(errors) == right:
        failures += 1
        print(f"{name}: {errors[0].message if errors else 'is accepted'}")


scenes = [path for folder in ("scenes", "scenes/bench", "scenes/tiny") for path in sorted((root / folder).glob("*.json"))]
for path in scenes:
    expect(path.name, json.loads(path.read_text()), True)
effects = sorted((root / "scenes/effects").glob("*.json")) + sorted((root / "scenes/assets").glob("effect-*.json"))
scene_validator, validator = validator, jsonschema.Draft202012Validator(json.loads((root / "docs/effect.schema.json").read_text()))
for path in effects:
    expect(path.name, json.loads(path.read_text()), True)
expect("a scene is no effect", json.loads(scenes[0].read_text()), False)
validator = scene_validator
base = json.loads((root / "scenes/tiny/all.json").read_text())
for name, change in {
    "unknown key": lambda s: s.update(emiters=[]),
    "key of another type": lambda s: s["lights"][1].update(inner=3),
    "out of range": lambda s: s["medium"].update(g=1),
    "no type": lambda s: s["forces"][0].pop("type"),
    "missing key": lambda s: s["lights"][0].pop("direction"),
    "two numbers": lambda s: s["lights"][0].update(direction=[1, 2]),
    "too many": lambda s: s.update(lights=s["lights"] * 3),
    "half a particle": lambda s: s["sim"].update(capacity=1.5),
}.items():
    scene = copy.deepcopy(base)
    change(scene)
    expect(name, scene, False)
print(f"{len(scenes)} scenes, {len(effects)} effects, {failures} failures")
sys.exit(1 if failures else 0)
