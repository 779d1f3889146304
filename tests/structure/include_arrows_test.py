"""That include_arrows.py finds each kind of fault, and none where there is none."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import include_arrows  # noqa: E402


class IncludeArrows(unittest.TestCase):
    def faults(self, rooms, files):
        with tempfile.TemporaryDirectory() as project:
            for path, text in files.items():
                full = os.path.join(project, path)
                os.makedirs(os.path.dirname(full), exist_ok=True)
                with open(full, "w", encoding="utf-8") as out:
                    out.write(text)
            return list(include_arrows.faults_of(project, rooms))

    FILES = {
        "proto/wire/a.h": "#include <vector>\n",
        "server/store/b.cc": '#include "store/b.h"\n#include "wire/a.h"\n#include "affskel/v1/types.pb.h"\n',
        "server/store/b.h": "",
    }

    def test_nothing(self):
        self.assertEqual(self.faults({"proto/wire": [], "server/store": ["proto/wire"]}, self.FILES), [])

    def test_each_fault(self):
        cases = [
            ({"proto/wire": [], "server/store": []}, "may not include proto/wire"),
            ({"server/store": ["proto/wire"], "proto/wire": []}, "does not stand above it"),
            ({"proto/wire": []}, "its room is not listed"),
            ({"proto/wire": [], "server/store": ["proto/wire"], "server/services": []}, "there is no source in it"),
            ({"a": [], "proto/wire": ["a"], "server/store": ["proto/wire"]}, "may include a, but does not"),
        ]
        for rooms, words in cases:
            self.assertTrue(any(words in fault for fault in self.faults(rooms, self.FILES)), words)
        nowhere = dict(self.FILES, **{"proto/wire/c.h": '#include "wire/gone.h"\n'})
        found = self.faults({"proto/wire": [], "server/store": ["proto/wire"]}, nowhere)
        self.assertEqual(found, ['proto/wire/c.h: includes "wire/gone.h", which is nowhere'])


if __name__ == "__main__":
    unittest.main()
