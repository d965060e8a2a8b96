"""The comparison of printed outputs finds what is stale, and renews it."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))
import outputs  # noqa: E402

PROGRAM = """#!/bin/sh
echo "three of them: $1"
echo "  value  1.25"
echo "computed in 0.31 s on 2 threads"
"""
PAGE = """Text
```sh
carom one   # a comment
```

```
three of them: one
  …
computed in 12 s on 8 threads
```

```
$ carom two
three of them: two
  value  VALUE
```
"""


class Outputs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.program = pathlib.Path(self.folder.name) / "carom"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        self.page = pathlib.Path(self.folder.name) / "page.md"

    def tearDown(self):
        self.folder.cleanup()

    def faults(self, value):
        self.page.write_text(PAGE.replace("VALUE", value))
        return outputs.Page(self.page, self.program).check()

    def test_right_outputs_have_no_faults(self):
        self.assertEqual(self.faults("1.25").faults, [])
        self.assertEqual(self.faults("1.…").faults, [])

    def test_a_stale_line_is_found_and_renewed(self):
        page = self.faults("1.24")
        self.assertEqual(len(page.faults), 1)
        self.assertIn("page.md:15", page.faults[0])
        page.renew()
        self.assertIn("  value  1.25", self.page.read_text())

    def test_lines_out_of_order_are_found(self):
        self.page.write_text("```sh\ncarom x\n```\n\n```\n  value  1.25\nthree of them: x\n```\n")
        self.assertEqual(len(outputs.Page(self.page, self.program).check().faults), 1)


if __name__ == "__main__":
    unittest.main()
