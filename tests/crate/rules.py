"""Requirements ("MUST") of RO-Crate 1.1 and Process Run Crate 0.5 for a crate in a directory.

    rules.py DIR...            prints what is violated; the exit code is 1 if anything is
    rules.py --refuses DIR     whether each rule finds its violation in a spoilt copy of the crate

The rules are written from the two specifications, not from the program that writes the crates:
https://www.researchobject.org/ro-crate/1.1/ and https://www.researchobject.org/workflow-run-crate/profiles/0.5/.
"""

import copy
import datetime
import hashlib
import json
import sys
from pathlib import Path
from urllib.parse import unquote, urlparse

NAME = "ro-crate-metadata.json"
PROCESS = "https://w3id.org/ro/wfrun/process/"
ACTIONS = {"CreateAction", "ActivateAction", "UpdateAction"}
TOOLS = {"SoftwareApplication", "SoftwareSourceCode", "ComputationalWorkflow"}
DATA = {"File", "Dataset"}
CONTEXT_TERMS = {
    "about", "conformsTo", "contentSize", "datePublished", "description", "encodingFormat", "endTime", "hasPart",
    "instrument", "license", "mentions", "name", "object", "result", "softwareVersion", "version",
}  # of the RO-Crate 1.1 context, as far as the crates use them


def listed(value):
    return value if isinstance(value, list) else [] if value is None else [value]


def types(entity):
    return set(listed(entity.get("@type")))


def is_date(text):
    try:
        datetime.datetime.fromisoformat(text.replace("Z", "+00:00"))
        return True
    except (AttributeError, ValueError):
        return False


def violations(crate, directory):
    """Each violated requirement as a text."""
    if not isinstance(crate.get("@graph"), list):
        yield "@graph is a flat list of entities"
        return
    contexts = listed(crate.get("@context"))
    if "https://w3id.org/ro/crate/1.1/context" not in contexts:
        yield "the @context is that of RO-Crate 1.1"
    graph = crate["@graph"]
    entities = {entity.get("@id"): entity for entity in graph}
    if None in entities or any(not types(entity) for entity in graph):
        yield "every entity has @id and @type"
    if len(entities) != len(graph):
        yield "an @id occurs once"
    terms = set().union(*(context for context in contexts if isinstance(context, dict))) | CONTEXT_TERMS
    for entity in graph:
        for key, value in entity.items():
            if not key.startswith("@") and key not in terms:
                yield f"the key {key} is a term of the context"
            for part in listed(value):
                if isinstance(part, dict) and set(part) != {"@id"}:
                    yield f"{key} is flattened: a reference has an @id and nothing else"

    def referenced(entity, key):
        return [entities.get(part["@id"], {}) for part in listed(entity.get(key)) if isinstance(part, dict)]

    descriptor = entities.get(NAME, {})
    if "CreativeWork" not in types(descriptor):
        yield f"{NAME} is described as a CreativeWork"
    if descriptor.get("conformsTo") != {"@id": "https://w3id.org/ro/crate/1.1"}:
        yield f"{NAME} conforms to RO-Crate 1.1"
    about = referenced(descriptor, "about")
    root = about[0] if about else {}
    if len(about) != 1 or "Dataset" not in types(root) or not root.get("@id", "").endswith("/"):
        yield f"{NAME} is about one Dataset, the root, with an @id that ends with a slash"
    for key in ("name", "description", "license"):
        if not root.get(key):
            yield f"the root has a {key}"
    if not is_date(root.get("datePublished")):
        yield "datePublished of the root is an ISO 8601 date"

    linked, waiting = set(), [root]
    while waiting:
        for part in referenced(waiting.pop(), "hasPart"):
            if part.get("@id") not in linked:
                linked.add(part.get("@id"))
                waiting.append(part)
    for name, entity in entities.items():
        if not types(entity) & DATA or entity is root:
            continue
        if name not in linked:
            yield f"the data entity {name} is linked from the root by hasPart"
        if urlparse(name).scheme:
            continue
        if not (directory / unquote(name)).exists():
            yield f"the file {name} is there"
        elif "sha256" in entity:
            if hashlib.sha256((directory / unquote(name)).read_bytes()).hexdigest() != entity["sha256"]:
                yield f"the sha256 of {name} is that of the file"
    for name in linked:
        if name not in entities or not types(entities[name]) & DATA:
            yield f"the part {name} is described as a File or Dataset"

    profiles = referenced(root, "conformsTo")
    if not any(p.get("@id", "").startswith(PROCESS) and "CreativeWork" in types(p) for p in profiles):
        yield "the root conforms to a version of Process Run Crate, described as a CreativeWork"
    actions = [entity for entity in graph if types(entity) & ACTIONS]
    if not actions:
        yield "an action describes the execution"
    for action in actions:
        tools = referenced(action, "instrument")
        if not tools or any(not types(tool) & TOOLS for tool in tools):
            yield "instrument of an action is the executed tool, described as software"
        for key in ("object", "result"):
            if any(not part for part in referenced(action, key)):
                yield f"{key} of an action is described"
        if not is_date(action.get("endTime")):
            yield "endTime of an action is an ISO 8601 date"


def spoilt(crate):
    """Copies of a valid crate with one fault each."""

    def change(name, key, value):
        copied = copy.deepcopy(crate)
        entity = copied if name is None else next(e for e in copied["@graph"] if e["@id"] == name)
        if value is None:
            del entity[key]
        else:
            entity[key] = value
        return f"{name} {key}", copied

    tool = next(e["@id"] for e in crate["@graph"] if "SoftwareApplication" in types(e))
    part = next(e["@id"] for e in crate["@graph"] if "File" in types(e))
    yield change(None, "@context", "https://schema.org")
    yield change(None, "@graph", {})
    yield change(NAME, "conformsTo", {"@id": "https://w3id.org/ro/crate/0.9"})
    yield change(NAME, "about", {"@id": part})
    yield change(NAME, "@type", "File")
    for key in ("name", "description", "license", "datePublished", "conformsTo", "hasPart"):
        yield change("./", key, None)
    yield change("./", "datePublished", "yesterday")
    yield change("./", "mentioned", "x")
    yield change("#run", "instrument", {"@id": part})
    yield change("#run", "result", [{"@id": "other.csv"}])
    yield change("#run", "endTime", "later")
    yield change("#run", "@type", "Thing")
    yield change("#run", "object", {"@id": part, "name": "nested"})
    yield change(tool, "@type", None)
    yield change(part, "sha256", "0" * 64)
    yield change(part, "@id", "other.csv")
    yield change(part, "@id", tool)


def main(words):
    refuses = words[0] == "--refuses"
    faults = count = 0
    for word in words[refuses:]:
        directory = Path(word)
        crate = json.loads((directory / NAME).read_text())
        for name, one in spoilt(crate) if refuses else [(word, crate)]:
            found = list(violations(one, directory))
            count += 1
            if bool(found) != refuses:
                faults += 1
                print(f"{name}: accepted" if refuses else "\n".join(f"{word}: violated: {f}" for f in found))
    print(f"{count - faults} of {count} crates {'refused' if refuses else 'valid'}")
    return 1 if faults else 0


sys.exit(main(sys.argv[1:]))
