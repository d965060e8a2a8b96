"""Packs a folder as a wheel (PEP 427): wheel.py FOLDER TARGET VERSION TAG SOURCE"""

import base64
import hashlib
import pathlib
import sys
import zipfile

folder, target, version, tag, source = sys.argv[1:]
information = f"carom-{version}.dist-info"
texts = {
    "METADATA": f"""Metadata-Version: 2.1
Name: carom
Version: {version}
Summary: Classical particles in two dimensions: exact billiards, fields, ensembles
License: GPL-3.0-or-later
Requires-Python: >=3.9
Requires-Dist: numpy
Provides-Extra: pictures
Requires-Dist: matplotlib; extra == "pictures"
""",
    "WHEEL": f"Wheel-Version: 1.0\nGenerator: carom\nRoot-Is-Purelib: false\nTag: {tag}\n",
    "LICENSE": pathlib.Path(source, "LICENSE").read_text(),
}
root = pathlib.Path(folder)
files = {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}
files.update({f"{information}/{name}": text.encode() for name, text in texts.items()})
record = ""
for name, content in files.items():
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    record += f"{name},sha256={digest},{len(content)}\n"
files[f"{information}/RECORD"] = (record + f"{information}/RECORD,,\n").encode()
with zipfile.ZipFile(pathlib.Path(target, f"carom-{version}-{tag}.whl"), "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
    for name, content in files.items():
        # A fixed date: the same build gives the same wheel.
        entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = (0o755 if ".so" in name else 0o644) << 16
        wheel.writestr(entry, content)
