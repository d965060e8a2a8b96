"""Python values as TOML. Numbers keep their text: 0.1 means one tenth, as in a system file."""

import decimal
import fractions
import json
import math
import numbers
import re

from .errors import InputError, text_of


MOST_LEVELS = 32  # of lists and dictionaries in each other; the reader takes 64 with its own


def value(thing, key="", levels=0):
    """One value in TOML: numbers, exact text, lists, dictionaries. `key`: whose it is."""
    if levels > MOST_LEVELS:
        raise InputError(f"'{key}' is nested too deeply", ("", 0, 0, key), f"at most {MOST_LEVELS} levels")
    if hasattr(thing, "tolist"):  # NumPy's numbers and arrays
        thing = thing.tolist()
    if isinstance(thing, bool):
        return "true" if thing else "false"
    if isinstance(thing, str):
        return quoted(text_of(thing, key))
    if isinstance(thing, numbers.Integral):
        # TOML's integers have 64 bits. A text is an exact number, too.
        whole = str(int(thing))
        return whole if abs(int(thing)) < 2**63 else json.dumps(whole)
    if isinstance(thing, fractions.Fraction):
        return json.dumps(f"{thing.numerator}/{thing.denominator}")
    if isinstance(thing, decimal.Decimal):
        return json.dumps(format(thing, "f"))
    if isinstance(thing, numbers.Real):
        thing = float(thing)
        if math.isfinite(thing):
            return repr(thing)
        return "nan" if math.isnan(thing) else "inf" if thing > 0 else "-inf"
    if isinstance(thing, dict):
        entries = (f"{name_of(name, key)} = {value(one, key, levels + 1)}" for name, one in thing.items())
        return "{ " + ", ".join(entries) + " }"
    if isinstance(thing, (list, tuple)) or hasattr(thing, "__iter__"):
        items = [value(one, key, levels + 1) for one in thing]
        # A line each: the place of a number is found by counting along its line.
        rows = any(item.startswith("[") for item in items)
        return "[" + (",\n" if rows else ", ").join(items) + "]"
    if callable(thing):
        raise InputError(
            f"'{key}' cannot be a Python function: forces are computed in C++, with the same bits everywhere. Type a"
            ' formula: potential={"kind": "expression", "expression": "k*x^2/2", "parameters": {"k": 2}}',
            ("", 0, 0, key), "a formula as text",
        )  # fmt: skip
    raise InputError(
        f"'{key}' cannot be {thing!r}", ("", 0, 0, key), "numbers, text, lists or dictionaries"
    )


def quoted(text):
    """A text in quotes. TOML takes the escapes of JSON, and wants one more."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def name_of(key, of=""):
    """A key as it is written."""
    key = text_of(key, of)
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else quoted(key)


def bare(thing, key=""):
    """A number or exact text as it is written in a list of the command line: 1/3, 0.5."""
    text = value(thing, key)
    return json.loads(text) if text.startswith('"') else text


def section(name, entries, array=False):
    """A section with its header; entries that are None are left out."""
    if not isinstance(entries, dict):
        raise InputError(f"'{name}' cannot be {entries!r}", ("", 0, 0, name), "a dictionary of its keys")
    head = f"[[{name}]]" if array else f"[{name}]"
    lines = [f"{name_of(key, name)} = {value(one, key)}" for key, one in entries.items() if one is not None]
    return "\n".join([head, *lines]) + "\n"
