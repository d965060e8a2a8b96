"""Python values as TOML. Numbers keep their text: 0.1 means one tenth, as in a system file."""

import decimal
import fractions
import json
import math
import numbers

from .errors import InputError


def value(thing, key=""):
    """One value in TOML: numbers, exact text, lists, dictionaries. `key`: whose it is."""
    if hasattr(thing, "tolist"):  # NumPy's numbers and arrays
        thing = thing.tolist()
    if isinstance(thing, bool):
        return "true" if thing else "false"
    if isinstance(thing, str):
        return json.dumps(thing, ensure_ascii=False)
    if isinstance(thing, numbers.Integral):
        return str(int(thing))
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
        return "{ " + ", ".join(f"{name} = {value(one, key)}" for name, one in thing.items()) + " }"
    if isinstance(thing, (list, tuple)) or hasattr(thing, "__iter__"):
        items = [value(one, key) for one in thing]
        # A line each: the place of a number is found by counting along its line.
        rows = any(item.startswith("[") for item in items)
        return "[" + (",\n" if rows else ", ").join(items) + "]"
    raise InputError(
        f"'{key}' cannot be {thing!r}", ("", 0, 0, key), "numbers, text, lists or dictionaries"
    )


def bare(thing, key=""):
    """A number or exact text as it is written in a list of the command line: 1/3, 0.5."""
    text = value(thing, key)
    return json.loads(text) if text.startswith('"') else text


def section(name, entries, array=False):
    """A section with its header; entries that are None are left out."""
    head = f"[[{name}]]" if array else f"[{name}]"
    lines = [f"{key} = {value(one, key)}" for key, one in entries.items() if one is not None]
    return "\n".join([head, *lines]) + "\n"
