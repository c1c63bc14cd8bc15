"""The schema of decks before Python's validator: every good deck passes, and bad decks whose fault is one of form do not.

Usage: peridyne schema | python schema.py DECKS     (the folder with good and bad)
Needs: pip install jsonschema, Python 3.11
"""

import json
import pathlib
import sys
import tomllib

import jsonschema

# what the reader says of keys, types and names that are wrong, and not of what keys mean together
FORM = ["unknown key", "is not known here", "the key `material` is missing", "the key `law` is missing", "the key `radius`", "a whole number", "found string", "found boolean",
        "a list of tables", "needs its constants"]


def decks(folder):
    for path in sorted(folder.glob("*.toml")):
        text = path.read_text()
        try:
            yield path, text, tomllib.loads(text)
        except tomllib.TOMLDecodeError:
            pass


schema = json.load(sys.stdin)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
folder = pathlib.Path(sys.argv[1])
good = [(path, next(validator.iter_errors(deck), None)) for path, _, deck in decks(folder / "good")]
for path, error in good:
    assert error is None, f"{path}: {error}"
refused = 0
for path, text, deck in decks(folder / "bad"):
    expected = text.splitlines()[0]
    if any(part in expected for part in FORM):
        # a whole number with a point is one to JSON
        if path.name != "steps_with_exponent.toml":
            assert not validator.is_valid(deck), f"{path} passed: {expected}"
            refused += 1
assert refused >= 10, refused
print(f"{len(good)} good decks pass, {refused} bad ones of wrong form do not")
