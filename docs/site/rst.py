"""Pieces of reStructuredText."""

import re


def title(text, mark="="):
    return f"{text}\n{mark * len(text)}\n\n"


def escaped(text):
    return re.sub(r"([\\*`_|])", r"\\\1", text)


def indented(text, by=3):
    return "".join(" " * by + line if line.strip() else line for line in text.splitlines(True))


def inline(node):
    """The text of a paragraph of Doxygen's XML."""
    parts = [escaped(node.text or "")]
    for child in node:
        if child.tag == "computeroutput":
            parts.append(rf"\ ``{''.join(child.itertext())}``\ ")
        elif child.tag in ("emphasis", "bold"):
            mark = "*" if child.tag == "emphasis" else "**"
            parts.append(rf"\ {mark}{escaped(''.join(child.itertext()))}{mark}\ ")
        else:
            parts.append(inline(child))
        parts.append(escaped(child.tail or ""))
    return "".join(parts)


# What stands on its own inside a paragraph of Doxygen's XML.
BLOCKS = ("itemizedlist", "orderedlist", "verbatim", "preformatted", "programlisting", "simplesect",
          "parameterlist", "table")  # fmt: skip


def paragraph(node):
    text, loose = "", node.text or ""
    pending = [escaped(loose)]

    def flush():
        done = " ".join("".join(pending).split())
        pending.clear()
        return f"{done}\n\n" if done else ""

    for child in node:
        if child.tag in BLOCKS:
            text += flush() + block(child)
        else:
            holder = type(node)("para")
            copy = type(node)(child.tag, child.attrib)
            copy.text = child.text
            copy.extend(child)
            holder.append(copy)
            pending.append(inline(holder))
        pending.append(escaped(child.tail or ""))
    return text + flush()


def block(node):
    if node.tag in ("itemizedlist", "orderedlist"):
        mark = "- " if node.tag == "itemizedlist" else "#. "
        return "".join(
            mark + indented(description(item), len(mark)).lstrip() for item in node.findall("listitem")
        ) + "\n"
    if node.tag in ("verbatim", "preformatted", "programlisting"):
        lines = node.findall("codeline")
        text = "".join(node.itertext())
        if lines:
            for space in node.iter("sp"):
                space.text = " "
            text = "\n".join("".join(line.itertext()) for line in lines)
        return "::\n\n" + indented(text.strip("\n") + "\n") + "\n"
    if node.tag == "parameterlist":
        return "".join(
            f"- ``{''.join(item.find('parameternamelist').itertext()).strip()}``: "
            + indented(description(item.find("parameterdescription")), 2).lstrip()
            for item in node.findall("parameteritem")
        ) + "\n"
    lead = {"return": "Returns: ", "note": "Note: ", "see": "See "}.get(node.get("kind"), "")
    return lead + "".join(description(node))


def description(node):
    """A description of Doxygen's XML: its paragraphs."""
    return "".join(paragraph(para) for para in node.findall("para")) if node is not None else ""
