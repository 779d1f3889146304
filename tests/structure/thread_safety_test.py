"""That thread_safety.py finds a guarded member that is used without its mutex, and no fault where there is none.

Usage: thread_safety_test.py CLANG++
"""
import json
import os
import shutil
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import thread_safety  # noqa: E402

HEADER = """#include "base/mutex.h"
class Count {
 public:
  void add();
  int value();

 private:
  affskel::base::Mutex mutex_;
  int value_ ABSL_GUARDED_BY(mutex_) = 0;
};
"""
ADD = '#include "count.h"\nvoid Count::add() {\n  const affskel::base::MutexLock lock(mutex_);\n  ++value_;\n}\n'
VALUE = '#include "count.h"\nint Count::value() { return value_; }\n'
OTHER = "int main() { return 0; }\n"


class ThreadSafety(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.project = folder.name
        self.files = {"server/count.h": HEADER, "server/add.cc": ADD, "server/value.cc": VALUE, "server/other.cc": OTHER}
        for path, text in self.files.items():
            self.write(path, text)
        os.makedirs(os.path.join(self.project, "proto/base"))
        shutil.copy(os.path.join(HERE, "../../proto/base/mutex.h"), os.path.join(self.project, "proto/base"))

    def write(self, path, text):
        os.makedirs(os.path.dirname(os.path.join(self.project, path)), exist_ok=True)
        with open(os.path.join(self.project, path), "w", encoding="utf-8") as out:
            out.write(text)

    def said(self, compiled):
        commands = [{"directory": self.project, "file": os.path.join(self.project, path),
                     "command": f"c++ -std=c++20 -I{self.project}/proto -o x.o -c {path}"} for path in compiled]
        self.write("compile_commands.json", json.dumps(commands))
        return thread_safety.analyse(self.project, self.project, CLANG)

    def assert_fault_is_found(self, said):
        self.assertEqual(sorted(said), ["server/add.cc", "server/value.cc"])
        self.assertEqual(said["server/add.cc"], "")
        self.assertIn("requires holding mutex 'mutex_'", said["server/value.cc"])

    def test_faults(self):
        self.assert_fault_is_found(self.said([path for path in self.files if path.endswith(".cc")]))

    def test_faults_of_files_that_are_compiled_as_one(self):
        batch = "Unity/unity_0_cxx.cxx"
        self.write(batch, "".join(f'#include "{os.path.join(self.project, path)}"\n'
                                  for path in self.files if path.endswith(".cc")))
        self.assert_fault_is_found(self.said([batch]))


if __name__ == "__main__":
    CLANG = sys.argv.pop(1)
    unittest.main()
