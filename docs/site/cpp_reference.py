"""The reference of the public headers, from their comments as Doxygen reads them."""

import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

from rst import description, indented, title


def headers_of(root):
    """{module: [headers as they are included]}"""
    modules = {}
    for folder in (root / "include", root / "geometry" / "include"):
        for header in sorted(folder.rglob("*.hpp")):
            name = header.relative_to(folder)
            if len(name.parts) > 2 and name.parts[1] != "maps":
                modules.setdefault(name.parts[1], []).append(str(name))
    return modules


def text_of(node, tag):
    found = node.find(tag)
    return " ".join("".join(found.itertext()).split()) if found is not None else ""


def said(node):
    return description(node.find("briefdescription")) + description(node.find("detaileddescription"))


def template_of(node):
    """'template<class T> ' of a declaration, or ''."""
    listed = node.find("templateparamlist")
    if listed is None:
        return ""
    each = []
    for one in listed.findall("param"):
        default = text_of(one, "defval")
        name = text_of(one, "declname")
        each.append(f"{text_of(one, 'type')} {name}".strip() + (f" = {default}" if default else ""))
    return f"template<{', '.join(each)}> "


def entry(name, declaration, content):
    """A declaration and what is said of it. (Sphinx could parse declarations and link the names in
    them; for this library that takes minutes.)"""
    shown = declaration.replace("\\", "\\\\")
    return f".. index:: single: {name} (C++)\n\n.. describe:: {shown}\n\n{indented(content)}\n"


def member(node, scope):
    """The entry of a function, variable, type or enumeration."""
    kind, name = node.get("kind"), text_of(node, "name")
    # Members of templates are declared with the template's arguments.
    declared = re.sub(r"< \w+ >::", "::", text_of(node, "definition")).replace(f"{scope}::", "")
    declared = re.sub(r"\btypedef ", "", declared)
    if kind == "function":
        clause = text_of(node, "requiresclause")
        declared += text_of(node, "argsstring") + (f" requires {clause}" if clause else "")
        if node.get("explicit") == "yes" and not declared.startswith("explicit"):
            declared = "explicit " + declared
    elif kind == "variable":
        value = text_of(node, "initializer")
        declared += f" {value}" if value and len(value) < 60 else ""
    elif kind == "enum":
        declared = ("enum class " if node.get("strong") == "yes" else "enum ") + name
        values = "".join(
            entry(text_of(value, "name"), text_of(value, "name"), said(value))
            for value in node.findall("enumvalue")
        )
        return entry(name, declared, said(node) + values)
    elif kind != "typedef":
        return ""
    return entry(name, template_of(node) + declared, said(node))


class Comments:
    """What Doxygen found, by header."""

    def __init__(self, folder):
        self.folder = folder
        self.files, self.places = {}, {}
        self.classes = {}
        for one in xml.parse(folder / "index.xml").getroot():
            if one.get("kind") in ("struct", "class", "union", "namespace", "file", "concept"):
                compound = xml.parse(folder / f"{one.get('refid')}.xml").find("compounddef")
                self.take(compound)

    def take(self, compound):
        kind, name = compound.get("kind"), text_of(compound, "compoundname")
        where = compound.find("location").get("file")
        if kind == "file":
            self.files[where] = compound
        elif kind == "namespace":
            for node in compound.iter("memberdef"):
                place = node.find("location")
                self.put(place, member(node, name))
        else:
            self.classes[name] = compound

    def put(self, place, text):
        self.places.setdefault(place.get("file"), []).append((int(place.get("line")), text))

    def put_classes(self):
        for name, compound in self.classes.items():
            scope = name.rpartition("::")[0]
            if scope not in self.classes:
                self.put(compound.find("location"), self.class_text(name, scope))

    def class_text(self, name, scope):
        compound = self.classes[name]
        short = name.removeprefix(f"{scope}::")
        content = said(compound)
        for inner in compound.findall("innerclass"):
            if inner.get("prot") == "public" and inner.text in self.classes:
                content += self.class_text(inner.text, name)
        for node in compound.iter("memberdef"):
            if node.get("prot") == "public" and node.get("kind") != "friend":
                content += member(node, name)
        bases = [f"public {''.join(b.itertext())}" for b in compound.findall("basecompoundref")]
        declared = f"{template_of(compound)}{compound.get('kind')} {short}"
        return entry(short, declared + (f" : {', '.join(bases)}" if bases else ""), content)

    def page(self, header):
        about = self.files.get(header)
        text = said(about) if about is not None else ""
        return text + "".join(one for _, one in sorted(self.places.get(header, [])))


def write(stage, root, doxygen):
    """A page a module of the library, a section a header."""
    shutil.rmtree(doxygen, ignore_errors=True)
    doxygen.mkdir(parents=True)
    subprocess.run(["doxygen", "docs/Doxyfile"], cwd=root, check=True)
    # Members may speak for themselves; a class without a word is told of.
    for line in (doxygen / "warnings.txt").read_text(encoding="utf-8").splitlines():
        if "Compound" in line:
            print(line, file=sys.stderr)
    comments = Comments(doxygen / "xml")
    comments.put_classes()
    modules = headers_of(root)
    for module, headers in modules.items():
        text = title(f"C++: {module}")
        for header in headers:
            text += title(f"<{header}>", "-") + comments.page(header)
        stage.write(f"reference/cpp/{module}.rst", text)
    text = title("C++ reference")
    text += (
        "The public headers, a page for each folder. ``#include <carom/carom.hpp>`` includes all of\n"
        "them; ``find_package(carom)`` gives the targets ``carom::carom`` and ``carom::geometry``.\n"
        "All names are in the namespace ``carom``, those of ``<carom/geometry/…>`` in\n"
        "``carom::geometry``.\n\n.. toctree::\n   :maxdepth: 1\n\n"
    )
    text += "".join(f"   cpp/{module}\n" for module in sorted(modules)) + "\n"
    for example in sorted((root / "examples").glob("*.cpp")):
        goal = stage.place(example)
        (stage.folder / goal).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(example, stage.folder / goal)
        text += title(f"examples/{example.name}", "-")
        text += f".. literalinclude:: /{goal}\n   :language: c++\n\n"
    stage.write("reference/cpp.rst", text)
