"""Holds every message of the transcripts in a folder against the schema that debugpy ships.

Of a message the most particular definition counts: a response by its command, an event by its name.
"""

import json
import sys
from pathlib import Path

import debugpy
import jsonschema


def definition(message):
    """The name of what a message must be."""
    if message["type"] == "event":
        name = message["event"]
        return name[0].upper() + name[1:] + "Event"
    if not message["success"]:
        return "ErrorResponse"
    name = message["command"]
    return name[0].upper() + name[1:] + "Response"


def main(folder):
    schema = json.loads(next(Path(debugpy.__file__).parent.rglob("debugProtocol.json")).read_text())
    known = schema["definitions"]
    validators = {}
    count, kinds = 0, set()
    for path in sorted(Path(folder).glob("*.jsonl")):
        last = 0
        for number, line in enumerate(path.read_text().splitlines(), 1):
            message = json.loads(line)
            name = definition(message)
            assert name in known, f"{path.name}:{number}: the protocol has no {name}"
            if name not in validators:
                rule = {"$ref": f"#/definitions/{name}", "definitions": known}
                validators[name] = jsonschema.Draft4Validator(rule)
            for error in validators[name].iter_errors(message):
                sys.exit(f"{path.name}:{number}: {name}: {error.message}\n{line}")
            assert message["seq"] == last + 1, f"{path.name}:{number}: seq {message['seq']}"
            last = message["seq"]
            count += 1
            kinds.add(name)
    assert count > 100, f"only {count} messages: run `cargo test --test dap` first"
    print(f"{count} messages of {len(kinds)} kinds are as the protocol wants them")


main(sys.argv[1])
